// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <exception>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "rr/mutex.hpp"
#include "rr/pipes.hpp"
#include "rr/writer.hpp"
#include "runtime/cpp/src/channel/connection.hpp"
#include "runtime/cpp/src/endpoint/core.hpp"
#include "runtime/cpp/src/endpoint/missed_packets.hpp"
#include "runtime/cpp/src/endpoint/received_packets.hpp"
#include "runtime/cpp/src/endpoint/ring_terms.hpp"
#include "runtime/cpp/src/endpoint/subscription.hpp"
#include "runtime/cpp/src/endpoint/user_code.hpp"

namespace rr {

namespace endpoint {

/// The side of a session that a pipe endpoint belongs to, client or service.
class PipeSide {
 public:
  virtual ~PipeSide() = default;
  [[nodiscard]] virtual channel::Connection& connection() const = 0;
  /// Sends a message of one entry, whose elements are in the writer, by Connection::stream().
  /// Throws rr::Error, then nothing was sent. May be called under a lock.
  virtual void stream(Writer& writer, const EntryHeader& header, std::string_view metadata) = 0;
  /// Ends an endpoint and tells the other side; waits for its answer if there is one and
  /// `may_wait`.
  virtual void close(PipeEnd::State& end, bool may_wait) = 0;
};

}  // namespace endpoint

/// What the handles of one end share.
///
/// Large because packets are sent under one lock and received under another one, the end of an end
/// is under both, and a third of its functions is what the handles call.
struct PipeEnd::State : std::enable_shared_from_this<State> {
 public:
  /// What does not change.
  struct Identity {
    std::string path;
    const Member* member = nullptr;  // definitions that were read go with their session
    const Holding* holding = nullptr;
    std::int32_t index = 0;
    bool is_unreliable = false;
    bool is_client = false;
    // On the service's side: the client's endpoint and node.
    std::uint32_t client = 0;
    NodeId node{};
  };
  State(std::shared_ptr<const endpoint::Core> core, std::shared_ptr<endpoint::PipeSide> side,
        Identity identity);
  virtual ~State() = default;

  static const std::shared_ptr<State>& of(const PipeEnd& end) { return end.state_; }

  const Identity identity;
  /// Whether the other side may send packets; if not, they are only acknowledged.
  [[nodiscard]] bool may_receive() const;

  // Sending (pipe_end.cpp)
  std::uint32_t send(const void* value);
  /// The same for an element `packet` that is written once for all ends.
  class Written;
  std::uint32_t send_written(Written& packet);
  void take_acknowledgement(std::uint32_t number);
  [[nodiscard]] std::size_t unacknowledged() const;
  bool wait_sent(std::chrono::milliseconds limit, std::size_t bytes) const;
  /// The same without waiting.
  [[nodiscard]] bool has_sent(std::size_t bytes) const;
  void ask_for_acknowledgements(bool on);
  void on_acknowledged(Function<void(std::uint32_t)> function);
  /// For the metrics of the node: a packet was not sent, because the other side takes too few.
  void count_dropped() const;

  // Rings, on the service's side (pipe_end.cpp). A packet that is sent to all is put into the
  // ring of the pipe once, for those that are in it; see service/ring_readers.hpp.
  /// Runs `join`, which puts the end into a ring, while nothing is sent by it. Nothing when that
  /// cannot be; else the number that the next packet of the ring has for the client.
  std::optional<std::uint32_t> enter_ring(const std::function<bool()>& join);
  /// It has been taken out of the ring, or is to be: sends what the client has not read there.
  /// Throws as send(); what could not be sent is then tried again before the next packet.
  void send_missed();
  /// Notifies the client of packets in the ring, or that it is in none any more.
  void notify_of_ring();
  /// Whether a packet was sent to this client alone while it was in a ring.
  [[nodiscard]] bool is_sent_to_alone() const { return is_sent_to_alone_; }
  /// Whether packets are to be acknowledged.
  [[nodiscard]] bool asks_for_acknowledgements() const { return asks_; }

  // Receiving (pipe_state.cpp)
  /// Takes a packet that has arrived: `size` bytes of a message, and `memory` bytes of containers.
  /// Runs no user code: deliver() does. False when the end must be closed, because a queue is full
  /// or the other side makes this one hold too much.
  [[nodiscard]] bool accept(std::uint32_t number, std::shared_ptr<void> value, std::size_t size,
                            std::size_t memory = 0);
  /// Packets are taken in the order of their numbers from now on, unreliable or not.
  void use_numbers();
  /// Whether a packet of this number is not too early: all before it have come.
  [[nodiscard]] bool has_come_up_to(std::uint32_t number) const;
  /// Whether the program waits for packets, and does not only ask now and then.
  [[nodiscard]] bool is_listening() const;
  /// Hands packets to who waits for them, in order. On a thread of the node.
  void deliver();
  void deliver_soon();
  std::shared_ptr<void> take();
  std::shared_ptr<const void> peek();
  bool wait(std::chrono::milliseconds limit);
  [[nodiscard]] std::size_t available();
  [[nodiscard]] std::size_t lost_count() const;
  void set_queue_limit(std::size_t packets, WhenFull when_full, std::size_t bytes);
  Subscription on_received(Function<void(std::shared_ptr<void>)> function);
  /// The time-out and stop of the thread's call options end it without having taken a packet.
  void start_receive(std::unique_ptr<Completion> completion);

  // The end
  [[nodiscard]] bool is_open() const { return !is_closed_.load(std::memory_order_acquire); }
  void on_closed(Function<void()> function);
  /// Ends it on this side only. False when it has ended already.
  bool finish();
  /// The side, while it is open.
  [[nodiscard]] std::shared_ptr<endpoint::PipeSide> side() const;

 protected:
  /// Takes the end out of the ring, if it is there still, and takes what the client has not read.
  /// Once. Under the lock of sending.
  virtual endpoint::MissedPackets take_missed() { return {}; }
  /// Packets may be in memory, without a message about them.
  virtual void look() {}
  /// The same, and the program waits for more.
  virtual void listen() {}
  [[nodiscard]] const std::shared_ptr<const endpoint::Core>& core() const { return core_; }

 private:
  class Receiver;
  class Waiting;

  template <class Write>
  std::uint32_t send_packet(const Write& write_value);
  template <class Write>
  void send_numbered(Writer& writer, endpoint::PipeSide& side, bool asks, const Write& write_value)
      RR_REQUIRES(sending_);
  void leave_ring(endpoint::PipeSide& side) RR_REQUIRES(sending_);
  void send_notice(endpoint::PipeSide& side) const;
  bool deliver_one() RR_REQUIRES(mutex_);
  void complete(std::shared_ptr<Waiting> waiting, std::shared_ptr<void> value) const;
  void hand_to(std::shared_ptr<Receiver> receiver, std::shared_ptr<void> value) const;
  void tell_closed(std::shared_ptr<Receiver> receiver, Function<void()> function) const;
  void end_receive(Waiting& waiting, ErrorCode code);
  void fail_receive(const std::shared_ptr<Waiting>& waiting);
  /// Runs what is the program's; what it throws is logged.
  template <class Run>
  void call(const Run& run) const {
    endpoint::call_user_code(*core_, "a function of the pipe", name_, run);
  }

  // It is written with both locks, so either is enough to read it.
  [[nodiscard]] endpoint::PipeSide* side_while_sending() const
      RR_REQUIRES(sending_) RR_NO_THREAD_SAFETY_ANALYSIS {
    return side_.get();
  }

  const std::shared_ptr<const endpoint::Core> core_;
  const std::string index_text_;
  const std::string name_;     // of the member, which may be gone after the end
  const std::uint8_t access_;  // the same
  const std::shared_ptr<channel::ThreadShare> threads_;  // of the session
  std::atomic<bool> is_closed_{false};                   // written under both locks

  Mutex sending_ RR_ACQUIRED_BEFORE(mutex_);
  std::shared_ptr<endpoint::PipeSide> side_
      RR_GUARDED_BY(mutex_);  // null when closed; see side_while_sending()
  std::uint32_t next_number_ RR_GUARDED_BY(sending_) = 1;
  std::atomic<bool> asks_{false};
  std::atomic<bool> has_ring_{false};  // or has still to send what was missed; under sending_
  std::atomic<bool> is_sent_to_alone_{false};
  std::optional<endpoint::MissedPackets> missed_ RR_GUARDED_BY(sending_);
  std::atomic<std::uint64_t> asked_{0};
  std::atomic<std::uint64_t> acknowledged_{0};

  mutable Mutex mutex_;
  mutable Condition arrived_;
  std::size_t waiting_ RR_GUARDED_BY(mutex_) = 0;  // threads in wait()
  bool has_numbers_ RR_GUARDED_BY(mutex_);         // packets have an order
  endpoint::ReceivedPackets packets_ RR_GUARDED_BY(mutex_);
  bool is_delivering_ RR_GUARDED_BY(mutex_) = false;
  std::shared_ptr<Receiver> receiver_ RR_GUARDED_BY(mutex_);
  std::deque<std::shared_ptr<Waiting>> waitings_
      RR_GUARDED_BY(mutex_);  // for packets, in their order
  Function<void()> closed_function_ RR_GUARDED_BY(mutex_);
  Function<void(std::uint32_t)> acknowledged_function_ RR_GUARDED_BY(mutex_);
};

/// A packet in the form of each message format.
class PipeEnd::State::Written {
 public:
  struct Form {
    std::span<const std::byte> bytes;
    MemoryRef owner;
  };
  /// Stays as it is until the packet is gone. Called under the lock of an end.
  virtual const Form& in(MessageVersion version) = 0;

 protected:
  ~Written() = default;
};

}  // namespace rr
