// SPDX-License-Identifier: Apache-2.0
#include "conformance/runners/cpp/script.hpp"

#include <rr/service.hpp>
#include <stdexcept>

namespace rr::conformance {
namespace {

constexpr std::string_view fire_prefix = "fire_";
constexpr std::string_view release_function = "release_child";

// The part of `json` with this key, or null.
Json part(const Json& json, std::string_view key) {
  const auto found = json.find(std::string(key));
  return found == json.end() ? Json() : *found;
}

// A "$n" stands for parameter n of the call.
Json with_parameters(const Json& json, const Json& parameters) {
  if (!json.is_string()) return json;
  const auto& text = json.get_ref<const std::string&>();
  if (text.size() != 2 || text[0] != '$') return json;
  return parameters.at(static_cast<std::size_t>(text[1] - '0'));
}

std::string text_of(const Json& json) { return json.is_null() ? "" : json.get<std::string>(); }

}  // namespace

Json Script::value_of(std::string_view property) {
  const std::lock_guard lock(mutex_);
  const Json entry = part(part(node_, "properties"), property);
  if (entry.contains("get_throw")) raise(entry["get_throw"], Json::array());
  return part(entry, "value");
}

void Script::set_value(std::string_view property, Json value) {
  const std::lock_guard lock(mutex_);
  Json& entry = node_["properties"][std::string(property)];
  if (entry.contains("set_throw")) raise(entry["set_throw"], Json::array());
  entry["value"] = std::move(value);
}

// Outcomes are for one call each, in their order; the last one is for all calls to come.
Json Script::next_outcome(std::string_view function) {
  const std::lock_guard lock(mutex_);
  const Json outcomes = part(part(node_, "functions"), function);
  if (!outcomes.is_array() || outcomes.empty()) return outcomes;
  std::size_t& call = calls_[std::string(function)];
  const Json outcome = outcomes.at(std::min(call, outcomes.size() - 1));
  ++call;
  return outcome;
}

Json Script::outcome(Scripted& self, std::string_view function, const Json& parameters) {
  const Json next = next_outcome(function);
  if (next.is_null()) {
    if (function == release_function) release(parameters.at(0).get<std::string>());
    if (function.starts_with(fire_prefix)) {
      fire_all(self, std::string(function.substr(fire_prefix.size())));
    }
    return nullptr;
  }
  if (next.contains("throw")) raise(next["throw"], parameters);
  if (next.contains("echo")) return parameters.at(next["echo"].get<std::size_t>());
  return part(next, "return");
}

void Script::fire_all(Scripted& self, const std::string& event) {
  for (const Json& arguments : part(part(node_, "events"), event)) {
    if (!self.rr_fire_by_name(event, arguments)) {
      throw std::runtime_error("no event " + event + " to fire");
    }
  }
}

void Script::release(const std::string& path) {
  if (context_ == nullptr) throw std::runtime_error("an object that was not reached is called");
  context_->release_path(context_->name() + "." + path);
}

// Code 100 is a remote error of any name; another code has its own name, and free are those of 16
// and of codes that the protocol does not know.
void Script::raise(const Json& what, const Json& parameters) const {
  if (what.contains("native")) {
    throw std::runtime_error(text_of(with_parameters(what["native"], parameters)));
  }
  const auto code =
      static_cast<ErrorCode>(with_parameters(what.at("code"), parameters).get<std::uint16_t>());
  const std::string message = text_of(with_parameters(part(what, "message"), parameters));
  const std::string subname = text_of(with_parameters(part(what, "subname"), parameters));
  const Json parameter = with_parameters(part(what, "param"), parameters);
  std::string name(error_name(code));
  if (code == ErrorCode::remote_error || name.empty()) name = text_of(part(what, "name"));
  throw Error(code, name, message, subname, made_from_json<VarValue>(adapters_, parameter));
}

std::shared_ptr<rr::Skeleton> Script::child(std::string_view objref, const Json& index) {
  const std::string text = index.is_string() ? index.get<std::string>() : index.dump();
  const std::lock_guard lock(mutex_);
  std::shared_ptr<rr::Skeleton>& made = children_[std::string(objref) + "[" + text + "]"];
  if (made) return made;
  Json entry = part(part(node_, "objrefs"), objref);
  if (entry.is_null()) return nullptr;
  if (!index.is_null()) {
    entry = part(part(entry, "items"), text);
    if (entry.is_null()) throw Error(ErrorCode::invalid_argument, "no object with index " + text);
  }
  auto script = std::make_shared<Script>(adapters_, entry.at("node"));
  made = adapters_.object(entry.at("type").get_ref<const std::string&>()).serve(std::move(script));
  return made;
}

}  // namespace rr::conformance
