// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <exception>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "rr/callbacks.hpp"
#include "rr/client.hpp"
#include "rr/dynamic_definitions.hpp"
#include "rr/dynamic_value.hpp"
#include "rr/function.hpp"
#include "rr/generators.hpp"
#include "rr/locks.hpp"
#include "rr/memories.hpp"
#include "rr/node.hpp"
#include "rr/pipes.hpp"
#include "rr/subscription.hpp"
#include "rr/visibility.hpp"
#include "rr/wires.hpp"

namespace RR_VISIBLE rr {

/// A client that needs no generated code: members by name, with values of types that are known at
/// run time only. Linked with robdef::dynamic.
///
///   auto arm = rr::dynamic::connect(node, "rr+tcp://host:6257/?service=arm");
///   arm->set("speed", 0.5);
///   rr::dynamic::Value pose = arm->call("move", {{1.0, 2.0}, "fast"});
///   double x = pose["position"]["x"].as<double>();
///
/// Threads, time-outs, cancelling and what handlers may do are as with generated stubs
/// (docs/explanation/threads.md). Everything throws rr::Error: member_not_found and
/// member_format_mismatch for a name that is no such member, data_type_mismatch for a value that
/// does not fit, all naming the member and the type that is expected, before anything is sent.
namespace dynamic {

class DynamicStub;
struct ObjectTable;
struct MemberTable;

/// What asynchronous calls end with: called once, on a thread of the node. The exception is null
/// when the call has succeeded.
template <class... Result>
using Done = Function<void(std::exception_ptr, Result...)>;

/// A generator on another node.
class Generator : public GeneratorHandle {
 public:
  /// No generator: not to be used.
  Generator() = default;
  /// One step: `parameter` is for those that take values; null is given back where none is given.
  /// Nothing at the end.
  std::optional<Value> next(const Value& parameter = {});
  /// The same without waiting: `done` gets the value, or nothing at the end.
  void async_next(const Value& parameter, Done<std::optional<Value>> done);
  /// No more steps are wanted. Does not wait.
  void async_close(Done<> done);
  /// Breaks off: the service's generator sees abort_operation. Does not wait.
  void async_abort(Done<> done);

  /// For the runtime: Object::generate() makes it.
  Generator(std::shared_ptr<GeneratorState> state, MemberDescription member);  // internal

 private:
  [[nodiscard]] Value convert(const Value& parameter) const;
  MemberDescription member_;
};

/// A connected wire, with what rr::WireConnection has.
class WireConnection : public rr::WireConnection<Value> {
 public:
  /// No wire: not to be used.
  WireConnection() = default;
  /// Sends a value to the service, converted to the declared type. Never blocks. Throws rr::Error
  /// as rr::WireConnection::set_out().
  void set_out(const Value& value);

  /// For the runtime: Wire::connect() makes it.
  WireConnection(rr::WireConnection<Value> end, MemberDescription member);  // internal

 private:
  MemberDescription member_;
};

/// A wire of an object on another node.
class Wire {
 public:
  /// Connects the wire and waits for the answer.
  WireConnection connect() const;
  /// Asks for the service's value now, without a connection. Throws rr::Error (value_not_set) when
  /// there is none.
  [[nodiscard]] Timed<Value> peek_in() const;
  /// Asks for the value that the service has last received from a client. Throws as peek_in().
  [[nodiscard]] Timed<Value> peek_out() const;
  /// Gives the service a value, without a connection.
  void poke_out(const Value& value) const;
  /// As connect(), without waiting.
  void async_connect(Done<WireConnection> done) const;
  /// As peek_in(), without waiting.
  void async_peek_in(Done<Timed<Value>> done) const;
  /// As peek_out(), without waiting.
  void async_peek_out(Done<Timed<Value>> done) const;
  /// As poke_out(), without waiting. The value is sent, or copied, before this returns.
  void async_poke_out(const Value& value, Done<> done) const;

  /// For the runtime: Object::wire() makes it.
  Wire(std::shared_ptr<DynamicStub> stub, const MemberTable& member);  // internal

 private:
  std::shared_ptr<DynamicStub> stub_;
  const MemberTable* member_;
};

/// A connected pipe endpoint, with what rr::PipeEndpoint has.
class PipeEndpoint : public rr::PipeEndpoint<Value> {
 public:
  /// No endpoint: not to be used.
  PipeEndpoint() = default;
  /// Sends a packet, converted to the declared type, and returns its number: 1, 2, ... Never
  /// blocks. Throws rr::Error as rr::PipeEndpoint::send().
  std::uint32_t send(const Value& packet);

  /// For the runtime: Pipe::connect() makes it.
  PipeEndpoint(rr::PipeEndpoint<Value> end, MemberDescription member);  // internal

 private:
  MemberDescription member_;
};

/// A pipe of an object on another node.
class Pipe {
 public:
  /// Connects an endpoint and waits for the answer.
  PipeEndpoint connect(const PipeOptions& options = {}) const;
  /// As connect(), without waiting.
  void async_connect(Done<PipeEndpoint> done, const PipeOptions& options = {}) const;
  /// Finds out whether a lock of the object keeps this client out, without an endpoint that the
  /// service would see come and go. Fails with object_locked_error then; any other error, or none,
  /// means that no lock does.
  void async_check_lock(Done<> done) const;

  /// For the runtime: Object::pipe() makes it.
  Pipe(std::shared_ptr<DynamicStub> stub, const MemberTable& member);  // internal

 private:
  std::shared_ptr<DynamicStub> stub_;
  const MemberTable* member_;
};

/// A memory of an object on another node. Positions and counts: one number for each dimension.
class Memory {
 public:
  /// A number for each dimension.
  using Numbers = std::vector<std::uint64_t>;
  /// Items of a memory of one dimension. Asks the service.
  [[nodiscard]] std::uint64_t length() const;
  /// Length of each dimension, of a memory with several. Asks the service.
  [[nodiscard]] Numbers dims() const;
  /// Number of dimensions. Asks the service.
  [[nodiscard]] std::uint64_t dim_count() const;
  /// Bytes that one item takes in this process.
  [[nodiscard]] std::size_t item_size() const;
  /// An array; of several dimensions one with dims.
  [[nodiscard]] Value read(const Numbers& position, const Numbers& count) const;
  /// The counts are those of the array.
  void write(const Numbers& position, const Value& items) const;
  /// As read(), without waiting.
  void async_read(const Numbers& position, const Numbers& count, Done<Value> done) const;
  /// As write(), without waiting.
  void async_write(const Numbers& position, const Value& items, Done<> done) const;

  /// For the runtime: Object::memory() makes it.
  Memory(std::shared_ptr<DynamicStub> stub, const MemberTable& member);  // internal

 private:
  std::shared_ptr<DynamicStub> stub_;
  const MemberTable* member_;
};

/// A callback of an object on another node.
class Callback {
 public:
  /// The function gets the parameters in their order; what it returns is converted to the declared
  /// type, and ignored for void.
  void set(Function<Value(const List&)> function) const;
  /// As rr::CallbackMember::clear().
  void clear() const;

  /// For the runtime: Object::callback() makes it.
  Callback(std::shared_ptr<DynamicStub> stub, const MemberTable& member);  // internal

 private:
  std::shared_ptr<DynamicStub> stub_;
  const MemberTable* member_;
};

/// An object on another node: a handle that is copied freely. It keeps its session alive but does
/// not hold the connection open.
class Object {
 public:
  /// No object: not to be used.
  Object() = default;

  /// Where it is in its service: `arm.tools[left]`.
  [[nodiscard]] const std::string& path() const;
  /// Qualified.
  [[nodiscard]] const std::string& type_name() const;
  /// The comments before the object in its definition, without their marks; empty for none.
  [[nodiscard]] const std::string& documentation() const;
  /// In the order of the definition.
  [[nodiscard]] std::vector<MemberDescription> members() const;
  /// One member. Throws rr::Error (member_not_found).
  [[nodiscard]] MemberDescription member(std::string_view name) const;
  /// The definitions that it was found by.
  [[nodiscard]] Definitions types() const;

  /// Asks for the value of a property.
  [[nodiscard]] Value get(std::string_view property) const;
  /// Sets a property to a value, which is converted to the declared type.
  void set(std::string_view property, const Value& value) const;
  /// Null for a function that returns nothing.
  Value call(std::string_view function, const List& arguments = {}) const;
  /// Calls a function that gives a generator.
  Generator generate(std::string_view function, const List& arguments = {}) const;
  /// The object at an objref without an index.
  [[nodiscard]] Object object(std::string_view objref) const;
  /// The object at an objref with an int32 index.
  [[nodiscard]] Object object(std::string_view objref, std::int32_t index) const;
  /// The object at an objref with a string index.
  [[nodiscard]] Object object(std::string_view objref, std::string_view index) const;
  /// Calls `function` with the parameters of each event; see rr::Event::connect.
  [[nodiscard]] Subscription on_event(std::string_view event,
                                      Function<void(const List&)> function) const;
  /// A wire of the object. Nothing is sent.
  [[nodiscard]] Wire wire(std::string_view name) const;
  /// A pipe of the object. Nothing is sent.
  [[nodiscard]] Pipe pipe(std::string_view name) const;
  /// A memory of the object. Nothing is sent.
  [[nodiscard]] Memory memory(std::string_view name) const;
  /// A callback of the object. Nothing is sent.
  [[nodiscard]] Callback callback(std::string_view name) const;

  /// As get(), without waiting. This and the following convert and send at once, so that what is
  /// given need not live longer.
  void async_get(std::string_view property, Done<Value> done) const;
  /// As set(), without waiting.
  void async_set(std::string_view property, const Value& value, Done<> done) const;
  /// As call(), without waiting.
  void async_call(std::string_view function, const List& arguments, Done<Value> done) const;
  /// As generate(), without waiting.
  void async_generate(std::string_view function, const List& arguments, Done<Generator> done) const;
  /// `index` is null, a number or a text, as the objref needs it.
  void async_object(std::string_view objref, const Value& index, Done<Object> done) const;

  /// For rr::lock, rr::enter_monitor, rr::MonitorLock, and time-outs.
  [[nodiscard]] Stub& stub() const;
  /// The same stub, kept alive by what is returned.
  [[nodiscard]] std::shared_ptr<Stub> shared_stub() const;
  /// The object of such a stub; throws rr::Error (invalid_argument) for one of generated code.
  static Object of(const std::shared_ptr<Stub>& stub);

  /// For the runtime: a handle of the object that a stub stands for.
  explicit Object(std::shared_ptr<DynamicStub> stub) : stub_(std::move(stub)) {}  // internal

 private:
  [[nodiscard]] const MemberTable& need(std::string_view name, MemberKind kind) const;
  [[nodiscard]] const MemberTable& need_function(std::string_view name, bool is_generator) const;
  std::shared_ptr<DynamicStub> stub_;
};

class DefinitionStore;

/// A session with a service, which it closes when destroyed, and the service's root object.
class Client : public ClientBase {
 public:
  /// No session: not to be used.
  Client() = default;

  /// The root object: `client->get("speed")`.
  const Object* operator->() const { return &root_; }
  /// The root object.
  const Object& operator*() const { return root_; }
  /// The root object.
  [[nodiscard]] const Object& root() const { return root_; }
  /// What the service has sent so far.
  [[nodiscard]] Definitions types() const;
  /// A varvalue of the service, as of an error's parameter.
  [[nodiscard]] Value value(const VarValue& varvalue) const;
  /// As the service gave them when connecting, which is before its definitions are read: empty when
  /// one of them is of a named type.
  [[nodiscard]] StringMap attributes() const;
  /// As they are now, all of them.
  [[nodiscard]] StringMap fetch_attributes() const;

  /// For the runtime: connect() makes clients.
  Client(rr::Client<Stub> client, std::shared_ptr<DefinitionStore> store);  // internal

 private:
  std::shared_ptr<DefinitionStore> store_;
  Object root_;
};

/// Connects to the service at a URL and reads its definitions. Throws rr::Error:
/// service_definition_error for definitions with mistakes.
Client connect(Node& node, std::string_view url, ConnectOptions options = {});
/// The same without waiting: on a thread of its own, where `done` is called, too.
void async_connect(Node& node, std::string url, ConnectOptions options, Done<Client> done);

/// Keeps a connection to the service at a URL; see rr/subscription.hpp. Its clients are objects of
/// this kind: `Object::of(subscription.default_client<Stub>())`. Does not wait. Throws rr::Error as
/// Node::subscribe.
ServiceSubscription subscribe(Node& node, std::string_view url, SubscriptionOptions options = {});

/// The same with several ways to one service, tried in this order.
ServiceSubscription subscribe(Node& node, std::vector<std::string> urls,
                              SubscriptionOptions options = {});
/// The same with all services of these types that are found; see Node::subscribe_types.
ServiceSubscription subscribe_types(Node& node, std::vector<std::string> types,
                                    SubscriptionOptions options = {});

/// For credentials and parameters of errors. Throws rr::Error (data_type_error) for what no
/// varvalue holds.
VarValue to_varvalue(const Value& value);

}  // namespace dynamic
}  // namespace rr
