// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <rr/memories.hpp>
#include <rr/pipes.hpp>
#include <rr/service.hpp>
#include <rr/skeleton.hpp>
#include <rr/wires.hpp>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <typeinfo>
#include <utility>

#include "conformance/runners/cpp/scripted_generator.hpp"
#include "conformance/runners/shared/adapters.hpp"
#include "conformance/runners/shared/arguments.hpp"
#include "conformance/runners/shared/object_script.hpp"
#include "conformance/runners/shared/outcomes.hpp"

namespace rr::conformance {

/// The same with the typed members of generated skeletons.
class Script final : public ObjectScript {
 public:
  Script(const Adapters& adapters, Json node)
      : ObjectScript(std::move(node)), adapters_(adapters) {}
  ~Script() override { finish(); }

  // Called by the adapter when it is made. Both live as long.
  template <class S, class Base, class... Parameters>
  void add_event(const std::string& name, const S& skeleton,
                 void (Base::*event)(Parameters...) const) {
    add_action("fire_" + name, [this, name, &skeleton, event](std::string_view) {
      for (const Json& arguments : told("events", name)) {
        apply(skeleton, event, arguments, std::index_sequence_for<Parameters...>());
      }
      return Json();
    });
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
    const Json result = outcome(
        function, Json::array({to_json<Parameters>(adapters_, parameters)...}), typeid(R).name());
    if constexpr (!std::is_void_v<R>) {
      return result.is_null() ? R{} : made_from_json<R>(adapters_, result);
    }
  }

  /// The same of a generator function.
  template <class R, class P, class... Parameters>
  Sequence<R, P> generate(std::string_view function, const Parameters&... parameters) {
    Json steps =
        next_outcome(function, Json::array({to_json<Parameters>(adapters_, parameters)...}));
    return std::make_shared<ScriptedGenerator<R, P>>(adapters_,
                                                     ScriptedSteps(*this, std::move(steps)));
  }

  /// The memory of this name, made from a Value when it is asked for first.
  template <class Memory, class Value>
  std::shared_ptr<Memory> memory(const std::string& name) {
    const Json content = told("memories", name);
    const std::lock_guard lock(memory_mutex_);
    std::shared_ptr<MemorySource>& made = memories_[name];
    if (!made) {
      made = std::make_shared<Memory>(
          content.is_null() ? Value() : made_from_json<Value>(adapters_, content));
    }
    return std::static_pointer_cast<Memory>(made);
  }

  template <class S>
  std::shared_ptr<S> child_as(std::string_view objref, const Json& index = nullptr) {
    return std::dynamic_pointer_cast<S>(child(objref, index));
  }

 private:
  template <class S, class Base, class... Parameters, std::size_t... Places>
  void apply(const S& skeleton, void (Base::*event)(Parameters...) const, const Json& arguments,
             std::index_sequence<Places...>) const {
    (skeleton.*event)(made_from_json<std::decay_t<Parameters>>(adapters_, arguments.at(Places))...);
  }
  template <class S, class Base, class R, class... Parameters>
  Json call_back(const S& skeleton, R (Base::*callback)(std::uint32_t, Parameters...) const,
                 const Json& arguments) const {
    const std::uint32_t asked = client();
    const auto call = [&] {
      return std::apply(
          [&](const auto&... values) -> R {
            return (skeleton.*callback)(asked, values..., CallOptions());
          },
          read_arguments<Parameters...>(adapters_, arguments));
    };
    if constexpr (std::is_void_v<R>) {
      call();
      return nullptr;
    } else {
      return to_json<R>(adapters_, call());
    }
  }

  [[nodiscard]] VarValue read_parameter(const Json& json) const override {
    return made_from_json<VarValue>(adapters_, json);
  }
  [[nodiscard]] std::shared_ptr<rr::Skeleton> make_child(const std::string& type,
                                                         Json node) const override {
    return adapters_.object(type).serve(std::make_shared<Script>(adapters_, std::move(node)));
  }

  const Adapters& adapters_;
  std::mutex memory_mutex_;
  std::map<std::string, std::shared_ptr<MemorySource>> memories_;
};

template <class T>
void Script::add_pipe(const std::string& name, const PipeServer<T>& pipe) {
  pipe.on_connect([this](PipeEndpoint<T> end) {
    end.on_packet([this](const T&) { count_packet(); }).detach();
  });
  add_action("received_count", [this](std::string_view) { return Json(packet_count()); });
  add_action("send_" + name, [this, name, pipe](std::string_view) {
    const Json packets = told("pipes", name);
    for (PipeEndpoint<T>& end : pipe.endpoints()) {
      for (const Json& entry : packets) {
        end.ask_for_acknowledgements(entry.value("ack", false));
        end.send(made_from_json<T>(adapters_, entry.at("packet")));
      }
    }
    return Json();
  });
  add_action("close_" + name, [pipe](std::string_view) {
    for (PipeEndpoint<T>& end : pipe.endpoints()) end.close();
    return Json();
  });
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
    do_later(name + " at_connect", [wire, scripted] { wire.set_in(scripted("peek_in")); });
  });
  add_action("send_" + name, [this, name, wire](std::string_view) {
    for (const Json& value : part(told("wires", name), "send")) {
      wire.set_in(made_from_json<T>(adapters_, value));
    }
    return Json();
  });
  add_action("last_" + name, [this, wire](std::string_view) {
    const auto newest = wire.out();
    if (!newest) throw Error(ErrorCode::value_not_set, "Value not set");
    return to_json<T>(adapters_, newest->value);
  });
  add_action("close_" + name, [wire](std::string_view) {
    for (ServedWire<T>& end : wire.connections()) end.close();
    return Json();
  });
}

// A function of another type tells the error as a text.
template <class S, class Base, class R, class... Parameters>
void Script::add_callback(const std::string& name, const S& skeleton,
                          R (Base::*callback)(std::uint32_t, Parameters...) const) {
  add_action("call_" + name, [this, name, &skeleton, callback](std::string_view result_type) {
    try {
      return call_back(skeleton, callback, told("callbacks", name));
    } catch (const Error& error) {
      if (result_type == typeid(R).name()) throw;
      return Json(error.what());
    }
  });
}

}  // namespace rr::conformance
