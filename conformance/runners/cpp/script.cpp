// SPDX-License-Identifier: Apache-2.0
#include "conformance/runners/cpp/script.hpp"

#include <stdexcept>

namespace rr::conformance {
namespace {

constexpr std::string_view later = "_later";
/// An answer is long gone then.
constexpr std::chrono::milliseconds delay{50};

}  // namespace

Json Script::told(std::string_view kind, std::string_view name) {
  const std::lock_guard lock(mutex_);
  return part(part(node_, kind), name);
}

Json Script::value_of(std::string_view property) {
  const std::lock_guard lock(mutex_);
  const Json entry = part(part(node_, "properties"), property);
  if (entry.contains("get_throw")) raise(adapters_, entry["get_throw"]);
  return part(entry, "value");
}

void Script::set_value(std::string_view property, Json value) {
  const std::lock_guard lock(mutex_);
  Json& entry = node_["properties"][std::string(property)];
  if (entry.contains("set_throw")) raise(adapters_, entry["set_throw"]);
  entry["value"] = std::move(value);
}

Json Script::next_outcome(std::string_view function, const Json& parameters) {
  std::size_t call = 0;
  {
    const std::lock_guard lock(mutex_);
    call = calls_[std::string(function)]++;
  }
  Json next = outcome_of_call(told("functions", function), call);
  if (next.contains("throw")) raise(adapters_, next["throw"], parameters);
  return next;
}

Json Script::outcome(std::string_view function, const Json& parameters,
                     const std::type_info& wanted) {
  const auto action = actions_.find(function);
  if (action != actions_.end()) return action->second(wanted);
  if (function.ends_with(later)) {
    const auto put_off = actions_.find(function.substr(0, function.size() - later.size()));
    if (put_off != actions_.end()) {
      do_later([&action = put_off->second] { (void)action(typeid(void)); });
      return nullptr;
    }
  }
  const Json next = next_outcome(function, parameters);
  if (next.is_null()) {
    if (function == "release_child") release(parameters.at(0).get<std::string>());
    return nullptr;
  }
  if (next.contains("echo")) return parameters.at(next["echo"].get<std::size_t>());
  return part(next, "return");
}

void Script::do_later(std::function<void()> what) {
  const std::lock_guard lock(mutex_);
  put_off_.emplace_back([what = std::move(what)] {
    std::this_thread::sleep_for(delay);
    try {
      what();
    } catch (const Error&) {
      return;  // whom it was for has gone
    }
  });
}

void Script::release(const std::string& path) {
  if (context_ == nullptr) throw std::runtime_error("an object that was not reached is called");
  context_->release_path(context_->name() + "." + path);
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
