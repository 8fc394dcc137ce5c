// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <rr/stub.hpp>
#include <stdexcept>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>

#include "conformance/runners/shared/adapters.hpp"
#include "conformance/runners/shared/arguments.hpp"
#include "conformance/runners/shared/planned.hpp"

namespace rr::conformance {

/// Thrown for what this runner, or the code generated for it, does not have: said to the suite as
/// such.
struct NotSupported : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// An object that a plan holds, and the type it is held as.
struct Held {
  std::shared_ptr<Stub> stub;
  std::string_view type;  ///< qualified
};

/// A stub whose members are called by name with values in the notation of the captures. Generated
/// adapters implement it with the typed members of the stub. All throw rr::Error as those do, and
/// NotSupported for a member that is not there.
class Caller {
 public:
  explicit Caller(const Adapters& adapters) : adapters_(adapters) {}
  Caller(const Caller&) = delete;
  Caller& operator=(const Caller&) = delete;
  virtual ~Caller() = default;

  virtual Json get(std::string_view property) = 0;
  virtual void set(std::string_view property, const Json& value) = 0;
  /// Null for a void function.
  virtual Json call(std::string_view function, const Json& arguments) = 0;
  /// `index` is null for an objref without one.
  virtual Held objref(std::string_view member, const Json& index) = 0;
  /// `handler` gets the list of the parameters of each event.
  virtual Subscription listen(std::string_view event, std::function<void(Json)> handler) = 0;
  /// Connects a new endpoint, with this index or -1.
  virtual std::unique_ptr<PlannedPipe> pipe(std::string_view member, std::int32_t index,
                                            const Arrive& arrive) = 0;
  /// Not yet connected.
  virtual std::unique_ptr<PlannedWire> wire(std::string_view member) = 0;
  virtual std::unique_ptr<PlannedMemory> memory(std::string_view member) = 0;
  virtual std::unique_ptr<PlannedGenerator> generate(std::string_view function,
                                                     const Json& arguments) = 0;
  /// `answer` gets the list of the parameters of each call, on any thread.
  virtual void set_callback(std::string_view member, std::function<Json(Json)> answer) = 0;

 protected:
  [[noreturn]] static void not_supported(std::string_view kind, std::string_view member) {
    throw NotSupported("the generated code has no " + std::string(kind) + " " +
                       std::string(member));
  }

  // What the generated code calls, with a pointer to the member of the stub or of what that
  // implements. The last parameter of what waits for an answer are the options of the call; those
  // of the thread apply here.
  template <class S, class Base, class T>
  Json get_by(S& stub, T (Base::*getter)(const CallOptions&)) {
    return to_json<T>(adapters_, (stub.*getter)({}));
  }
  template <class S, class Base, class T>
  void set_by(S& stub, void (Base::*setter)(T, const CallOptions&), const Json& value) {
    (stub.*setter)(made_from_json<std::decay_t<T>>(adapters_, value), {});
  }
  template <class S, class Base, class R, class... Parameters>
  Json call_by(S& stub, R (Base::*function)(Parameters...), const Json& arguments) {
    if constexpr (std::is_void_v<R>) {
      called(stub, function, arguments);
      return nullptr;
    } else {
      return to_json<R>(adapters_, called(stub, function, arguments));
    }
  }
  template <class S, class Base, class T>
  Held find_by(S& stub, std::shared_ptr<T> (Base::*getter)(const CallOptions&), const Json&,
               std::string_view type) {
    return held((stub.*getter)({}), type);
  }
  template <class S, class Base, class T, class Index>
  Held find_by(S& stub, std::shared_ptr<T> (Base::*getter)(Index, const CallOptions&),
               const Json& index, std::string_view type) {
    return held((stub.*getter)(index.get<std::decay_t<Index>>(), {}), type);
  }
  template <class S, class Base, class... Parameters>
  Subscription listen_by(S& stub, Event<Parameters...> (Base::*event)(),
                         std::function<void(Json)> handler) {
    return (stub.*event)().connect(
        [this, handler = std::move(handler)](const Parameters&... parameters) {
          handler(Json::array({to_json<Parameters>(adapters_, parameters)...}));
        });
  }
  template <class S, class Base, class T>
  std::unique_ptr<PlannedPipe> pipe_by(S& stub, Pipe<T> (Base::*member)(),
                                       const PipeOptions& options, const Arrive& arrive) {
    return std::make_unique<TypedPipe<T>>(adapters_, (stub.*member)().connect(options), arrive);
  }
  template <class S, class Base, class T>
  std::unique_ptr<PlannedWire> wire_by(S& stub, Wire<T> (Base::*member)()) {
    return std::make_unique<TypedWire<T>>(adapters_, (stub.*member)());
  }
  template <class S, class Base, class Memory>
  std::unique_ptr<PlannedMemory> memory_by(S& stub, Memory (Base::*member)()) {
    return std::make_unique<TypedMemory<Memory>>(adapters_, (stub.*member)());
  }
  template <class S, class Base, class R, class P, class... Parameters>
  std::unique_ptr<PlannedGenerator> generate_by(S& stub,
                                                Generator<R, P> (Base::*function)(Parameters...),
                                                const Json& arguments) {
    return std::make_unique<TypedGenerator<R, P>>(adapters_, called(stub, function, arguments));
  }
  template <class S, class Base, class R, class... Parameters>
  void callback_by(S& stub, Callback<R(Parameters...)> (Base::*member)(),
                   std::function<Json(Json)> answer) {
    (stub.*member)().set(
        [&adapters = adapters_, answer = std::move(answer)](const Parameters&... parameters) -> R {
          const Json result = answer(Json::array({to_json<Parameters>(adapters, parameters)...}));
          if constexpr (!std::is_void_v<R>) return made_from_json<R>(adapters, result);
        });
  }

 private:
  template <class S, class Base, class R, class... Parameters>
  R called(S& stub, R (Base::*function)(Parameters...), const Json& arguments) {
    return std::apply(
        [&](const auto&... values) -> R { return (stub.*function)(values..., CallOptions()); },
        read_arguments<Parameters...>(adapters_, arguments));
  }
  // A varobject has no declared type: it is held as what it is.
  static Held held(const std::shared_ptr<Stub>& stub, std::string_view type) {
    return {stub, type.empty() ? stub->rr_object_type().name : type};
  }

  const Adapters& adapters_;
};

}  // namespace rr::conformance
