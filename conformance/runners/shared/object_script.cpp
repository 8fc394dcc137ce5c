// SPDX-License-Identifier: Apache-2.0
#include "conformance/runners/shared/object_script.hpp"

#include <algorithm>
#include <iostream>
#include <stdexcept>
#include <utility>

#include "conformance/runners/shared/outcomes.hpp"

namespace rr::conformance {
namespace {

constexpr std::string_view later = "_later";

/// Whose call something was put off by, on the thread that does it.
thread_local std::uint32_t put_off_client = 0;
/// An answer is long gone then.
constexpr std::chrono::milliseconds delay{50};

}  // namespace

Json ObjectScript::told(std::string_view kind, std::string_view name) {
  const std::lock_guard lock(mutex_);
  return part(part(node_, kind), name);
}

Json ObjectScript::value_of(std::string_view property) {
  const std::lock_guard lock(mutex_);
  const Json entry = part(part(node_, "properties"), property);
  if (entry.contains("get_throw")) raise_told(entry["get_throw"]);
  return part(entry, "value");
}

void ObjectScript::set_value(std::string_view property, Json value) {
  const std::lock_guard lock(mutex_);
  Json& entry = node_["properties"][std::string(property)];
  if (entry.contains("set_throw")) raise_told(entry["set_throw"]);
  entry["value"] = std::move(value);
}

Json ObjectScript::next_outcome(std::string_view function, const Json& parameters) {
  std::size_t call = 0;
  {
    const std::lock_guard lock(mutex_);
    call = calls_[std::string(function)]++;
  }
  Json next = outcome_of_call(told("functions", function), call);
  if (next.contains("throw")) raise_told(next["throw"], parameters);
  return next;
}

Json ObjectScript::outcome(std::string_view function, const Json& parameters,
                           std::string_view result_type) {
  if (is_known_by_name(function)) {
    if (auto done = act(function, parameters, result_type)) return *done;
  }
  const Json next = next_outcome(function, parameters);
  if (const Json other = part(next, "does"); other.is_string()) {
    auto done = act(other.get_ref<const std::string&>(), parameters, result_type);
    if (!done) throw std::runtime_error("nothing is called " + other.dump());
    return *done;
  }
  if (next.contains("echo")) return parameters.at(next["echo"].get<std::size_t>());
  return part(next, "return");
}

// Not where an outcome says itself what the function does.
bool ObjectScript::is_known_by_name(std::string_view function) {
  const Json outcomes = told("functions", function);
  if (outcomes.is_object()) return !outcomes.contains("does");
  return std::none_of(outcomes.begin(), outcomes.end(),
                      [](const Json& outcome) { return outcome.contains("does"); });
}

// Does what a function of this name is for; nothing for a name that says nothing.
std::optional<Json> ObjectScript::act(std::string_view name, const Json& parameters,
                                      std::string_view result_type) {
  if (name == "release_child") {
    release(parameters.at(0).get<std::string>());
    return Json();
  }
  const auto action = actions_.find(name);
  if (action != actions_.end()) return action->second(result_type);
  if (!name.ends_with(later)) return std::nullopt;
  const auto put_off = actions_.find(name.substr(0, name.size() - later.size()));
  if (put_off == actions_.end()) return std::nullopt;
  const auto fired = actions_.find(
      std::string("fire_answered_").append(put_off->first, put_off->first.find('_') + 1));
  do_later(std::string(name),
           [this, client = ServiceContext::current_client(), &act = put_off->second, fired] {
             put_off_client = client;
             (void)act({});
             if (fired != actions_.end()) (void)fired->second({});
           });
  return Json();
}

void ObjectScript::do_later(std::string name, std::function<void()> what) {
  const std::lock_guard lock(mutex_);
  put_off_.emplace_back([name = std::move(name), what = std::move(what)] {
    std::this_thread::sleep_for(delay);
    try {
      what();
    } catch (const Error&) {
      return;  // whom it was for has gone
    } catch (const std::exception& error) {
      std::cerr << name + ": " + error.what() + "\n";
    } catch (...) {
      std::cerr << name + ": something else than an exception was thrown\n";
    }
  });
}

std::uint32_t ObjectScript::client() {
  return put_off_client != 0 ? put_off_client : ServiceContext::current_client();
}

// What is put off may have kept the object, and be the last that did.
void ObjectScript::finish() {
  for (std::thread& thread : std::exchange(put_off_, {})) {
    if (thread.get_id() == std::this_thread::get_id()) {
      thread.detach();
    } else {
      thread.join();
    }
  }
}

void ObjectScript::release(const std::string& path) {
  if (context_ == nullptr) throw std::runtime_error("an object that was not reached is called");
  context_->release_path(context_->name() + "." + path);
}

std::shared_ptr<rr::Skeleton> ObjectScript::child(std::string_view objref, const Json& index) {
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
  made = make_child(entry.at("type").get_ref<const std::string&>(), entry.at("node"));
  return made;
}

void ObjectScript::raise_told(const Json& what, const Json& parameters) const {
  raise([this](const Json& json) { return read_parameter(json); }, what, parameters);
}

bool ObjectScript::has_monitor(const ObjectType& type) {
  return std::any_of(type.members.begin(), type.members.end(),
                     [](const Member& member) { return (member.access & nolock) != 0; });
}

std::size_t ScriptedSteps::count() const {
  return steps_.contains("yield") ? steps_["yield"].size() : steps_.value("accept", 0U);
}

bool ScriptedSteps::take() {
  if (step_ < count()) {
    ++step_;
    return true;
  }
  if (steps_.contains("end")) script_.raise_told(steps_["end"]);
  return false;
}

std::optional<Json> ScriptedSteps::give() {
  const std::size_t step = step_;
  if (!take()) return std::nullopt;
  return steps_.contains("yield") ? steps_["yield"].at(step) : Json();
}

}  // namespace rr::conformance
