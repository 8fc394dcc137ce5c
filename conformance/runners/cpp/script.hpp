// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <chrono>
#include <map>
#include <memory>
#include <mutex>
#include <rr/skeleton.hpp>
#include <semaphore>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

#include "conformance/runners/cpp/adapters.hpp"

namespace rr::conformance {

/// A skeleton that does what its script says; the generated adapters derive from it.
class Scripted {
 public:
  Scripted() = default;
  Scripted(const Scripted&) = delete;
  Scripted& operator=(const Scripted&) = delete;
  virtual ~Scripted() = default;

  /// Fires an event; false when the object has none of that name.
  virtual bool rr_fire_by_name(std::string_view event, const Json& arguments) = 0;
};

/// What one object is told to do, a node of service.json, and its state. Used by any thread.
class Script {
 public:
  Script(const Adapters& adapters, Json node) : adapters_(adapters), node_(std::move(node)) {}

  /// Called by the adapter when the service reaches its object.
  void attached(ServiceContext& context) { context_ = &context; }

  template <class T>
  T get(std::string_view property) {
    const Json value = value_of(property);
    return value.is_null() ? T{} : made_from_json<T>(adapters_, value);
  }
  template <class T>
  void set(std::string_view property, const T& value) {
    set_value(property, to_json(adapters_, value));
  }

  /// The outcome of the next call of a function. `self` fires the events of the object.
  template <class R, class... Parameters>
  R call(Scripted& self, std::string_view function, const Parameters&... parameters) {
    const Json result =
        outcome(self, function, Json::array({to_json<Parameters>(adapters_, parameters)...}));
    if constexpr (!std::is_void_v<R>) {
      return result.is_null() ? R{} : made_from_json<R>(adapters_, result);
    }
  }

  /// The object that an objref gives; `index` is null for one without index. Null when the script
  /// has no such object. Throws rr::Error (invalid_argument) for an unknown index.
  std::shared_ptr<rr::Skeleton> child(std::string_view objref, const Json& index = nullptr);

  template <class S>
  std::shared_ptr<S> child_as(std::string_view objref, const Json& index = nullptr) {
    return std::dynamic_pointer_cast<S>(child(objref, index));
  }

  /// The monitor of the object, which those have that have a member without lock.
  static bool has_monitor(const ObjectType& type) {
    return std::any_of(type.members.begin(), type.members.end(),
                       [](const Member& member) { return (member.access & nolock) != 0; });
  }
  bool enter_monitor(std::chrono::milliseconds timeout) {
    return monitor_.try_acquire_for(timeout);
  }
  void exit_monitor() { monitor_.release(); }

  /// Fires an event by a pointer to its member in the skeleton or in what that implements. True.
  template <class S, class Base, class... Parameters>
  bool fire_by(const S& skeleton, void (Base::*event)(Parameters...) const, const Json& arguments) {
    return fire_with(skeleton, event, arguments, std::index_sequence_for<Parameters...>());
  }

 private:
  template <class S, class Base, class... Parameters, std::size_t... Places>
  bool fire_with(const S& skeleton, void (Base::*event)(Parameters...) const, const Json& arguments,
                 std::index_sequence<Places...>) {
    (skeleton.*event)(made_from_json<std::decay_t<Parameters>>(adapters_, arguments.at(Places))...);
    return true;
  }
  Json value_of(std::string_view property);
  void set_value(std::string_view property, Json value);
  Json outcome(Scripted& self, std::string_view function, const Json& parameters);
  Json next_outcome(std::string_view function);
  void fire_all(Scripted& self, const std::string& event);
  void release(const std::string& path);
  [[noreturn]] void raise(const Json& what, const Json& parameters) const;

  const Adapters& adapters_;
  std::mutex mutex_;
  Json node_;
  std::map<std::string, std::size_t> calls_;
  std::map<std::string, std::shared_ptr<rr::Skeleton>> children_;
  ServiceContext* context_ = nullptr;
  std::binary_semaphore monitor_{1};
};

}  // namespace rr::conformance
