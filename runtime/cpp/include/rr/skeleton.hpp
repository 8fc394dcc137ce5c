// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <memory>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

#include "rr/call.hpp"
#include "rr/definition.hpp"
#include "rr/error.hpp"
#include "rr/generators.hpp"
#include "rr/holding.hpp"
#include "rr/memories.hpp"
#include "rr/stub.hpp"
#include "rr/type.hpp"
#include "rr/varvalue.hpp"
#include "rr/visibility.hpp"

/// What generated skeletons stand on: the service's side of an object.
namespace RR_VISIBLE rr {

class ServiceContext;
class Skeleton;

/// The answer to one request that a handler gives later, from any thread: `reply(value)` or
/// `reply.fail(error)`, exactly once. Dropped without either, it answers with operation_aborted.
class ReplyHandle {
 public:
  /// Takes over the answer; the other handle answers no more.
  ReplyHandle(ReplyHandle&&) noexcept;
  /// Takes over the answer. One that this handle had not given is operation_aborted.
  ReplyHandle& operator=(ReplyHandle&&) noexcept;
  ~ReplyHandle();
  /// Answers with an error, which the client gets.
  void fail(std::exception_ptr error);

  /// For the runtime: which request is answered.
  struct State;  // internal
  /// For the runtime: Request::defer() makes it.
  explicit ReplyHandle(std::unique_ptr<State> state);

 protected:
  /// Answers with a value of the member's type; null for a function without one.
  void succeed(const void* result);

 private:
  std::unique_ptr<State> state_;
};

/// The answer to a call that returns an R: see ReplyHandle.
template <class R>
class Reply : public ReplyHandle {
 public:
  /// For the runtime: Request::defer() makes it.
  using ReplyHandle::ReplyHandle;
  /// For generated code: Request::defer() with its type.
  explicit Reply(ReplyHandle&& handle) : ReplyHandle(std::move(handle)) {}
  /// Answers with the result. Throws rr::Error when it cannot be sent.
  void operator()(const R& result) { succeed(&result); }
};
/// The answer to a call that returns nothing, or to the set of a property: see ReplyHandle.
template <>
class Reply<void> : public ReplyHandle {
 public:
  /// For the runtime: Request::defer() makes it.
  using ReplyHandle::ReplyHandle;
  /// For generated code: Request::defer() with its type.
  explicit Reply(ReplyHandle&& handle) : ReplyHandle(std::move(handle)) {}
  /// Answers that it is done.
  void operator()() { succeed(nullptr); }
};

/// One request to a member, as a generated skeleton sees it.
class Request {
 public:
  /// True for the set of a property.
  [[nodiscard]] bool is_set() const;
  /// Reads the value of a property set. Throws rr::Error.
  void read_value(void* value) const;
  /// Reads a function's parameters, one pointer each, in their order. Throws rr::Error.
  void read_arguments(void* const* values) const;
  /// Reads a function's parameters into `values`, in their order. Throws rr::Error.
  template <class... Values>
  void read(Values&... values) const {
    void* const places[] = {&values..., nullptr};
    read_arguments(places);
  }
  /// Answers with a value of the member's type; null for a function without one.
  void answer(const void* value);
  /// Leaves the answer for later: the next request of this client is handled meanwhile.
  ReplyHandle defer();
  /// Answers the call of a generator function: the client may step through `sequence` from now on.
  template <class R, class P>
  void answer(Sequence<R, P> sequence) {
    const Holding* result = nullptr;
    const Holding* parameter = nullptr;
    if constexpr (!std::is_void_v<R>) result = &holding_of<R>;
    if constexpr (!std::is_void_v<P>) parameter = &holding_of<P>;
    answer_generator(std::move(sequence).source(), result, parameter);
  }

  /// For the runtime: where the request has come from.
  struct Source;  // internal
  /// For the runtime: one request of a session.
  explicit Request(Source& source) : source_(&source) {}
  /// For the runtime: where the request has come from.
  [[nodiscard]] const Source& rr_source() const { return *source_; }
  /// What answer(Sequence) does, without its types.
  void answer_generator(std::shared_ptr<GeneratorSource> source, const Holding* result,
                        const Holding* parameter);

 private:
  Source* source_;
};

/// Which object of an objref is asked for.
struct ObjectIndex {
  std::int32_t number = 0;  ///< of an int32 index
  std::string_view text;    ///< of a string index, decoded
};

/// The base of every generated skeleton: an object that a service offers. Its members are called on
/// the thread that read the request, one at a time and in order for each client; calls of different
/// clients may overlap, and so does one that waits for a callback (rr_call_back) with those that
/// its client requests meanwhile. The skeleton of an object has the members of those it implements.
class Skeleton {
 public:
  /// Made before it is offered.
  Skeleton();
  virtual ~Skeleton();
  Skeleton(const Skeleton&) = delete;
  Skeleton& operator=(const Skeleton&) = delete;

  /// For generated code: the object's table.
  [[nodiscard]] virtual const ObjectType& rr_object_type() const = 0;
  /// Called by the service when the object is first reached, before any member is: `path` is where.
  /// An object may be reached by several paths. The context lives until the service is closed.
  virtual void rr_attached(ServiceContext& context, const std::string& path);
  /// Called when the service has forgotten the object at a path: that was released, the service is
  /// closed, or the object was a client's own (per_client()) and the client has gone. On a thread
  /// of the node; a client's own object is told behind the last request of that client.
  virtual void rr_released(const std::string& /*path*/) {}

  /// For generated code: handles a request for the member at this place in
  /// rr_object_type().members.
  virtual void rr_dispatch(std::size_t member, Request& request) = 0;
  /// For generated code: finds the object at the objref at this place in rr_object_type().members.
  /// Null for none.
  virtual std::shared_ptr<Skeleton> rr_child(std::size_t member, const ObjectIndex& index) = 0;
  /// Null for a member that is no memory.
  virtual std::shared_ptr<MemorySource> rr_memory(std::size_t member);

  /// Whether sessions may have the object to themselves (rr/locks.hpp), and how: enter waits until
  /// the object is free, for `timeout` at most, and says whether it is this caller's now. Enter and
  /// exit are called on different threads of the node, so they do not fit a std::mutex; a
  /// std::binary_semaphore will do. One session at a time is let in; a part of the program that
  /// takes the same semaphore keeps all of them out.
  [[nodiscard]] virtual bool rr_has_monitor() const { return false; }
  /// Waits until the object is free, for `timeout` at most; see rr_has_monitor().
  virtual bool rr_monitor_enter(std::chrono::milliseconds /*timeout*/) { return true; }
  /// Leaves the monitor, perhaps on another thread than rr_monitor_enter(); see rr_has_monitor().
  virtual void rr_monitor_exit() {}

  /// Where it is reached: the first path of those where it is now; empty while it is at none.
  [[nodiscard]] std::string rr_path() const;
  /// The service there, null while there is none. Keeps it, so it is not to be kept by the object.
  [[nodiscard]] std::shared_ptr<ServiceContext> rr_service() const;

  /// For the runtime: where the object is attached.
  struct Places;  // internal: where the object is attached

  /// What per_client() does.
  void rr_set_per_client() const;

 protected:
  /// Sends an event to every client of each service that offers this object. Throws rr::Error for
  /// values that cannot be written. Where it is too large to be sent, NodeOptions::log is told.
  void rr_fire(const Member& member, const void* const* arguments) const;
  /// For generated code: rr_fire() with the arguments as they are.
  template <class... Arguments>
  void rr_fire_event(const Member& member, const Arguments&... arguments) const {
    const void* const values[] = {&arguments..., nullptr};
    rr_fire(member, values);
  }

  /// Calls a callback of one client, `client` being the number of its endpoint in this node
  /// (ServiceContext::current_client()), and waits for what it returns, as long as
  /// `options` or the node's request timeout say. Throws rr::Error (connection_error when there is
  /// no such client, or when it leaves meanwhile), or what the client has thrown.
  ///
  /// May be called anywhere, in a member that this very client has called too: while the member
  /// waits, the client's next requests are handled, so that its function may make calls itself.
  template <class R, class... Arguments>
  R rr_call_back(const Member& member, const CallOptions& options, std::uint32_t client,
                 const Arguments&... arguments) const {
    const CallOptionsScope scope(options);
    const void* const values[] = {&arguments..., nullptr};
    if constexpr (std::is_void_v<R>) {
      rr_ask_client(member, client, values, nullptr);
    } else {
      R result{};
      rr_ask_client(member, client, values, &result);
      return result;
    }
  }
  /// The same without waiting: see rr/async.hpp.
  template <class R, class Token, class... Arguments>
  requires AsyncHeaderIsIncluded<Token>
  auto rr_async_call_back(const Member& member, const CallOptions& options, Token&& token,
                          std::uint32_t client, const Arguments&... arguments) const;
  /// What rr_call_back() stands on.
  void rr_ask_client(const Member& member, std::uint32_t client, const void* const* arguments,
                     void* result) const;
  /// What rr_async_call_back() stands on.
  void rr_start_asking(const Member& member, std::uint32_t client, const void* const* arguments,
                       std::unique_ptr<Completion> completion) const;

 private:
  const std::shared_ptr<Places> rr_places_;
};

/// Makes what an objref gives an object of the asking client's own: every client that follows the
/// objref is given one for itself, so the function is called once for each of them.
///
///   std::shared_ptr<SessionSkeleton> get_session() override {
///     return rr::per_client(std::make_shared<MySession>(rr::ServiceContext::current_client()));
///   }
///
/// The path is the same for all clients, and none of them can tell (an extension; 08, S76).
/// Everything below the object is that client's own, too. Events go to the client alone; locks and
/// monitors of the object concern no other client. It is released when the client leaves, or by
/// ServiceContext::release_path().
template <class T>
std::shared_ptr<T> per_client(std::shared_ptr<T> object) {
  if (object) object->rr_set_per_client();
  return object;
}

}  // namespace rr
