// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <rr/memories.hpp>
#include <rr/pipes.hpp>
#include <rr/service.hpp>
#include <rr/skeleton.hpp>
#include <rr/wires.hpp>
#include <semaphore>
#include <string>
#include <string_view>
#include <thread>
#include <type_traits>
#include <typeinfo>
#include <utility>
#include <vector>

#include "conformance/runners/cpp/adapters.hpp"
#include "conformance/runners/cpp/outcomes.hpp"
#include "conformance/runners/cpp/scripted_generator.hpp"

namespace rr::conformance {

/// What one object is told to do, a node of service.json, and its state. Used by any thread.
/// Functions that drive other members are known by their names: `fire_<event>`, `send_<pipe>`,
/// `close_<pipe>`, `received_count`, `send_<wire>`, `close_<wire>`, `last_<wire>`,
/// `call_<callback>`, `release_child`; with `_later` behind it a function does so when it has been
/// answered.
class Script {
 public:
  Script(const Adapters& adapters, Json node) : adapters_(adapters), node_(std::move(node)) {}

  /// Called by the adapter when the service reaches its object.
  void attached(ServiceContext& context) { context_ = &context; }

  // Called by the adapter when it is made. Both live as long.
  template <class S, class Base, class... Parameters>
  void add_event(const std::string& name, const S& skeleton,
                 void (Base::*event)(Parameters...) const) {
    actions_["fire_" + name] = [this, name, &skeleton, event](const std::type_info&) {
      for (const Json& arguments : told("events", name)) {
        apply(skeleton, event, arguments, std::index_sequence_for<Parameters...>());
      }
      return Json();
    };
  }
  template <class T>
  void add_pipe(const std::string& name, const PipeServer<T>& pipe);
  template <class T>
  void add_wire(const std::string& name, const WireServer<T>& wire);
  template <class S, class Base, class R, class... Parameters>
  void add_callback(const std::string& name, const S& skeleton,
                    R (Base::*callback)(std::uint32_t, Parameters...) const);

  template <class T>
  T get(std::string_view property) {
    const Json value = value_of(property);
    return value.is_null() ? T{} : made_from_json<T>(adapters_, value);
  }
  template <class T>
  void set(std::string_view property, const T& value) {
    set_value(property, to_json(adapters_, value));
  }

  /// The outcome of the next call of a function.
  template <class R, class... Parameters>
  R call(std::string_view function, const Parameters&... parameters) {
    const Json result =
        outcome(function, Json::array({to_json<Parameters>(adapters_, parameters)...}), typeid(R));
    if constexpr (!std::is_void_v<R>) {
      return result.is_null() ? R{} : made_from_json<R>(adapters_, result);
    }
  }

  /// The same of a generator function.
  template <class R, class P, class... Parameters>
  Sequence<R, P> generate(std::string_view function, const Parameters&... parameters) {
    Json steps =
        next_outcome(function, Json::array({to_json<Parameters>(adapters_, parameters)...}));
    return std::make_shared<ScriptedGenerator<R, P>>(adapters_, std::move(steps));
  }

  /// The memory of this name, made from a Value when it is asked for first.
  template <class Memory, class Value>
  std::shared_ptr<Memory> memory(const std::string& name) {
    const Json content = told("memories", name);
    const std::lock_guard lock(mutex_);
    std::shared_ptr<MemorySource>& made = memories_[name];
    if (!made) {
      made = std::make_shared<Memory>(
          content.is_null() ? Value() : made_from_json<Value>(adapters_, content));
    }
    return std::static_pointer_cast<Memory>(made);
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

 private:
  /// Does what a function is for; it is told which type it is to give.
  using Action = std::function<Json(const std::type_info&)>;

  template <class S, class Base, class... Parameters, std::size_t... Places>
  void apply(const S& skeleton, void (Base::*event)(Parameters...) const, const Json& arguments,
             std::index_sequence<Places...>) const {
    (skeleton.*event)(made_from_json<std::decay_t<Parameters>>(adapters_, arguments.at(Places))...);
  }
  template <class S, class Base, class R, class... Parameters, std::size_t... Places>
  Json call_back(const S& skeleton, R (Base::*callback)(std::uint32_t, Parameters...) const,
                 const Json& arguments, std::index_sequence<Places...>) const {
    const std::uint32_t client = ServiceContext::current_client();
    const auto call = [&] {
      return (skeleton.*callback)(
          client, made_from_json<std::decay_t<Parameters>>(adapters_, arguments.at(Places))...);
    };
    if constexpr (std::is_void_v<R>) {
      call();
      return nullptr;
    } else {
      return to_json<R>(adapters_, call());
    }
  }

  /// What the script says about a member that is no function.
  Json told(std::string_view kind, std::string_view name);
  Json value_of(std::string_view property);
  void set_value(std::string_view property, Json value);
  Json outcome(std::string_view function, const Json& parameters, const std::type_info& wanted);
  Json next_outcome(std::string_view function, const Json& parameters);
  /// Once what happens now has been answered.
  void do_later(std::function<void()> what);
  void release(const std::string& path);

  const Adapters& adapters_;
  std::mutex mutex_;
  Json node_;
  std::map<std::string, Action, std::less<>> actions_;
  std::map<std::string, std::size_t> calls_;
  std::map<std::string, std::shared_ptr<rr::Skeleton>> children_;
  std::map<std::string, std::shared_ptr<MemorySource>> memories_;
  std::atomic<int> received_ = 0;  // packets
  ServiceContext* context_ = nullptr;
  std::binary_semaphore monitor_{1};
  std::vector<std::jthread> put_off_;  // last: they use all of the above
};

template <class T>
void Script::add_pipe(const std::string& name, const PipeServer<T>& pipe) {
  pipe.on_connect(
      [this](PipeEndpoint<T> end) { end.on_packet([this](const T&) { ++received_; }).detach(); });
  actions_["received_count"] = [this](const std::type_info&) { return Json(received_.load()); };
  actions_["send_" + name] = [this, name, pipe](const std::type_info&) {
    const Json packets = told("pipes", name);
    for (PipeEndpoint<T>& end : pipe.endpoints()) {
      for (const Json& entry : packets) {
        end.ask_for_acknowledgements(entry.value("ack", false));
        end.send(made_from_json<T>(adapters_, entry.at("packet")));
      }
    }
    return Json();
  };
  actions_["close_" + name] = [pipe](const std::type_info&) {
    for (PipeEndpoint<T>& end : pipe.endpoints()) end.close();
    return Json();
  };
}

template <class T>
void Script::add_wire(const std::string& name, const WireServer<T>& wire) {
  const auto scripted = [this, name](std::string_view key) {
    const Json values = told("wires", name);
    if (!values.contains(key)) throw Error(ErrorCode::value_not_set, "Value not set");
    return made_from_json<T>(adapters_, values.at(std::string(key)));
  };
  wire.on_peek_in([scripted] { return scripted("peek_in"); });
  wire.on_peek_out([scripted, wire] {
    const auto newest = wire.out();
    return newest ? newest->value : scripted("peek_out");
  });
  wire.on_connect([this, name, wire, scripted](ServedWire<T>) {
    if (part(told("wires", name), "at_connect") != true) return;
    do_later([wire, scripted] { wire.set_in(scripted("peek_in")); });
  });
  actions_["send_" + name] = [this, name, wire](const std::type_info&) {
    for (const Json& value : part(told("wires", name), "send")) {
      wire.set_in(made_from_json<T>(adapters_, value));
    }
    return Json();
  };
  actions_["last_" + name] = [this, wire](const std::type_info&) {
    const auto newest = wire.out();
    if (!newest) throw Error(ErrorCode::value_not_set, "Value not set");
    return to_json<T>(adapters_, newest->value);
  };
  actions_["close_" + name] = [wire](const std::type_info&) {
    for (ServedWire<T>& end : wire.connections()) end.close();
    return Json();
  };
}

// A function of another type tells the error as a text.
template <class S, class Base, class R, class... Parameters>
void Script::add_callback(const std::string& name, const S& skeleton,
                          R (Base::*callback)(std::uint32_t, Parameters...) const) {
  actions_["call_" + name] = [this, name, &skeleton, callback](const std::type_info& wanted) {
    try {
      return call_back(skeleton, callback, told("callbacks", name),
                       std::index_sequence_for<Parameters...>());
    } catch (const Error& error) {
      if (wanted == typeid(R)) throw;
      return Json(error.what());
    }
  };
}

}  // namespace rr::conformance
