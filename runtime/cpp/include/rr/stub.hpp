// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <exception>
#include <memory>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "rr/call.hpp"
#include "rr/definition.hpp"
#include "rr/error.hpp"
#include "rr/type.hpp"
#include "rr/varvalue.hpp"
#include "rr/visibility.hpp"

/// What generated stubs stand on: the client's side of an object.
namespace RR_VISIBLE rr {

/// Number of the contract between generated code and this runtime. Generated headers refuse
/// another.
inline constexpr int stub_api = 3;

class Session;
class Stub;
struct GeneratorState;
template <class R, class P>
class Generator;

/// Ends a handler's connection to an event when it is destroyed, or by disconnect().
class [[nodiscard]] Subscription {
 public:
  /// Nothing is connected.
  Subscription() = default;
  /// Takes over the handler; the other has none afterwards.
  Subscription(Subscription&& other) noexcept;
  /// Disconnects this handler, and takes over the other one.
  Subscription& operator=(Subscription&& other) noexcept;
  ~Subscription();

  /// The handler is not called any more once this returns, unless it is the caller itself.
  void disconnect();
  /// Leaves the handler connected for as long as the stub lives.
  void detach();

  /// For the runtime: a function that is connected.
  struct Handler;  // internal
  /// For the runtime: what is made by connecting a function.
  explicit Subscription(std::shared_ptr<Handler> handler);

 private:
  std::shared_ptr<Handler> handler_;
};

/// Reads the values of a received packet or request, in any order, by name.
class Arguments {
 public:
  /// Reads the parameters of a member into `values`, one pointer each, in their order. Throws
  /// rr::Error (message_element_not_found, data_type_mismatch, ...) naming the parameter.
  void read(const Member& member, void* const* values) const;

  /// For the runtime: the bytes, and how they are read.
  struct Source;  // internal
  /// For the runtime: arguments that have arrived.
  explicit Arguments(const Source& source) : source_(&source) {}
  /// For the runtime: the bytes, and how they are read.
  [[nodiscard]] const Source& rr_source() const { return *source_; }

 private:
  const Source* source_;
};

/// Calls a function when an event arrives. Made by Event::connect.
class EventHandler {
 public:
  virtual ~EventHandler() = default;
  /// Reads the parameters and calls the function.
  virtual void call(const Arguments& arguments) = 0;

 protected:
  /// For an event that the definition describes so.
  explicit EventHandler(const Member& member) : member_(&member) {}
  /// The event in its definition.
  [[nodiscard]] const Member& member() const { return *member_; }

 private:
  const Member* member_;
};

/// An event of an object on another node.
template <class... Parameters>
class Event {
 public:
  /// For generated code: an event of an object.
  Event(Stub& stub, const Member& member) : stub_(&stub), member_(&member) {}

  /// Calls `function` for each event from now on, in order, on a thread of the node, never under a
  /// lock and never inside a call that the program makes. It may make calls itself. What it throws
  /// is given to the node's log. Connect before the events that matter: the service sends to
  /// all clients and keeps nothing.
  template <class Function>
  Subscription connect(Function function);

 private:
  Stub* stub_;
  const Member* member_;
};

/// Where an asynchronous call leaves its result. Derived by rr/async.hpp; the runtime calls exactly
/// one of the two, once, on a thread of the node, under no lock.
class Completion {
 public:
  virtual ~Completion() = default;
  /// Where to read the result into; null for none.
  virtual void* result() = 0;
  /// The call has succeeded; result() has been filled.
  virtual void succeed() = 0;
  /// The call has failed.
  virtual void fail(std::exception_ptr error) = 0;
};

/// The base of every generated stub: an object on another node, named by its path. Calls may be
/// made from any thread at once. A stub keeps its session alive but does not hold the connection
/// open. The stub of an object derives, virtually, from the stubs of the objects it implements.
class Stub {
 public:
  /// Attached to no session: calls throw rr::Error (invalid_operation).
  Stub() = default;
  virtual ~Stub();
  Stub(const Stub&) = delete;
  Stub& operator=(const Stub&) = delete;

  /// The object's type; the most derived one that this program knows.
  [[nodiscard]] virtual const ObjectType& rr_object_type() const = 0;
  /// For stubs of a class that is for objects of any type: called once by the session that has made
  /// one, before the caller has it.
  virtual void rr_take_object_type(const ObjectType& /*type*/) {}
  /// `service.objref[index]...`
  [[nodiscard]] const std::string& rr_path() const { return rr_path_; }
  /// For the runtime: the session; null for a stub of none.
  [[nodiscard]] const std::shared_ptr<Session>& rr_session() const { return rr_session_; }
  /// How long a call waits for its answer: by default the node's request timeout (15 s).
  void rr_set_timeout(std::chrono::milliseconds timeout) { rr_timeout_ = timeout; }
  /// How long calls wait, as rr_set_timeout() has it; 0: as the client or the node say.
  [[nodiscard]] std::chrono::milliseconds rr_timeout() const { return rr_timeout_; }

 protected:
  /// For generated code: gets a property. Blocks until the answer is there, and throws rr::Error,
  /// as do the following.
  void rr_get(const Member& member, const CallOptions& options, void* value);
  /// For generated code: sets a property.
  void rr_set(const Member& member, const CallOptions& options, const void* value);
  /// For generated code: calls a function.
  void rr_invoke(const Member& member, const CallOptions& options, const void* const* arguments,
                 void* result);
  /// For generated code: finds the object at an objref without an index.
  std::shared_ptr<Stub> rr_find(const Member& member, const CallOptions& options);
  /// For generated code: finds the object at an objref with an int32 index.
  std::shared_ptr<Stub> rr_find(const Member& member, const CallOptions& options,
                                std::int32_t index);
  /// For generated code: finds the object at an objref with a string index.
  std::shared_ptr<Stub> rr_find(const Member& member, const CallOptions& options,
                                std::string_view index);

  /// For generated code: gets a property.
  template <class T>
  T rr_get(const Member& member, const CallOptions& options) {
    T value{};
    rr_get(member, options, &value);
    return value;
  }
  /// For generated code: calls a function.
  template <class R, class... Arguments>
  R rr_call(const Member& member, const CallOptions& options, const Arguments&... arguments) {
    const void* const values[] = {&arguments..., nullptr};
    if constexpr (std::is_void_v<R>) {
      rr_invoke(member, options, values, nullptr);
    } else {
      R result{};
      rr_invoke(member, options, values, &result);
      return result;
    }
  }
  /// For generated code: finds the object at an objref, which must be an S (service_error).
  template <class S, class... Index>
  std::shared_ptr<S> rr_find_as(const Member& member, const CallOptions& options,
                                const Index&... index) {
    auto stub = std::dynamic_pointer_cast<S>(rr_find(member, options, index...));
    if (!stub) rr_refuse(member);
    return stub;
  }

  /// Calls a generator function; see rr/generators.hpp.
  template <class R, class P, class... Arguments>
  Generator<R, P> rr_generate(const Member& member, const CallOptions& options,
                              const Arguments&... arguments);

  /// For generated code: calls a function. This and the following encode and send now, and complete
  /// later; they are defined in rr/async.hpp, which a program includes that calls an async_ member.
  template <class R, class Token, class... Arguments>
  requires AsyncHeaderIsIncluded<Token>
  auto rr_async_call(const Member& member, const CallOptions& options, Token&& token,
                     const Arguments&... arguments);
  /// For generated code: gets a property.
  template <class T, class Token>
  requires AsyncHeaderIsIncluded<Token>
  auto rr_async_get(const Member& member, const CallOptions& options, Token&& token);
  /// For generated code: sets a property.
  template <class T, class Token>
  requires AsyncHeaderIsIncluded<Token>
  auto rr_async_set(const Member& member, const CallOptions& options, Token&& token,
                    const T& value);
  /// For generated code: finds the object at an objref.
  template <class S, class Token, class... Index>
  requires AsyncHeaderIsIncluded<Token>
  auto rr_async_find(const Member& member, const CallOptions& options, Token&& token,
                     const Index&... index);
  /// For generated code: calls a generator function.
  template <class R, class P, class Token, class... Arguments>
  requires AsyncHeaderIsIncluded<Token>
  auto rr_async_generate(const Member& member, const CallOptions& options, Token&& token,
                         const Arguments&... arguments);

  /// What the asynchronous templates stand on: encodes and sends at once, so arguments need not
  /// outlive the call. `set` tells a property's two requests apart.
  void rr_start(const Member& member, bool set, const void* const* arguments,
                std::unique_ptr<Completion> completion);
  /// As rr_start(), for an objref without an index.
  void rr_start_find(const Member& member, std::unique_ptr<Completion> completion);
  /// As rr_start(), for an objref with an int32 index.
  void rr_start_find(const Member& member, std::int32_t index,
                     std::unique_ptr<Completion> completion);
  /// As rr_start(), for an objref with a string index.
  void rr_start_find(const Member& member, std::string_view index,
                     std::unique_ptr<Completion> completion);
  /// What rr_generate() stands on.
  std::shared_ptr<GeneratorState> rr_open_generator(const Member& member,
                                                    const void* const* arguments);
  /// As rr_start(), for a generator function. The result of the completion is a
  /// std::shared_ptr<GeneratorState>.
  void rr_start_generator(const Member& member, const void* const* arguments,
                          std::unique_ptr<Completion> completion);
  /// Throws rr::Error: an objref has given an object of another type.
  [[noreturn]] static void rr_refuse(const Member& member);  // an object of another type
  /// What Event::connect() stands on.
  Subscription rr_connect(const Member& member, std::unique_ptr<EventHandler> handler);

 private:
  friend class Session;
  template <class...>
  friend class Event;

  template <class Handler, class S>
  friend class FindCompletion;

  std::shared_ptr<Session> rr_session_;
  std::string rr_path_;
  std::chrono::milliseconds rr_timeout_{0};
};

template <class... Parameters>
template <class Function>
Subscription Event<Parameters...>::connect(Function function) {
  class Bound final : public EventHandler {
   public:
    Bound(const Member& member, Function&& call) : EventHandler(member), call_(std::move(call)) {}
    void call(const Arguments& arguments) override {
      std::tuple<Parameters...> values;
      std::apply(
          [&](auto&... value) {
            void* const places[] = {&value..., nullptr};
            arguments.read(member(), places);
            call_(value...);
          },
          values);
    }

   private:
    Function call_;
  };
  return stub_->rr_connect(*member_, std::make_unique<Bound>(*member_, std::move(function)));
}

}  // namespace rr
