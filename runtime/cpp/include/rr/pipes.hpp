// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "rr/definition.hpp"
#include "rr/function.hpp"
#include "rr/holding.hpp"
#include "rr/stub.hpp"
#include "rr/visibility.hpp"

/// Pipes: packets in order, in both directions (07, section 11). A pipe has any number of endpoints
/// for each client, told apart by an index.
namespace rr::service {
class PipePlace;
}  // namespace rr::service

namespace RR_VISIBLE rr {

class Skeleton;

/// What becomes of a packet for which a queue has no room.
enum class WhenFull : std::uint8_t {
  drop_oldest,  ///< the packet that has waited longest is lost, and counted
  drop_newest,  ///< the packet itself is lost, and counted
  close,        ///< the endpoint is closed: nothing is lost unnoticed
};

/// One end of a pipe endpoint, whatever its packets are. Copies are handles of the same end, which
/// stays connected until it is closed, its session ends or its object is released. Any thread may
/// use it. Packets that have arrived before can be received from a closed end too.
class PipeEnd {
 public:
  /// No end: not to be used.
  PipeEnd() = default;
  /// Disconnects. A client waits for the service's answer for at most half a second.
  void close();
  /// False once it is closed, by either side, or lost.
  [[nodiscard]] bool is_open() const;
  /// Number of the endpoint among those of its pipe and client.
  [[nodiscard]] std::int32_t index() const;
  /// True when both sides have agreed that packets may be lost or come in another order.
  [[nodiscard]] bool is_unreliable() const;
  /// On the service's side: number of the client's endpoint in this node. 0 on the client's side.
  [[nodiscard]] std::uint32_t client() const;
  /// Called once when either side has closed the end, on a thread of the node, behind the
  /// packets that a function gets.
  void on_closed(Function<void()> function);
  /// Packets that wait to be received.
  [[nodiscard]] std::size_t available() const;
  /// Waits until a packet is there. False when the time was over, or the end closed, before.
  [[nodiscard]] bool wait(std::chrono::milliseconds limit) const;
  /// At most so many packets wait to be received, and so many bytes of them as they have travelled,
  /// but always one (65,536, 64 MiB, close).
  void set_queue_limit(std::size_t packets, WhenFull when_full = WhenFull::close,
                       std::size_t bytes = std::size_t{64} * 1024 * 1024);
  /// Packets that were lost because the queue was full.
  [[nodiscard]] std::size_t lost_count() const;
  /// Whether packets are acknowledged; then on_acknowledged gets their numbers, and
  /// unacknowledged() says how many are still on their way. Off at first.
  void ask_for_acknowledgements(bool on = true);
  /// Called with the number of each packet that the other side has received, on a thread of the
  /// node.
  void on_acknowledged(Function<void(std::uint32_t)> function);
  /// Packets that are still on their way, while they are acknowledged.
  [[nodiscard]] std::size_t unacknowledged() const;
  /// Waits until at most so many bytes of the connection wait to be sent: what who sends more than
  /// the other side takes does before each packet. False when the time was over, or the end closed,
  /// before.
  [[nodiscard]] bool wait_sent(std::chrono::milliseconds limit,
                               std::size_t bytes = std::size_t{256} * 1024) const;

  /// For the runtime: what the handles of one end share.
  struct State;  // internal
  /// For the runtime: a handle of an end.
  explicit PipeEnd(std::shared_ptr<State> state) : state_(std::move(state)) {}

 protected:
  /// Takes the packet that has waited longest; null for none. Its value belongs to the caller.
  std::shared_ptr<void> take();
  /// The same without taking it.
  [[nodiscard]] std::shared_ptr<const void> peek() const;
  /// Sends a packet; returns its number. Throws rr::Error (invalid_operation when closed;
  /// read_only_member, write_only_member; buffer_limit_violation when the connection's send queue
  /// is full; data_type_error for what may not travel).
  std::uint32_t send(const void* value);
  /// While there is a function, packets go to it, in order, on a thread of the node, and none
  /// waits. The newest one counts.
  Subscription on_received(Function<void(std::shared_ptr<void>)> function);
  /// The completion gets the next packet; its result is a shared_ptr<void>. When its time-out or
  /// stop ends it, the packet stays for the next receive. Without a time-out it waits for ever.
  void start_receive(std::unique_ptr<Completion> completion);
  /// Throws rr::Error (invalid_operation).
  [[noreturn]] static void throw_no_packet();  // invalid_operation

  /// null for no end
  std::shared_ptr<State> state_;
};

/// An end of a pipe for packets of a T: the client's, or the service's for one client.
template <class T>
class PipeEndpoint : public PipeEnd {
 public:
  /// No end: not to be used.
  PipeEndpoint() = default;
  /// An end whose packets are of a T.
  explicit PipeEndpoint(PipeEnd end) : PipeEnd(std::move(end)) {}

  /// Returns the number of the packet: 1, 2, ...
  std::uint32_t send(const T& packet) { return PipeEnd::send(&packet); }
  /// Throws rr::Error (invalid_operation) when none waits.
  T receive() {
    auto packet = try_receive();
    if (!packet) throw_no_packet();
    return std::move(*packet);
  }
  /// The packet that has waited longest; nothing when none waits.
  [[nodiscard]] std::optional<T> try_receive() {
    const std::shared_ptr<void> packet = take();
    if (!packet) return std::nullopt;
    return std::move(*static_cast<T*>(packet.get()));
  }
  /// Waits for one. Nothing when the time was over, or the end closed, before.
  [[nodiscard]] std::optional<T> receive_for(std::chrono::milliseconds limit) {
    return wait(limit) ? try_receive() : std::nullopt;
  }
  /// The next packet, which stays.
  [[nodiscard]] std::optional<T> peek() const {
    const std::shared_ptr<const void> packet = PipeEnd::peek();
    if (!packet) return std::nullopt;
    return *static_cast<const T*>(packet.get());
  }
  /// Completes with the next packet, or fails with invalid_operation when the end is closed before
  /// one comes: void(std::exception_ptr, T). What `options` end leaves the packet for the next
  /// receive; without a time-out it waits for ever. Defined in rr/async.hpp.
  template <class Token>
  auto async_receive(const CallOptions& options, Token&& token);
  /// As above, without a time-out.
  template <class Token>
  auto async_receive(Token&& token) {
    return async_receive(CallOptions(), std::forward<Token>(token));
  }
  /// Calls `function(T)` for packets, those that wait first, instead of keeping them.
  template <class Function>
  Subscription on_packet(Function function) {  // NOLINTNEXTLINE(performance-*): given away
    return on_received([function = std::move(function)](std::shared_ptr<void> packet) mutable {
      function(std::move(*static_cast<T*>(packet.get())));
    });
  }
};

/// How an endpoint is connected.
struct PipeOptions {
  std::int32_t index = -1;  ///< wanted; the service decides, and -1 leaves it to it
  bool unreliable = true;   ///< asked for if the pipe is declared so
};

/// A pipe of an object on another node, without its type.
class PipeMember {
 protected:
  /// A pipe of an object.
  PipeMember(Stub& stub, const Member& member, const Holding& holding)
      : stub_(&stub), member_(&member), holding_(&holding) {}
  /// What Pipe::connect() stands on.
  PipeEnd connect_end(const PipeOptions& options);
  /// The completion's result is a PipeEnd.
  void start_connect(const PipeOptions& options, std::unique_ptr<Completion> completion);
  /// Finds out whether a lock of the object keeps this client out, without an endpoint that the
  /// service would see come and go: the completion fails with object_locked_error then, and with
  /// any other error, or not at all, when none does. It has no result.
  void start_lock_check(std::unique_ptr<Completion> completion);

  /// the object
  Stub* stub_;
  /// the pipe in its definition
  const Member* member_;
  /// how packets are kept
  const Holding* holding_;
};

/// A pipe of an object on another node: `stub->frames()`.
template <class T>
class Pipe : public PipeMember {
 public:
  /// For generated code: a pipe of an object.
  Pipe(Stub& stub, const Member& member) : PipeMember(stub, member, holding_of<T>) {}

  /// Packets that the service sends before it answers are kept. Throws rr::Error.
  PipeEndpoint<T> connect(const PipeOptions& wishes = {}, const CallOptions& options = {}) {
    const CallOptionsScope scope(options);
    return PipeEndpoint<T>(connect_end(wishes));
  }
  /// The same without wishes.
  PipeEndpoint<T> connect(const CallOptions& options) { return connect(PipeOptions(), options); }
  /// void(std::exception_ptr, PipeEndpoint<T>). Defined in rr/async.hpp.
  template <class Token>
  auto async_connect(const PipeOptions& wishes, const CallOptions& options, Token&& token);
  /// As above, with the client's time-out.
  template <class Token>
  auto async_connect(const PipeOptions& wishes, Token&& token) {
    return async_connect(wishes, CallOptions(), std::forward<Token>(token));
  }
  /// As above, without wishes.
  template <class Token>
  auto async_connect(const CallOptions& options, Token&& token) {
    return async_connect(PipeOptions(), options, std::forward<Token>(token));
  }
  /// As above, without wishes, with the client's time-out.
  template <class Token>
  auto async_connect(Token&& token) {
    return async_connect(CallOptions(), std::forward<Token>(token));
  }
};

/// A pipe that an object offers, without its type. What is set up here is kept by the object.
class PipeServerBase {
 public:
  /// How many endpoints of all clients are connected.
  [[nodiscard]] std::size_t endpoint_count() const;
  /// PipeEnd::wait_sent for all endpoints, in the same time together. True when none keeps it
  /// waiting, closed ones included.
  [[nodiscard]] bool wait_sent(std::chrono::milliseconds limit,
                               std::size_t bytes = std::size_t{256} * 1024) const;
  /// For send_all: endpoints with more unacknowledged packets are passed over. 0: packets are not
  /// acknowledged and no endpoint is passed over (the default); see PipeEnd for single endpoints.
  void set_backlog_limit(std::size_t packets) const;

 protected:
  /// A pipe of an object that a service offers.
  PipeServerBase(const Skeleton& skeleton, const Member& member);
  /// What PipeServer::send() stands on.
  void send_all(const void* value) const;
  /// All connected endpoints.
  [[nodiscard]] std::vector<PipeEnd> ends() const;
  /// What PipeServer::on_connect() stands on.
  void set_connected(Function<void(PipeEnd)> function) const;

  /// the endpoints of the pipe
  std::shared_ptr<service::PipePlace> place_;
  /// the pipe in its definition
  const Member* member_;
};

/// A pipe that an object offers: `frames()` of its skeleton.
template <class T>
class PipeServer : public PipeServerBase {
 public:
  /// For generated code: a pipe of an object that a service offers.
  PipeServer(const Skeleton& skeleton, const Member& member) : PipeServerBase(skeleton, member) {}

  /// Sends a packet to all endpoints of all clients, encoded once for each message version. An
  /// endpoint whose connection does not take it any more is closed.
  void send(const T& packet) const { send_all(&packet); }
  /// All connected endpoints.
  [[nodiscard]] std::vector<PipeEndpoint<T>> endpoints() const {
    std::vector<PipeEndpoint<T>> result;
    for (PipeEnd& end : ends()) result.emplace_back(std::move(end));
    return result;
  }
  /// Calls `function(PipeEndpoint<T>)` for each endpoint that is connected, before its answer is
  /// sent.
  template <class Function>
  void on_connect(Function function) const {
    set_connected([function = std::move(function)](PipeEnd end) {
      function(PipeEndpoint<T>(std::move(end)));
    });
  }
};

}  // namespace rr
