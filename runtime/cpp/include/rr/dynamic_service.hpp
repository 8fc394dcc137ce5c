// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <exception>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "rr/dynamic.hpp"
#include "rr/service.hpp"
#include "rr/visibility.hpp"

/// A service that needs no generated code: objects from the text of a definition, whose members are
/// functions of the program that get and give values of types that are known at run time only.
/// Linked with robdef::dynamic.
///
///   rr::dynamic::Definitions definitions({text_of_the_definition, text_of_an_import});
///   rr::dynamic::ServedObject arm(definitions, "example.arm.Arm");
///   arm.store("speed", 0.5);
///   arm.on_call("move", [](const rr::dynamic::List& arguments) { return move(arguments[0]); });
///   rr::dynamic::register_service(node, "arm", arm);
///   arm.fire("stopped", {"at the end"});
///
/// Threads are those of generated skeletons (rr/skeleton.hpp, docs/explanation/threads.md);
/// functions may be set and members used on any thread. What a function gives is converted to the
/// declared type (docs/howto/dynamic.md); what does not fit is the client's data_type_mismatch, and
/// says which member expected what. What it throws is sent: an exception of the definition is an
/// rr::Error (remote_error) of its qualified name. A member without a function is
/// not_implemented_error.
///
/// All throw rr::Error: member_not_found and member_format_mismatch for a name that is no such
/// member, data_type_mismatch for a value that does not fit.
namespace RR_VISIBLE rr {
namespace dynamic {

class DynamicSkeleton;

/// The answer to one request that is given later, from any thread: `reply(value)` or
/// `reply.fail(error)`, exactly once, on one thread at a time. Copies are handles of the same one;
/// when the last is dropped without either, it answers with operation_aborted.
class Reply {
 public:
  /// For a set, and for a function without a result, no value. A value that does not fit is thrown
  /// here (data_type_mismatch), and the request waits on.
  void operator()(const Value& value = {}) const;
  /// Answers with this error. Exactly once, as operator().
  void fail(std::exception_ptr error) const;

  /// For the runtime: makes a reply that converts values to `type`; `subject` names it in errors.
  Reply(ReplyHandle handle, ValueType type, std::string subject);  // internal

 private:
  std::shared_ptr<ReplyHandle> handle_;
  ValueType type_;
  std::string subject_;
};

/// What a generator function gives: a coroutine whose values are Values, or a function that is
/// called for each step with what the step takes, null where it takes nothing. What it returns is
/// the step's value, null where it gives nothing; nothing at the end.
class Steps {
 public:
  /// A coroutine that gives values: co_yield.
  Steps(Sequence<Value> values);  // NOLINT
  /// A coroutine that takes values: co_await.
  Steps(Sequence<void, Value> values);  // NOLINT
  /// A coroutine that takes a value for each that it gives.
  Steps(Sequence<Value, Value> values);  // NOLINT
  /// A function for each step. `end` is called when the client closes (false) or aborts (true).
  explicit Steps(Function<std::optional<Value>(const Value&)> step,
                 Function<void(bool aborts)> end = {});
  /// A function for each step.
  template <class Step>
  requires std::is_invocable_r_v<std::optional<Value>, Step&, const Value&> Steps(Step step)
      : Steps(Function<std::optional<Value>(const Value&)>(std::move(step))) {}  // NOLINT

  /// For the runtime: what makes the steps.
  [[nodiscard]] const std::shared_ptr<GeneratorSource>& source() const { return source_; }
  /// For the runtime: none for one that suits any.
  [[nodiscard]] GeneratorForm form() const { return form_; }

 private:
  std::shared_ptr<GeneratorSource> source_;
  GeneratorForm form_ = GeneratorForm::none;
};

/// One client's end of a wire, with what rr::ServedWire has.
class ServedWire : public rr::ServedWire<Value> {
 public:
  /// No connection: not to be used.
  ServedWire() = default;
  /// Sends this client a value, converted to the declared type. Never blocks.
  void set_in(const Value& value);

  /// For the runtime: an end of a wire, whose values are converted to the type of `member`.
  ServedWire(rr::ServedWire<Value> end, MemberDescription member);  // internal

 private:
  MemberDescription member_;
};

/// A wire that an object offers: see rr::WireServer. Keeps the object.
class WireServer {
 public:
  /// Sends a value to all connected clients, and to each that connects later. Never blocks.
  void set_in(const Value& value) const;
  /// The newest value that any client has sent; nothing for none.
  [[nodiscard]] std::optional<Timed<Value>> out() const;
  /// One for each connected client.
  [[nodiscard]] std::vector<ServedWire> connections() const;
  /// How many clients are connected.
  [[nodiscard]] std::size_t connection_count() const;
  /// Values of clients that are older than this, from their arrival, are as none; 0: never. See
  /// rr::WireServer.
  void set_lifespan(std::chrono::milliseconds lifespan) const;
  /// Calls `function` with the end of each client that connects.
  void on_connect(Function<void(ServedWire)> function) const;
  /// Value, time, and the client's number.
  void on_out(Function<void(const Value&, const TimeSpec&, std::uint32_t)> function) const;
  /// The function's value answers peeks of clients, instead of what set_in() has sent last.
  void on_peek_in(Function<Value()> function) const;
  /// The function's value answers peeks of clients at what was received, instead of out().
  void on_peek_out(Function<Value()> function) const;

  /// For the runtime: ServedObject::wire() makes it.
  WireServer(std::shared_ptr<const DynamicSkeleton> object, const MemberTable& member);  // internal

 private:
  std::shared_ptr<const DynamicSkeleton> object_;
  const MemberTable* member_;
};

/// A pipe that an object offers: see rr::PipeServer. Keeps the object.
class PipeServer {
 public:
  /// Sends a packet to all endpoints of all clients. One whose connection takes no more is closed.
  void send(const Value& packet) const;
  /// All connected endpoints.
  [[nodiscard]] std::vector<PipeEndpoint> endpoints() const;
  /// How many endpoints are connected.
  [[nodiscard]] std::size_t endpoint_count() const;
  /// In send() endpoints with more unacknowledged packets are passed over; 0: none, the default.
  void set_backlog_limit(std::size_t packets) const;
  /// Calls `function` with each endpoint that a client connects, before the client has its answer.
  void on_connect(Function<void(PipeEndpoint)> function) const;

  /// For the runtime: ServedObject::pipe() makes it.
  PipeServer(std::shared_ptr<const DynamicSkeleton> object, const MemberTable& member);  // internal

 private:
  std::shared_ptr<const DynamicSkeleton> object_;
  const MemberTable* member_;
};

/// A memory that the program keeps. Called on threads of the node, perhaps several at once, with
/// parts that lie inside: a position and a count for each dimension.
struct MemoryFunctions {
  /// A number for each dimension.
  using Numbers = Memory::Numbers;
  Function<Numbers()> dims{};  ///< one length, or one for each dimension
  /// As many items as the counts say.
  Function<Value(const Numbers& position, const Numbers& count)> read{};
  /// Takes items at a position.
  Function<void(const Numbers& position, const Value& items)> write{};
};

class WeakServedObject;

/// An object that services offer: a handle that is copied freely. A service keeps it while it is
/// offered. A function that is set here and has a handle of the same object keeps it for ever; it
/// should have a WeakServedObject.
class ServedObject {
 public:
  /// No object: what an objref gives where there is none.
  ServedObject() = default;
  /// `type` is qualified. Throws rr::Error (key_not_found) when no definition has it.
  ServedObject(const Definitions& definitions, std::string_view type);

  /// The qualified name of its type.
  [[nodiscard]] const std::string& type_name() const;
  /// Its members, in the order of the definition.
  [[nodiscard]] std::vector<MemberDescription> members() const;
  /// One member. Throws rr::Error (member_not_found).
  [[nodiscard]] MemberDescription member(std::string_view name) const;
  /// The definitions that it was made with.
  [[nodiscard]] Definitions types() const;

  /// Keeps the value of a property here, from this first one on. Of a `perclient` one each client
  /// has its own.
  void store(std::string_view property, const Value& first) const;
  /// What is stored; in a request of a client its own value.
  [[nodiscard]] Value stored(std::string_view property) const;
  /// A function gives the value of a property. What it returns is converted to the declared type.
  void on_get(std::string_view property, Function<Value()> function) const;
  /// A function takes what clients set, a value of the declared type.
  void on_set(std::string_view property, Function<void(const Value&)> function) const;
  /// As on_get(); the function answers now or later, from any thread.
  void on_get_later(std::string_view property, Function<void(Reply)> function) const;
  /// As on_set(); the function answers now or later, from any thread.
  void on_set_later(std::string_view property, Function<void(const Value&, Reply)> function) const;

  /// A function of the program for one of the definition. It gets the parameters in their order;
  /// what it returns is converted to the declared type, and does not matter for one without a
  /// result.
  void on_call(std::string_view function, Function<Value(const List&)> handler) const;
  /// As on_call(); the function answers now or later, from any thread.
  void on_call_later(std::string_view function, Function<void(const List&, Reply)> handler) const;
  /// A function that gives a generator.
  void on_generate(std::string_view function, Function<Steps(const List&)> handler) const;

  /// Gives the object that is asked for; the index is null, a number or a text. Called once for
  /// each path until the object there is released. The object is of the same definitions and of the
  /// declared type or one that implements it, which is checked (invalid_operation); for
  /// `rr::per_client` give its skeleton().
  void on_object(std::string_view objref,
                 Function<std::shared_ptr<Skeleton>(const Value& index)> handler) const;

  /// Notifies all clients of the services that offer the object. Never blocks.
  void fire(std::string_view event, const List& arguments = {}) const;

  /// Calls the function of one client: see Skeleton::rr_call_back. Null for one without a result.
  Value call_back(std::string_view callback, std::uint32_t client,
                  const List& arguments = {}) const;
  /// As call_back(), without waiting.
  void async_call_back(std::string_view callback, std::uint32_t client, const List& arguments,
                       Done<Value> done) const;

  /// A wire of the object.
  [[nodiscard]] WireServer wire(std::string_view name) const;
  /// A pipe of the object.
  [[nodiscard]] PipeServer pipe(std::string_view name) const;

  /// Memories: kept here, of this content, or by functions.
  void store_memory(std::string_view name, const Value& content) const;
  /// What is kept of a memory now.
  [[nodiscard]] Value stored_memory(std::string_view name) const;
  /// A memory by functions of the program.
  void serve_memory(std::string_view name, MemoryFunctions functions) const;

  /// See Skeleton::rr_attached and rr_released.
  void on_attached(Function<void(ServiceContext&, const std::string& path)> function) const;
  /// Called when a service has forgotten the object at a path; see Skeleton::rr_released.
  void on_released(Function<void(const std::string& path)> function) const;
  /// Gives the object a monitor: see Skeleton::rr_has_monitor. Before it is offered.
  void set_monitor(Function<bool(std::chrono::milliseconds)> enter, Function<void()> exit) const;

  /// As generated code has objects: for Node::register_service and rr::per_client.
  [[nodiscard]] std::shared_ptr<Skeleton> skeleton() const;
  /// The same as skeleton().
  operator std::shared_ptr<Skeleton>() const { return skeleton(); }  // NOLINT
  /// False for no object.
  explicit operator bool() const { return skeleton_ != nullptr; }

  /// For the runtime: a handle of an object that exists.
  explicit ServedObject(std::shared_ptr<DynamicSkeleton> skeleton)
      : skeleton_(std::move(skeleton)) {}  // internal

 private:
  friend class WeakServedObject;
  [[nodiscard]] DynamicSkeleton& need() const;
  std::shared_ptr<DynamicSkeleton> skeleton_;
};

/// A handle that does not keep the object.
class WeakServedObject {
 public:
  /// Refers to no object.
  WeakServedObject() = default;
  /// Refers to this object without keeping it.
  WeakServedObject(const ServedObject& object) : skeleton_(object.skeleton_) {}  // NOLINT
  /// No object when it has gone.
  [[nodiscard]] ServedObject lock() const { return ServedObject(skeleton_.lock()); }

 private:
  std::weak_ptr<DynamicSkeleton> skeleton_;
};

/// Offers an object, as Node::register_service. All definitions that it was made with are offered
/// with it, whether imported or not; with `extra` those that it imports and those of these names.
/// The node keeps all of them. A node knows one definition of each
/// name, the first that it was given.
Service register_service(Node& node, std::string name, const ServedObject& root,
                         ServiceOptions options = {},
                         const std::optional<std::set<std::string>>& extra = {});

}  // namespace dynamic
}  // namespace rr
