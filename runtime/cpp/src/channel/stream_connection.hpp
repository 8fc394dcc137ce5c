// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <atomic>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "rr/options.hpp"
#include "rr/tap.hpp"
#include "runtime/cpp/src/channel/capabilities.hpp"
#include "runtime/cpp/src/channel/carrier.hpp"
#include "runtime/cpp/src/channel/connection.hpp"
#include "runtime/cpp/src/channel/flusher.hpp"
#include "runtime/cpp/src/channel/inbox.hpp"
#include "runtime/cpp/src/channel/layered_carrier.hpp"
#include "runtime/cpp/src/channel/link_terms.hpp"
#include "runtime/cpp/src/channel/outbox.hpp"
#include "runtime/cpp/src/channel/reactor.hpp"
#include "runtime/cpp/src/channel/scratch.hpp"
#include "runtime/cpp/src/channel/socket.hpp"

namespace rr::channel {

/// A connection over a stream socket.
///
/// Two turns, each taken by one thread at a time, order what happens to it. Who has the read turn
/// may receive; user code never runs with it. Who has the dispatch turn hands messages to the
/// receiver, which may run user code for long; what is read meanwhile waits in a queue. A thread
/// that waits in there for what a later message brings gives the turn up for as long. A callback
/// is handled without it: whoever has the turn may be waiting for a call that the callback is a
/// part of.
///
/// Callers of several threads share a connection: one of them reads, the others follow, which is to
/// sleep until they are answered or made the reader. Those whose answers came together are woken
/// together, and what they ask next leaves together. Who has read leaves the turn free when it has
/// woken others, as it will mostly be back first; if not, the first of those looks for a reader.
///
/// While a caller reads, the reactor does not watch the socket: it would be woken by every answer.
/// Calls in a tight loop find the socket unwatched ("parked") and leave it so; a timer of a
/// millisecond puts it back under watch when calls have ceased.
///
/// In the same way a thread of the reactor stays with a connection that brings one message after
/// the other while no caller reads, and waits for the next one in a receive that blocks. A timer
/// puts the socket back under watch when a handler takes long.
///
/// A server's connection is paused, which is not read by anybody, while too many requests wait for
/// their handlers, while too many answers wait to be sent, or while its account has no room for
/// more of a message. What waits is charged to the account; a message that is handled where it was
/// received, and answered at once, never touches it.
class StreamConnection final : public Connection,
                               public Pollable,
                               public Flushable,
                               public std::enable_shared_from_this<StreamConnection> {
 public:
  enum class Role : std::uint8_t { client, server };

  StreamConnection(Role role, Descriptor socket, std::shared_ptr<Reactor> reactor,
                   std::shared_ptr<const NodeOptions> options);
  /// The same of another channel than TCP, or with a carrier; null for none.
  StreamConnection(Role role, Descriptor socket, std::shared_ptr<Reactor> reactor,
                   std::shared_ptr<const NodeOptions> options, LinkTerms terms,
                   std::unique_ptr<Carrier> carrier);
  ~StreamConnection();

  /// Before start(): who the other side is and what was agreed with it.
  void set_agreement(const NodeId& remote_node, std::string remote_name,
                     const Agreement& agreement);
  /// Before set_agreement(): the messages that did it, when the node has a tap.
  void tell_handshake(std::span<const std::byte> request, std::span<const std::byte> answer);
  /// Before start(): what the other side has proved to be.
  void set_certified_node(const NodeId& node) {
    certified_node_ = node;
    is_proven_.store(!node.is_any(), std::memory_order_release);
  }
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
  [[nodiscard]] NodeId certified_node() const override {
    return is_proven_.load(std::memory_order_acquire) ? certified_node_ : NodeId();
  }
  [[nodiscard]] ChannelTraits traits() const override;
  void check_size(const Writer& message) const override;
  using Connection::reply;
  using Connection::send;
  void send(Writer& message, Time now, Priority priority) override;
  void send_call(Writer& message, Time now, Priority priority) override;
  void send_newest(Writer& message, const Newest& newest, Time now) override;
  void stream(Writer& message) override;
  bool wait_sent(std::size_t bytes, Time deadline) override;
  void reply(Writer& message, Priority priority) override;
  void claim(Waiter& waiter) override;
  void wait(Waiter& waiter, Time deadline, Time now) override;
  void resign(Waiter& waiter) override;
  void finish(Waiter& waiter) override;
  void finish_answered(Waiter& waiter) override;
  void expect() override;
  void nudge() override;
  bool give_up_turn() override;
  bool take_turn_again(Time deadline) override;
  void await_turn() override;
  bool put_off() override;
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

 private:
  enum class Received { some, nothing, end };
  enum class Watch : std::uint8_t { off, full, parked };
  class Turn;
  struct Returning;
  static thread_local Turn* current_turn;

  class LifeTimer final : public Timer {
   public:
    explicit LifeTimer(StreamConnection& connection) : connection_(connection) {}
    void on_timer() override { connection_.look_after(); }

   private:
    StreamConnection& connection_;
  };
  class ParkTimer final : public Timer {
   public:
    explicit ParkTimer(StreamConnection& connection) : connection_(connection) {}
    void on_timer() override { connection_.unpark(); }

   private:
    StreamConnection& connection_;
  };

  class LookTimer final : public Timer {
   public:
    explicit LookTimer(StreamConnection& connection) : connection_(connection) {}
    void on_timer() override { connection_.look_at_message(); }

   private:
    StreamConnection& connection_;
  };

  // Sending (stream_sending.cpp, stream_streaming.cpp)
  // What is known of a message that is to be sent.
  struct Sending {
    Time now;
    Priority priority = Priority::usual;
    const Newest* newest = nullptr;
    ErrorCode refusal = ErrorCode::out_of_system_resource;  // when it may not wait
    bool is_reply = false;
  };
  void send(Writer& message, const Sending& how);
  void send_or_queue(Writer& message, const Sending& how);
  [[nodiscard]] bool has_strings() const;
  [[nodiscard]] std::vector<std::byte> with_strings(Writer& message) const;
  bool send_under_lock(Writer& message, const Sending& how, bool& has_rest);
  void queue_rest(Writer& message, std::size_t sent, const Sending& how,
                  std::optional<std::uint64_t> told);
  bool add_to_stream(Writer& message, bool& is_first);
  void gather(Writer& message);
  void stream_or_queue(Writer& message);
  void take_streamed();
  void move_streamed();
  void note_waiting();
  [[nodiscard]] std::size_t waiting_bytes() const;
  [[noreturn]] void fail_sending();
  void fail_later();
  void flush();
  void watch_for_room();
  [[nodiscard]] bool admit(std::size_t size, ErrorCode refusal);
  void settle();
  void drop_unsent();
  void send_own(Writer& message);  // of the connection itself; failures are ignored

  // The tap (stream_tap.cpp): all of it only with one.
  void open_tap();
  std::uint64_t tell_tap(bool is_own, std::span<const Piece> message) const;
  std::uint64_t take_streamed_and_tell(Writer& message);
  void queue_newest_and_tell(Writer& message, const Newest& newest);

  // Reading (stream_reading.cpp)
  Received receive(Scratch& scratch, bool may_block, bool& is_full);
  Received receive_once(Scratch& scratch, bool may_block, bool& is_full);
  Received take_bytes(Scratch& scratch, std::size_t received);
  Received fail_reading(const Error& why);
  bool take(Scratch& scratch, Frame& frame);
  bool take_packet(Scratch& scratch, const Frame& frame);
  void take_answers(const Message& message, const Entry& first, const MemoryRef& owner,
                    DeferredCallbacks& deferred);
  void refuse_stream(const Scratch& scratch, std::size_t size);
  bool take_read_turn(bool until_end = false);
  void read_as_reactor(bool until_end);
  [[nodiscard]] bool is_drained_first() const;
  bool fasten_turn();
  [[nodiscard]] bool takes_long() const;
  void note_read(bool was_long);
  void read_soon(bool until_end);
  bool leave_read_turn(Scratch& scratch, bool may_dispatch);
  bool hand_on(Scratch& scratch, bool may_dispatch, bool& must_post);
  void enqueue(Frame frame);
  void charge(Frame& frame);
  bool dispatch(Turn& turn);
  bool drain(Turn& turn);
  void handle_in_turn(Turn& turn, Handling admission, bool& is_again);
  void run_laters(DeferredCallbacks& deferred, Handling admission);
  void drain_posted();
  [[nodiscard]] static Frame keep(Frame frame);
  void drain_soon();
  void note_pace(const Turn& turn);

  // When a server does not read on, nor hands on (stream_pausing.cpp)
  [[nodiscard]] bool is_paused() const;
  [[nodiscard]] bool may_callers_read() const;
  [[nodiscard]] bool is_overdrawn() const;
  std::span<std::byte> room(Scratch& scratch);
  Received wait_for_memory();
  void note_assembly();
  void schedule_look(Time when);
  void look_at_message();
  void read_late(Time asked);
  void give_time();
  // So many that it is worth a look.
  [[nodiscard]] bool has_many_answers() const {
    return outbox_bytes_.load(std::memory_order_relaxed) > many_answers_;
  }
  // True when requests have to wait until the other side has taken answers; go_on() comes then.
  bool answers_wait() {
    return has_many_answers() ? look_at_answers() : answers_wait_.load(std::memory_order_relaxed);
  }
  bool look_at_answers();
  [[nodiscard]] std::size_t unsent() const { return outbox_.size() + carrier_unsent(); }
  [[nodiscard]] std::size_t most_answers() const;
  // Under sending_: bytes of answers that wait, at most. Events and packets do not count: a client
  // that takes them slowly may still ask, and be it to stop something.
  [[nodiscard]] std::size_t waiting_answers() const { return std::min(answer_bytes_, unsent()); }
  void go_on();
  void put_back(Turn& turn);
  [[nodiscard]] std::unique_ptr<std::deque<Frame>> take_queue();
  [[nodiscard]] bool is_departed() const;

  // The dispatch turn while its holder waits, and what does without it (dispatch_turn.cpp)
  void loosen_turn();
  void handle_aside(Frame frame);
  [[nodiscard]] bool must_yield(Turn& turn) const;
  bool is_suspended(Turn& turn, Frame frame);
  [[nodiscard]] bool may_be_absent() const;
  bool begin_absence();
  [[nodiscard]] std::shared_ptr<ThreadShare> callback_share();
  void end_absence();
  void handle_frame(Scratch& scratch, const Frame& frame, bool is_parsed, Turn* turn);
  void complete(Message& message) const;

  // What is carried otherwise than as plain bytes of the socket (stream_carried.cpp)
  Received receive_carried(Scratch& scratch, bool may_block, bool& is_full);
  Received receive_messages(Scratch& scratch, bool may_block);
  Received receive_bytes(Scratch& scratch, bool may_block, bool& is_full);

  // What a client asks for first (stream_opening.cpp)
  [[nodiscard]] std::unique_ptr<Layer> asked_layer(std::byte first);
  Received upgrade(Scratch& scratch, std::size_t size, std::unique_ptr<Layer> layer);
  LayeredCarrier& layers();
  void answer_start_tls(const Message& message, const Entry& entry);
  Received begin_tls();
  void note_peer();
  [[nodiscard]] bool is_encrypted() const;
  [[nodiscard]] std::string scheme() const;
  [[nodiscard]] bool is_certified(const Message& message) const;
  [[nodiscard]] const NodeId& sender_of(const Message& message) const;

  [[nodiscard]] std::size_t carrier_unsent() const {
    return carrier_ == nullptr ? 0 : carrier_->unsent();
  }
  [[nodiscard]] Carrier* sending_carrier();

  // Callers (stream_callers.cpp)
  enum class Gathered : std::uint8_t { no, as_first, as_other };
  bool others_come();
  Gathered gather_call(Writer& message);
  void let_others_come();
  void begin_lead(Waiter& waiter);
  bool lead(Waiter& waiter, Time deadline, Time now);
  bool may_block_until(Time deadline);
  void leave_to_reactor(Scratch& scratch);
  void wait_until_handled(const Waiter& waiter, Time deadline);
  bool follow(Waiter& waiter, Time deadline);
  bool begin_following(Waiter& waiter);
  bool unlink(Waiter& waiter);
  const SleepWord* choose_next();
  void pass();
  void find_reader();
  void wake_answered();

  // When the reactor watches (stream_watching.cpp)
  void park_or_watch();
  void set_watch(Watch watch);
  void watch_again();
  void unpark();
  [[nodiscard]] Milliseconds park_time() const;
  void limit_receive_time();
  bool is_busy(Time last_received);
  void acknowledge_late();
  void look_for_waiting_sender(Time before);
  void stay(Scratch& scratch);
  bool begin_staying(std::uint32_t& leads);
  bool go_on_staying(Received received, std::uint32_t& leads);
  std::uint32_t read_to_stay();

  // Stream operations and heartbeats (stream_operations.cpp)
  bool take_own(const Message& message, const Entry& entry);
  void answer_stream_op(const Message& message, const Entry& entry);
  void answer_create_connection(const Message& message, const Entry& entry);
  void answer_capability(const Message& message, const Entry& entry);
  void answer_test(const Message& message, const Entry& entry);
  void send_test();

  // Life (stream_connection.cpp)
  void look_after();
  void begin_close(const Error& why);
  void finish_close();
  [[nodiscard]] Limits limits() const;
  [[nodiscard]] std::uint32_t largest_message() const;
  [[nodiscard]] Milliseconds heartbeat_period() const;

  // So much is worth a system call at once.
  static constexpr std::size_t stream_chunk = 64 * 1024;
  // What a message that waits costs besides its bytes.
  static constexpr std::size_t bytes_beside_frame = 128;
  // A receive returns after this time to look at the deadline, or to give the thread back to the
  // reactor; set once per socket, which is cheaper than waiting with poll() each time.
  static constexpr Milliseconds receive_pause{100};

  const Role role_;
  const Descriptor socket_;
  const std::shared_ptr<Reactor> reactor_;
  const std::shared_ptr<const NodeOptions> options_;
  const LinkTerms terms_;
  const std::uint32_t largest_size_;  // of a message
  const std::size_t many_answers_;    // bytes that wait; of a server
  // Null for plain bytes; written with the read turn and under sending_.
  std::unique_ptr<Carrier> carrier_;
  const std::string remote_address_;
  Tap* const tap_;  // of the options; null: none
  std::uint32_t tap_number_ = 0;
  std::shared_ptr<Receiver> receiver_;
  std::shared_ptr<StreamConnection> self_;  // while the reactor may name this; guarded by turns_
  std::function<void(StreamConnection&)> on_gone_;
  std::atomic<bool> has_local_strings_{false};
  std::atomic<bool> has_standard_strings_{false};

  // Guards what follows, never while user code runs or the network is waited for.
  std::mutex turns_;
  bool is_read_ = false;
  bool read_again_ = false;     // there is more than the thread with the read turn may have seen
  bool is_dispatched_ = false;  // the dispatch turn is taken
  bool is_turn_loose_ = false;  // but by no thread yet: posted work, or one that returns, takes it
  // A message was put off: the turn is taken, by no thread, until the end of that.
  enum class PutOff : std::uint8_t { no, begun, resumed, suspended };
  PutOff put_off_ = PutOff::no;
  unsigned absent_ = 0;  // threads in the receiver, now or soon, without the turn
  std::shared_ptr<ThreadShare> callback_threads_;  // of a client, from its first callback on
  Returning* returning_ = nullptr;                 // those of them that want it back
  bool is_stalled_ = false;                        // not read on because of queued requests
  bool is_refused_ = false;                        // nor for want of memory
  Time look_due_ = never;                          // of look_timer_
  bool is_closed_pending_ = false;
  std::atomic<bool> is_closing_{false};  // written under turns_
  Watch watch_ = Watch::off;
  bool is_watched_ = false;  // by the reactor, for anything
  bool is_park_timed_ = false;
  bool is_stayed_with_ = false;  // by a thread of the reactor
  std::uint32_t leads_ = 0;      // claims that succeeded, and receives while stayed with
  std::uint32_t leads_seen_ = 0;
  Time last_lead_{};
  std::atomic<unsigned> coming_{0};  // callers that have been woken and may call again; estimated
  Waiter* followers_ = nullptr;
  std::atomic<unsigned> passing_{0};          // followers that have been answered and are to run
  std::atomic<bool> lacks_reader_{false};     // one of those looks after it; written under turns_
  std::unique_ptr<std::deque<Frame>> queue_;  // messages for the dispatch turn
  std::size_t queued_bytes_ = 0;
  std::unique_ptr<const Error> why_closed_;

  Inbox inbox_;                 // with the read turn
  Time refused_since_ = never;  // with the read turn
  Waiter* answered_ = nullptr;  // with the read turn: followers to be woken
  Waiter** answered_end_ = &answered_;
  bool has_woken_ = false;        // the caller that reads has woken others; with the read turn
  bool had_message_ = false;      // with the read turn
  bool begins_tls_ = false;       // with the read turn: after the message that asked for it
  bool is_mutual_ = false;        // with the read turn: and of the client wants a certificate
  bool has_more_behind_ = false;  // with the read turn: bytes behind that message
  bool is_layered_ = false;       // with the read turn: the carrier is a LayeredCarrier
  NodeId certified_node_;  // what the other side has proved to be; once, before is_proven_ is set
  std::atomic<bool> is_proven_{false};
  bool has_receive_timeout_ = false;         // with the read turn
  bool acknowledges_late_ = true;            // with the read turn
  std::atomic<std::uint8_t> long_reads_{0};  // in a row; written by who has just read
  unsigned busy_receives_ = 0;               // with the read turn
  std::uint32_t busy_leads_ = 0;             // with the read turn
  bool holds_back_answers_ = false;          // with the dispatch turn

  std::mutex sending_;
  Outbox outbox_;                          // under sending_
  Charge outbox_charge_;                   // under sending_: for what the socket did not take
  std::size_t answer_bytes_ = 0;           // under sending_: of answers, since nothing has waited
  std::atomic<bool> is_over_{false};       // written under sending_: the account refused that
  std::atomic<bool> answers_wait_{false};  // written under sending_: too many
  std::atomic<bool> has_unsent_{false};    // the socket took not all
  std::atomic<std::size_t> outbox_bytes_{0};

  std::mutex streaming_;  // after sending_
  Allocation streamed_;   // messages that follow the outbox; under streaming_, as the next two
  std::size_t streamed_size_ = 0;
  Time last_streamed_{};
  bool is_gathering_ = false;  // a caller waits for others, and sends what they ask; the same
  unsigned missing_ = 0;       // until half of them have come; the same
  Time crowded_until_{};       // nobody waits so before; the same, or the one who gathers
  std::atomic<std::size_t> streamed_bytes_{0};  // the same as streamed_size_

  std::atomic<Time> last_sent_;
  std::atomic<Time> last_received_;
  std::atomic<Time> message_due_{never};      // of the message that has begun
  std::atomic<Milliseconds> message_time_{};  // that it may take
  std::atomic<bool> is_end_in_sight_{false};  // the reactor has been told of it, once
  std::atomic<bool> was_heard_{false};        // a whole message has come
  // What a client has put around its messages.
  static constexpr unsigned web_tls_way = 1;
  static constexpr unsigned web_socket_way = 2;
  static constexpr unsigned start_tls_way = 4;
  std::atomic<unsigned> ways_{0};
  std::atomic<Time> close_at_{never};
  const Time created_;
  LifeTimer life_timer_{*this};
  ParkTimer park_timer_{*this};
  LookTimer look_timer_{*this};
};

}  // namespace rr::channel
