// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "rr/dynamic.hpp"
#include "runtime/matlab/src/runtime.hpp"
#include "runtime/matlab/src/values.hpp"

namespace rr::matlab {

class Listeners;

/// A session with a service, and what the interpreter's user has asked for in it. It ends with the
/// last object, wire, ... that is held, or by close().
class Connection {
 public:
  Connection(Runtime& runtime, dynamic::Client client,
             std::shared_ptr<Listeners> session_listeners = nullptr);
  /// Of a subscription, which ends the sessions itself.
  explicit Connection(Runtime& runtime) : runtime_(runtime) {}
  ~Connection();
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  void close();
  [[nodiscard]] Runtime& runtime() const { return runtime_; }
  [[nodiscard]] const dynamic::Client& client() const { return client_; }
  [[nodiscard]] dynamic::Client& client() { return client_; }
  /// False once a session of its own has ended.
  [[nodiscard]] bool is_open() const { return !client_.rr_session() || client_.is_open(); }
  /// What is known of the service's types now.
  [[nodiscard]] dynamic::Definitions types() const;
  /// Any object, by which the types are known when there is no session of its own.
  std::optional<dynamic::Object> any_object;
  Plans plans;
  /// Who hears that the session has ended, or a path was released; null for a subscription's.
  const std::shared_ptr<Listeners> session_listeners;
  /// Whether events are put into the queue.
  const std::shared_ptr<std::atomic<bool>> has_events = std::make_shared<std::atomic<bool>>(true);

  /// Remembers a function of the user's, which goes with the connection.
  std::uint64_t add(UserFunction function);
  void remove(std::uint64_t function);
  /// The functions of callbacks, by object and member.
  std::unordered_map<std::string, std::uint64_t> callbacks;

 private:
  void end(std::uint64_t function);
  Runtime& runtime_;
  dynamic::Client client_;
  std::vector<std::uint64_t> functions_;
};

/// How a name that the user writes behind an object is meant.
enum class Use {
  get,
  set,
  call,
  generate,
  object,
  wire,
  pipe,
  memory,
  callback,
  event,
};

/// A name behind an object, looked up.
struct Resolved {
  Use use{};
  dynamic::MemberDescription member;
  std::string subject;             ///< `member pose`, for errors
  const TypePlan* plan = nullptr;  ///< of what is got; null for void
  std::vector<const TypePlan*> parameters;
};

/// An object on another node.
class ObjectHandle : public Handled {
 public:
  ObjectHandle(std::shared_ptr<Connection> connection, dynamic::Object object)
      : connection_(std::move(connection)), object_(std::move(object)) {}

  [[nodiscard]] const std::shared_ptr<Connection>& connection() const { return connection_; }
  [[nodiscard]] const dynamic::Object& object() const { return object_; }
  /// A member by its name; `get_` before the name of a property, objref, wire, ... and `set_`
  /// before that of a property mean the same as without. Throws rr::Error (member_not_found).
  const Resolved& resolve(const std::string& name);
  [[nodiscard]] ReadContext context(const dynamic::Definitions& types) const {
    return {connection_->plans, types};
  }

 private:
  [[nodiscard]] Resolved look_up(const std::string& name) const;
  const std::shared_ptr<Connection> connection_;
  const dynamic::Object object_;
  std::unordered_map<std::string, Resolved> resolved_;
};

/// The object whose number is the first argument; its connection is the current one.
std::shared_ptr<ObjectHandle> object_of(Runtime& runtime, Call& call, std::size_t index = 0);

/// A value that the user gives for a member. Throws rr::Error that names it.
dynamic::Value read_value(const ObjectHandle& object, const mxArray* given, const TypePlan* plan,
                          const std::string& subject);
/// Arguments of a function. Throws rr::Error when they are too many or too few.
dynamic::List read_arguments(const ObjectHandle& object, const Resolved& member,
                             const std::vector<const mxArray*>& given);
/// A function that the user gives for a thing. Throws rr::Error that names the thing.
const mxArray* need_function(const mxArray* given, const std::string& subject);
/// A value with its type, as those of type varvalue are received.
mxArray* varvalue_to_mex(const dynamic::Value& value, Connection& connection);
/// The number of an object for the interpreter.
mxArray* give_object(Runtime& runtime, std::shared_ptr<Connection> connection,
                     dynamic::Object object);
/// The same as a RobotRaconteurObject, where the toolbox is not there to make one of it.
mxArray* wrap_object(mxArray* number);
/// A number of the interpreter's for something held.
mxArray* give_handle(Runtime& runtime, std::shared_ptr<Handled> handled);

/// Arguments of an event or a callback, for the user's function.
std::vector<mxArray*> write_arguments(const dynamic::MemberDescription& member,
                                      const dynamic::List& arguments, Connection& connection);

/// Index of an objref; null for none. Throws rr::Error.
dynamic::Value read_index(const Resolved& member, const mxArray* given);

/// A generator's number, with what its steps take and give.
mxArray* give_generator(Runtime& runtime, const ObjectHandle& object, const Resolved& member,
                        dynamic::Generator generator);

/// The function that the user has set for a callback; `[]` for none.
mxArray* callback_function(const ObjectHandle& object, const Resolved& member);
/// Sets it; `[]` takes it away.
void set_callback(Runtime& runtime, const ObjectHandle& object, const Resolved& member,
                  const mxArray* function);

/// Calls the user's function of a callback. Throws rr::Error.
dynamic::Value run_callback(Runtime& runtime, const PendingCall& call);

}  // namespace rr::matlab
