// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <string>

#include "rr/mutex.hpp"
#include "rr/options.hpp"
#include "runtime/cpp/src/channel/capabilities.hpp"
#include "runtime/cpp/src/channel/connection.hpp"
#include "runtime/cpp/src/channel/connection_tap.hpp"
#include "runtime/cpp/src/channel/flusher.hpp"
#include "runtime/cpp/src/channel/inbox.hpp"
#include "runtime/cpp/src/channel/keep_alive.hpp"
#include "runtime/cpp/src/channel/link_terms.hpp"
#include "runtime/cpp/src/channel/member_timer.hpp"
#include "runtime/cpp/src/channel/message_deadline.hpp"
#include "runtime/cpp/src/channel/metrics.hpp"
#include "runtime/cpp/src/channel/own_requests.hpp"
#include "runtime/cpp/src/channel/peer_layers.hpp"
#include "runtime/cpp/src/channel/reactor.hpp"
#include "runtime/cpp/src/channel/read_lease.hpp"
#include "runtime/cpp/src/channel/receive_pace.hpp"
#include "runtime/cpp/src/channel/scratch.hpp"
#include "runtime/cpp/src/channel/send_queue.hpp"
#include "runtime/cpp/src/channel/socket.hpp"
#include "runtime/cpp/src/channel/socket_watch.hpp"
#include "runtime/cpp/src/channel/strand.hpp"

namespace rr::channel {

template <class Connection>
struct CallerSteps;

/// A connection over a stream socket, composed of parts, each with its own contract:
///
/// - ReadLease: who may receive; user code never runs with it.
/// - Strand: who hands messages to the receiver, which may run user code for long. What is read
///   meanwhile is queued. A handler that waits for what a later message brings steps out. Callbacks
///   are handled beside the strand: whoever has it may wait for a call that the callback is part
///   of.
/// - SendQueue: what leaves, and what waits for room.
/// - SocketWatch: whether the reactor looks for input.
/// - KeepAlive: when a heartbeat is due, and when the other side counts as gone.
/// - PeerLayers: TLS and web sockets, and who the other side is.
///
/// Lease, strand and watch share one lock, `mutex_`, because most events change two of them. It is
/// never held while user code runs or the network is waited for. The send queue has its own.
///
/// A server's connection is paused, which is not read by anybody, while too many requests wait for
/// their handlers, while too many answers wait to be sent, or while its account has no room for
/// more of a message. What waits is charged to the account; a message that is handled where it was
/// received, and answered at once, never touches it.
///
/// Large because it implements the thirty functions of Connection, and every function beside them
/// joins two or more parts, most of them under the lock that these share.
class StreamConnection final : public Connection,
                               public Pollable,
                               public Flushable,
                               public Metered,
                               public std::enable_shared_from_this<StreamConnection> {
 public:
  enum class Role : std::uint8_t { client, server };

  StreamConnection(Role role, Descriptor socket, std::shared_ptr<Reactor> reactor,
                   const std::shared_ptr<const NodeOptions>& options);
  /// The same of another channel than TCP, or with a carrier; null for none.
  StreamConnection(Role role, Descriptor socket, std::shared_ptr<Reactor> reactor,
                   std::shared_ptr<const NodeOptions> options, LinkTerms terms,
                   std::unique_ptr<Carrier> carrier);
  ~StreamConnection() override;

  /// Before start(): who the other side is and what was agreed with it.
  void set_agreement(const NodeId& remote_node, std::string remote_name,
                     const Agreement& agreement);
  /// Before set_agreement(): the messages that did it, for the tap of the node.
  void tell_handshake(std::span<const std::byte> request, std::span<const std::byte> answer) const;
  /// Before start(): what the other side has proved to be.
  void set_certified_node(const NodeId& node) { layers_.set_certified_node(node); }
  /// Before start(): called once when the connection has ended, on any thread.
  void set_on_gone(std::function<void(StreamConnection&)> on_gone) {
    on_gone_ = std::move(on_gone);
  }
  /// From the function of set_on_gone().
  [[nodiscard]] const Error& why_closed() const { return *why_closed_; }
  /// Messages go to `receiver` from now on; the reactor watches the socket.
  void start(std::shared_ptr<Receiver> receiver);

  [[nodiscard]] std::string local_url() const override;
  [[nodiscard]] std::string remote_address() const override { return remote_address_; }
  [[nodiscard]] NodeId certified_node() const override { return layers_.certified_node(); }
  [[nodiscard]] ChannelTraits traits() const override;
  void check_size(const Writer& message) const override;
  using Connection::reply;
  using Connection::send;
  void send(Writer& message, Time now, Priority priority) override;
  void send_call(Writer& message, Time now, Priority priority) override;
  void send_newest(Writer& message, const Newest& newest, Time now) override;
  void stream(Writer& message) override;
  bool wait_sent(std::size_t bytes, Time deadline) override;
  [[nodiscard]] bool has_sent(std::size_t bytes) const override;
  void reply(Writer& message, Priority priority) override;
  [[nodiscard]] bool shares_slots() const override;
  [[nodiscard]] bool pass_memory(const platform::Descriptor& handle) override;
  std::shared_ptr<SlotReader> take_slots(std::uint64_t id,
                                         std::optional<std::uint32_t> holds) override;
  std::shared_ptr<PipeRingReader> take_ring(const PipeRingStart& start) override;
  std::shared_ptr<ServedHolds> draw_holds() override;
  void claim(Waiter& waiter) override;
  void wait(Waiter& waiter, Time deadline, Time now) override;
  void resign(Waiter& waiter) override;
  void finish(Waiter& waiter) override;
  void finish_answered(Waiter& waiter) override;
  void expect() override;
  void nudge() override;
  bool step_out() override;
  bool step_in(Time deadline) override;
  void await_strand() override;
  bool suspend() override;
  void resume() override;
  void close(const Error& why) override;
  void close_after(Milliseconds delay) override;
  [[nodiscard]] bool is_closed() const override {
    return is_closing_.load(std::memory_order_relaxed);
  }

  void on_ready(std::uint32_t events) override;
  void on_stuck() override { flush(); }
  [[nodiscard]] std::shared_ptr<ThreadShare> thread_share() const override { return threads_; }
  void flush_streamed() override { flush(); }
  [[nodiscard]] ConnectionSample sample() const override;

 private:
  using Sync = Synchronization;
  friend struct CallerSteps<StreamConnection>;

  enum class Received { some, nothing, end };

  // Sending (stream_sending.cpp)
  void send(Writer& message, const SendQueue::How& how);
  void send_or_queue(Writer& message, const SendQueue::How& how);
  void stream_or_queue(Writer& message);
  [[nodiscard]] bool has_strings() const;
  [[nodiscard]] std::vector<std::byte> with_strings(Writer& message) const;
  [[noreturn]] void fail_sending();
  void fail_later();
  void flush();
  void watch_for_room();
  void send_own(Writer& message);  // of the connection itself; failures are ignored

  // Reading (stream_reading.cpp)
  void note_bell(SharedCarrier& shared, bool is_end);
  Received receive(Scratch& scratch, bool may_block, bool& is_full);
  Received receive_once(Scratch& scratch, bool may_block, bool& is_full);
  Received take_bytes(Scratch& scratch, std::size_t received);
  Received fail_reading(const Error& why);
  bool take(Scratch& scratch, Frame& frame);
  bool take_packet(Scratch& scratch, const Frame& frame);
  void take_answers(const Message& message, const Entry& first, const MemoryRef& owner,
                    DeferredCallbacks& deferred);
  void answer_own(const Message& message, const Entry& entry, std::span<const std::byte> bytes);
  void send_test();
  void refuse_stream(const Scratch& scratch, std::size_t size);
  bool take_read_lease(bool until_end = false);
  void read_as_reactor(bool until_end);
  [[nodiscard]] bool is_drained_first() const RR_REQUIRES(mutex_);
  bool give_way_to_others(std::size_t bytes) const;
  void note_received();
  [[nodiscard]] bool is_beside_others() const;
  void read_soon(bool until_end);
  bool leave_read_lease(Scratch& scratch, bool may_dispatch);

  // What is carried otherwise than as plain bytes of the socket (stream_carried.cpp)
  Received receive_carried(Scratch& scratch, bool may_block, bool& is_full);
  Received receive_messages(Scratch& scratch, bool may_block);
  Received receive_bytes(Scratch& scratch, bool may_block, bool& is_full);
  Received upgrade(Scratch& scratch, std::size_t size, std::unique_ptr<Layer> layer);
  Received begin_tls();
  [[nodiscard]] bool may_share() const;
  std::unique_ptr<SharedCarrier> make_shared_carrier(Descriptor& handle);
  void share_memory(Writer& answer, const Descriptor& handle,
                    std::unique_ptr<SharedCarrier> carrier);
  Received begin_sharing();
  void note_peer();

  // Handing on messages (stream_dispatch.cpp)
  bool hand_on(Scratch& scratch, bool may_dispatch, bool& must_post) RR_REQUIRES(mutex_);
  void run_deferred(DeferredCallbacks& deferred, Handling admission);
  void handle_in_turn(StrandTurn& turn, Handling admission, bool& is_again);
  bool dispatch(StrandTurn& turn);
  void queue_rest(StrandTurn& turn);
  bool drain(StrandTurn& turn);
  void drain_soon();
  void drain_posted();
  void note_pace(const StrandTurn& turn);
  [[nodiscard]] bool must_yield(StrandTurn& turn) const;
  bool is_suspended(StrandTurn& turn, Frame frame);
  bool must_read_on() RR_REQUIRES(mutex_);
  [[nodiscard]] std::chrono::microseconds longest_turn_here() const;
  [[nodiscard]] bool may_go_outside() const RR_REQUIRES(mutex_);
  bool begin_beside();
  void handle_beside(Frame frame);
  void end_beside();
  [[nodiscard]] std::shared_ptr<ThreadShare> callback_share();
  void handle_frame(Scratch& scratch, const Frame& frame, bool is_parsed, StrandTurn* turn);
  void complete(Message& message) const;

  // When a server does not read on, nor hands on (stream_pausing.cpp)
  [[nodiscard]] bool is_paused() const RR_REQUIRES(mutex_);
  [[nodiscard]] bool may_callers_read() const RR_REQUIRES(mutex_);
  [[nodiscard]] bool is_overdrawn() const RR_REQUIRES(mutex_);
  [[nodiscard]] bool is_departed() const;
  std::span<std::byte> room(Scratch& scratch);
  Received wait_for_memory();
  void note_assembly();
  void schedule_look(Time when) RR_REQUIRES(mutex_);
  void look_at_message();
  void read_late(Time asked);
  // True when requests have to wait until the other side has taken answers; go_on() comes then.
  bool answers_wait() {
    return sending_.has_many_answers() ? look_at_answers() : sending_.do_answers_wait();
  }
  bool look_at_answers();
  void go_on();

  // Callers (stream_callers.cpp)
  void begin_lead(Waiter& waiter) RR_REQUIRES(mutex_);
  bool lead(Waiter& waiter, Time deadline, Time now);
  bool may_lead_on();
  bool may_block_until(Time deadline);
  void leave_to_reactor(Scratch& scratch);
  void wait_until_handled(const Waiter& waiter, Time deadline);
  static void about_to_wait() { Reactor::about_to_wait(); }

  // When the reactor watches, and threads of it that are pinned here (stream_watching.cpp)
  void watch_input() RR_REQUIRES(mutex_);
  [[nodiscard]] bool has_unread() RR_REQUIRES(mutex_);
  void ring_or_read() RR_REQUIRES(mutex_);
  void end_call() RR_REQUIRES(mutex_);
  void schedule_watch_timer() RR_REQUIRES(mutex_);
  void look_at_watch();
  void limit_receive_time();
  void acknowledge_late();
  void read_pinned(Scratch& scratch);
  bool begin_pinned(std::uint32_t& uses);
  bool go_on_pinned(Received received, std::uint32_t& uses);
  std::uint32_t pin() RR_REQUIRES(mutex_);

  // Life (stream_connection.cpp)
  void look_after();
  void begin_close(const Error& why) RR_REQUIRES(mutex_);
  void end_if_lost() RR_REQUIRES(mutex_);
  static Error no_memory(std::string_view why = "no memory");
  void finish_close();
  [[nodiscard]] Limits limits() const;
  [[nodiscard]] std::uint32_t largest_message() const;

  // For the functions of the lease that say that they need no lock.
  [[nodiscard]] ReadLease& lease() RR_NO_THREAD_SAFETY_ANALYSIS { return lease_; }
  // Whose turn a thread has: this is about its address alone.
  [[nodiscard]] const Strand& strand() const RR_NO_THREAD_SAFETY_ANALYSIS { return strand_; }

  // A receive returns after this time to look at the deadline, or to give the thread back to the
  // reactor; set once per socket, which is cheaper than waiting with poll() each time.
  static constexpr Milliseconds receive_pause{100};

  const Role role_;
  const Descriptor socket_;
  const std::shared_ptr<Reactor> reactor_;
  const std::shared_ptr<const NodeOptions> options_;
  const LinkTerms terms_;
  const std::uint32_t largest_size_;  // of a message
  const std::string remote_address_;
  ConnectionTap tap_;
  std::shared_ptr<Receiver> receiver_;
  std::function<void(StreamConnection&)> on_gone_;
  std::atomic<bool> has_local_strings_{false};
  std::atomic<bool> has_standard_strings_{false};
  SendQueue sending_;
  PeerLayers layers_;

  // Never held while user code runs or the network is waited for.
  Mutex mutex_;
  ReadLease lease_ RR_GUARDED_BY(mutex_);
  Strand strand_ RR_GUARDED_BY(mutex_);
  std::shared_ptr<StreamConnection> self_ RR_GUARDED_BY(mutex_);  // while the reactor may name this
  std::shared_ptr<ThreadShare> callback_threads_
      RR_GUARDED_BY(mutex_);                       // of a client, from its first callback on
  bool is_refused_ RR_GUARDED_BY(mutex_) = false;  // not read on, for want of memory
  Time look_due_ RR_GUARDED_BY(mutex_) = never;    // of look_timer_
  std::unique_ptr<const Error> why_closed_;
  std::atomic<bool> is_closing_{false};  // written under mutex_

  // With the read lease.
  Inbox inbox_;
  Time refused_since_ = never;
  bool had_message_ = false;
  bool has_receive_timeout_ = false;
  ReceivePace pace_;
  Tally messages_received_;
  Tally bytes_received_;

  bool holds_back_answers_ = false;  // with the strand

  MessageDeadline message_deadline_;
  KeepAlive keep_alive_;
  std::atomic<bool> is_end_in_sight_{false};  // the reactor has been told of it, once
  MemberTimer<StreamConnection, &StreamConnection::look_after> life_timer_{*this};
  MemberTimer<StreamConnection, &StreamConnection::look_at_watch> watch_timer_{*this};
  MemberTimer<StreamConnection, &StreamConnection::look_at_message> look_timer_{*this};
  SocketWatch watch_ RR_GUARDED_BY(mutex_);
  const Meter meter_;  // the last one: until it goes, this is asked for what it has counted
};

}  // namespace rr::channel
