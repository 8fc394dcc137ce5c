// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "rr/buffer.hpp"
#include "rr/channel.hpp"
#include "rr/error.hpp"
#include "rr/node_id.hpp"
#include "rr/reader.hpp"
#include "rr/wire.hpp"
#include "rr/writer.hpp"
#include "runtime/cpp/src/channel/account.hpp"
#include "runtime/cpp/src/channel/thread_share.hpp"
#include "runtime/cpp/src/channel/time.hpp"
#include "runtime/cpp/src/channel/waiter.hpp"

namespace rr::channel {

/// What was found while reading and may run user code, which must wait until reading is given up.
using DeferredCallbacks = std::vector<std::function<void()>>;

/// What gets the messages of a connection: the endpoint layer.
class Receiver {
 public:
  virtual ~Receiver() = default;
  /// An entry that answers a request. On whichever thread reads, in the order of arrival; may not
  /// wait nor run user code, but leave that in `deferred`.
  virtual void take_answer(const Message& message, const Entry& entry, const MemoryRef& owner,
                           DeferredCallbacks& deferred) = 0;
  /// A packet of which only the newest counts, if it is alone in its message: the same holds. False
  /// when it is to go to handle() as others do.
  virtual bool take_packet(const Message& /*message*/, const Entry& /*entry*/,
                           const MemoryRef& /*owner*/, DeferredCallbacks& /*deferred*/) {
    return false;
  }
  /// A message that handle() gets in its turn, and that ends something for which answers may come
  /// before that. On whichever thread reads, in the order of arrival, as take_answer().
  virtual void foresee(const Message& /*message*/) {}
  /// Any other message, one at a time and in order, on a thread of the node; may run user code.
  /// `first` is its first entry. Callbacks come to a client out of turn, several at a time: whoever
  /// handles something else may be waiting for the call that they are a part of.
  virtual void handle(const Message& message, const Entry& first, const MemoryRef& owner) = 0;
  /// The connection is gone: requests fail. At once, on any thread; may not run user code.
  virtual void lost(const Error& why, DeferredCallbacks& deferred) = 0;
  /// The last call: comes in order behind the last message. May run user code.
  virtual void closed() = 0;
};

/// What a message is of which only the newest counts: a value of one stream. While one waits to be
/// sent, a later one of the same stream takes its place (04, section 3).
struct Newest {
  std::uint64_t stream = 0;  ///< from Connection::new_stream()
  std::int64_t time = 0;     ///< grows
};

/// What a message may overtake of those that wait to be sent, which none does before it waits.
enum class Priority : std::uint8_t {
  usual,   ///< nothing
  urgent,  ///< usual ones, but for one of which a part has been sent
  fixed,   ///< nothing, and nothing overtakes it or what waits before it
};

class PipeRingReader;
struct PipeRingStart;
class ServedHolds;
class SlotReader;

/// Carries messages to and from one other node. Any thread may send.
///
/// Large because it is all that sessions of both sides and of all channels need: terms, sending,
/// waiting for answers, and the strand.
///
/// Reading has no thread of its own: a thread that waits for an answer reads the connection itself
/// if nobody does, and hands on what belongs to others; while nobody waits, the reactor reads.
class Connection {
 public:
  virtual ~Connection() = default;

  // What the two sides agreed on.
  [[nodiscard]] MessageVersion version() const { return version_.load(std::memory_order_relaxed); }
  [[nodiscard]] bool may_combine() const { return may_combine_; }
  /// Zero until the other side has said who it is.
  [[nodiscard]] const NodeId& remote_node() const { return remote_node_; }
  [[nodiscard]] const std::string& remote_name() const { return remote_name_; }
  /// The address of this side as it may stand in a URL: `rr+tcp://10.0.0.5:2355`; empty if unknown.
  [[nodiscard]] virtual std::string local_url() const = 0;
  /// Who is at the other end: an IP address without its port, `uid 1000` for a local socket,
  /// `intra` within the process, the scheme for a channel of the program's own; empty if unknown.
  [[nodiscard]] virtual std::string remote_address() const { return {}; }
  /// The node that the other side has proved to be by its certificate; zero without one. Once it
  /// has said who it is.
  [[nodiscard]] virtual NodeId certified_node() const { return {}; }
  /// What the way between the two sides is like.
  [[nodiscard]] virtual ChannelTraits traits() const = 0;

  /// What the other side makes this one hold; null where nobody counts it.
  [[nodiscard]] const std::shared_ptr<Account>& account() const { return account_; }
  /// Before the connection is used.
  void set_account(std::shared_ptr<Account> account) { account_ = std::move(account); }

  // Memories of wires and pipes that the service's side writes and the client's side reads.
  /// Whether both sides pass such memories.
  [[nodiscard]] virtual bool shares_slots() const { return false; }
  /// By the service's side: gives one to the other side, which has it before what is sent
  /// afterwards. False when that is not possible; then it is to be told otherwise.
  [[nodiscard]] virtual bool pass_memory(const platform::Descriptor& /*handle*/) { return false; }
  /// By the client's side, from Receiver::take_answer(): takes one that was passed; null for none.
  /// `holds`: the place of the words that the service's side has drawn for its reader.
  virtual std::shared_ptr<SlotReader> take_slots(std::uint64_t /*id*/,
                                                 std::optional<std::uint32_t> /*holds*/) {
    return nullptr;
  }
  /// The same for the memory of a pipe.
  virtual std::shared_ptr<PipeRingReader> take_ring(const PipeRingStart& /*start*/) {
    return nullptr;
  }
  /// By the service's side: words by which one reader says which slots it uses, or how far it is in
  /// a ring; null for none.
  virtual std::shared_ptr<ServedHolds> draw_holds() { return nullptr; }

  /// The threads that what the other side asks may take; null where nobody counts them, as for a
  /// client's connection.
  [[nodiscard]] const std::shared_ptr<ThreadShare>& threads() const { return threads_; }

  /// The two endpoints that the connection carries: what a message without them is taken to have.
  void set_endpoints(std::uint32_t own, std::uint32_t remote) {
    own_endpoint_.store(own, std::memory_order_relaxed);
    remote_endpoint_.store(remote, std::memory_order_relaxed);
  }
  [[nodiscard]] std::uint32_t own_endpoint() const {
    return own_endpoint_.load(std::memory_order_relaxed);
  }
  /// Whether the other side is in a session and, where users are needed, logged in. Only then may
  /// messages have full size, and what it makes this node hold counts as that of a session.
  void set_authorised(bool is_authorised) {
    if (is_authorised_.exchange(is_authorised) == is_authorised) return;
    if (on_authorised_) on_authorised_(is_authorised);
  }
  /// Before the connection is used: called when that has changed.
  void set_on_authorised(std::function<void(bool)> on_authorised) {
    on_authorised_ = std::move(on_authorised);
  }

  /// Throws rr::Error when a message, or an entry of one, cannot be sent: protocol_error for one
  /// that is too large, or what the writer has failed with.
  virtual void check_size(const Writer& message) const = 0;
  /// Sends a finished message now, or as soon as the other side takes it; never blocks. The writer
  /// can be used again at once. Throws rr::Error: protocol_error for one that is too large,
  /// connection_error when the connection is gone; out_of_system_resource when so much waits to be
  /// sent to peers that a large one may not wait, too. `now` need not be exact.
  virtual void send(Writer& message, Time now, Priority priority) = 0;
  void send(Writer& message, Time now) { send(message, now, Priority::usual); }
  void send(Writer& message) { send(message, coarse_now()); }
  /// The same for the request of a caller that will wait for its answer. What callers ask that were
  /// woken by one receive leaves together.
  virtual void send_call(Writer& message, Time now, Priority priority) = 0;
  /// The same for a message of which only the newest counts.
  virtual void send_newest(Writer& message, const Newest& newest, Time now) = 0;
  /// A number for a stream of such messages.
  std::uint64_t new_stream() { return next_stream_.fetch_add(1, std::memory_order_relaxed); }
  /// The same for one of a stream of messages. It leaves at once, unless this thread has sent
  /// others a moment ago: then together with those that follow, not much later. Never closes the
  /// connection before it returns, so that it may be called under a lock. Throws rr::Error:
  /// buffer_limit_violation when so much waits to be sent that nothing was done; as above.
  virtual void stream(Writer& message) = 0;
  /// Waits until at most so many bytes wait to be sent. False when that was not so in time, or the
  /// connection is gone.
  virtual bool wait_sent(std::size_t bytes, Time deadline) = 0;
  /// Whether no more than so many bytes wait to be sent.
  [[nodiscard]] virtual bool has_sent(std::size_t bytes) const = 0;
  /// The same for an answer, from Receiver::handle(): it leaves together with other answers to what
  /// one receive has brought. Throws only when it is too large, or may not wait (see send()).
  virtual void reply(Writer& message, Priority priority) = 0;
  void reply(Writer& message) { reply(message, Priority::usual); }

  /// Makes the calling thread the reader if there is none; to be called before the request is sent.
  virtual void claim(Waiter& waiter) = 0;
  /// Waits until the waiter is done or the deadline has come. `now` need not be exact.
  virtual void wait(Waiter& waiter, Time deadline, Time now) = 0;
  /// Ends a claim without waiting.
  virtual void resign(Waiter& waiter) = 0;
  /// Marks a waiter done. It may be gone when this returns.
  virtual void finish(Waiter& waiter) = 0;
  /// The same from Receiver::take_answer(), for when all that was received with the answer has been
  /// looked at: those whose answers came together are woken together.
  virtual void finish_answered(Waiter& waiter) = 0;
  /// To be called when something will come that no caller waits for: the reactor reads it then.
  virtual void expect() = 0;
  /// Brings a reader that waits to look at its deadline and at whether it is done.
  virtual void nudge() = 0;

  /// From Receiver::handle(): lets another thread handle the messages that follow while this one is
  /// still in there, because it is about to wait for something that they may have to bring. False,
  /// and nothing happens, on a thread that does not handle a message of this connection, and when
  /// too many are in there already. Until it comes back the thread may not call reply().
  virtual bool step_out() = 0;
  /// Must follow step_out(): waits until this is again the thread that handles messages. False
  /// when that was not so in time: then this thread goes on beside the one that is, as far as the
  /// next await_strand().
  virtual bool step_in(Time deadline) = 0;
  /// Before what only the thread does that handles messages: waits until this is that thread, if it
  /// has been. The connection calls it when Receiver::handle() has returned.
  virtual void await_strand() = 0;

  /// From Receiver::handle(), which then returns: the message is handled once more, and those
  /// behind it wait, after resume(). False, and nothing happens, on a thread that does not handle a
  /// message of this connection in its turn.
  virtual bool suspend() { return false; }
  /// Once for each suspend(), on any thread, even before the handler has returned.
  virtual void resume() {}

  /// Ends the connection. Never blocks; Receiver::closed() follows.
  virtual void close(const Error& why) = 0;
  /// The same after a while, in which the other side may do it.
  virtual void close_after(Milliseconds delay) = 0;
  [[nodiscard]] virtual bool is_closed() const = 0;

 protected:
  std::atomic<MessageVersion> version_{MessageVersion::v2};
  std::atomic<bool> may_combine_{false};
  std::atomic<bool> is_authorised_{false};
  std::atomic<std::uint32_t> own_endpoint_{0};
  std::atomic<std::uint32_t> remote_endpoint_{0};
  std::atomic<std::uint64_t> next_stream_{1};
  std::shared_ptr<Account> account_;
  std::function<void(bool)> on_authorised_;
  std::shared_ptr<ThreadShare> threads_;
  NodeId remote_node_;  // written once, by the first message
  std::string remote_name_;
};

}  // namespace rr::channel
