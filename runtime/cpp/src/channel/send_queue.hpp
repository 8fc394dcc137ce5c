// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>

#include "rr/buffer.hpp"
#include "rr/error.hpp"
#include "rr/mutex.hpp"
#include "rr/writer.hpp"
#include "runtime/cpp/src/channel/account.hpp"
#include "runtime/cpp/src/channel/connection.hpp"
#include "runtime/cpp/src/channel/gathered_messages.hpp"
#include "runtime/cpp/src/channel/gathering_steps.hpp"
#include "runtime/cpp/src/channel/metrics.hpp"
#include "runtime/cpp/src/channel/outbox.hpp"
#include "runtime/cpp/src/channel/synchronization.hpp"
#include "runtime/cpp/src/channel/time.hpp"

namespace rr::platform {
class Descriptor;
}

namespace rr::channel {

class Carrier;
class ConnectionTap;

/// The messages that leave one connection: sent at once where the socket takes them, else queued
/// in order and within limits. Any thread may send; nothing here blocks or runs user code.
///
/// Messages may wait for three reasons:
/// - the socket is full: they are queued, and charged to the account of the other side;
/// - more answers to the same receive follow: hold_back() keeps them for the next flush();
/// - others of a stream, or the calls of other callers, follow within microseconds: stream() and
///   cork() gather them in one piece of memory, which leaves with the next message or flush().
///
/// Two locks: a send holds `mutex_` while it is in the system call; what is gathered has a lock of
/// its own (`gathering_`, taken after `mutex_`), so that gathering does not wait for the kernel.
class SendQueue {
 public:
  struct Terms {
    int socket = -1;
    std::size_t limit = 0;         ///< bytes that may wait (NodeOptions::send_queue_limit)
    std::size_t answer_limit = 0;  ///< of answers, until requests wait (answer_queue_limit)
    bool is_server = false;        ///< whose answers are counted
  };
  /// What is known of a message that is sent.
  struct How {
    Time now;
    Priority priority = Priority::usual;
    const Newest* newest = nullptr;  ///< of which only the newest counts; null: all count
    ErrorCode refusal = ErrorCode::out_of_system_resource;  ///< thrown when it may not wait
    bool is_answer = false;
    bool is_packet = false;  ///< of a pipe of a service
  };
  /// What has become of a message.
  enum class Sent : std::uint8_t {
    taken,   ///< sent, queued behind others that wait for room, or gathered with others
    first,   ///< it is the first that waits: somebody has to flush() soon
    broken,  ///< the connection is broken, closed, or far too much waits
  };
  using Corked = channel::Corked;
  struct Flushed {
    bool is_broken = false;
    bool has_rest = false;      ///< the socket is full
    bool took_answers = false;  ///< the other side takes answers that had to wait
    bool may_read_on = false;   ///< few enough answers wait now: requests are handled again
  };

  SendQueue(const Terms& terms, const ConnectionTap& tap);
  SendQueue(const SendQueue&) = delete;
  SendQueue& operator=(const SendQueue&) = delete;

  /// Before the connection is used: who is charged for what waits; null for nobody.
  void set_account(std::shared_ptr<Account> account);
  /// Messages go through the carrier from now on.
  void set_carrier(Carrier* carrier);
  /// Null: the plain bytes of the socket.
  [[nodiscard]] Carrier* carrier() const;
  /// Sends what is the last message to go by the socket, with a handle, and everything after it
  /// through the carrier. False when something waits already, or the socket does not take it: then
  /// the connection is to be closed.
  bool change_over(Writer& last, const platform::Descriptor& handle, Carrier& carrier);

  /// Sends what was held back and the message, and queues what the socket does not take. Throws
  /// `how.refusal` when so much waits for other clients that a large message may not.
  Sent send(Writer& message, const How& how);
  /// An answer of which others follow at once: it leaves with the next flush(). False when the
  /// connection is to be closed, because too much waits.
  bool hold_back(Writer& message, Priority priority);
  /// One of a stream: gathered with others where this thread sends without a pause, else sent.
  Sent stream(Writer& message);
  /// Throws buffer_limit_violation when so much waits that a packet of that size may not.
  void check_room_for_packet(std::size_t size) const;
  /// The call of one of several callers. `expected`: callers that were woken together and have not
  /// called again. The first of them waits for the others in uncork(), and then flushes.
  Corked cork(Writer& message, unsigned expected);
  /// Returns when no expected caller has called for as long as these need to get a processor.
  void uncork(const std::atomic<unsigned>& expected);

  /// Sends what waits, as far as the socket takes it.
  Flushed flush();
  /// Whether requests have to wait until the other side has taken answers.
  [[nodiscard]] bool do_answers_wait() const {
    return answers_wait_.load(std::memory_order_relaxed);
  }
  /// So many bytes wait that check_answers() is worth its lock.
  [[nodiscard]] bool has_many_answers() const {
    return outbox_bytes_.load(std::memory_order_relaxed) > many_answers_;
  }
  /// Looks whether answers beyond the limit wait; do_answers_wait() says so from now on.
  bool check_answers();

  /// The socket has not taken all.
  [[nodiscard]] bool has_unsent() const { return has_unsent_.load(std::memory_order_relaxed); }
  [[nodiscard]] bool has_gathered() const { return gathered_bytes() != 0; }
  [[nodiscard]] std::size_t waiting_bytes() const {
    return outbox_bytes_.load(std::memory_order_relaxed) + gathered_bytes();
  }
  /// Nothing waits but what is gathered.
  [[nodiscard]] bool is_empty() const;
  [[nodiscard]] Time last_sent() const { return last_sent_; }
  /// What was sent, or waits to be.
  [[nodiscard]] Traffic traffic() const;

  /// Nothing is sent from now on. May be called under any lock.
  void close() { is_closed_.store(true, std::memory_order_relaxed); }
  /// After close(): forgets what waits.
  void clear();

 private:
  using Sync = Synchronization;
  friend struct GatheringSteps<SendQueue>;

  // What was sent, or has waited in the outbox; see Traffic.
  struct SentCounts {
    Tally messages;
    Tally bytes;
    Tally wire_values;
    Tally values_skipped;
    Tally packets;
    void add(std::size_t size) {
      messages.add(1);
      bytes.add(size);
    }
  };

  // For what of it needs no lock.
  [[nodiscard]] const GatheredMessages& gathered() const RR_NO_THREAD_SAFETY_ANALYSIS {
    return gathered_;
  }
  [[nodiscard]] std::size_t gathered_bytes() const { return gathered().bytes(); }
  void send_waiting(Flushed& result) RR_REQUIRES(mutex_);
  bool send_under_lock(Writer& message, const How& how, bool& has_rest) RR_REQUIRES(mutex_);
  void queue(Writer& message, std::size_t sent, const How& how, std::optional<std::uint64_t> mark)
      RR_REQUIRES(mutex_);
  void queue_newest_and_tell(Writer& message, const Newest& newest) RR_REQUIRES(mutex_);
  [[nodiscard]] bool admit(std::size_t size, ErrorCode refusal) RR_REQUIRES(mutex_);
  void settle() RR_REQUIRES(mutex_);
  void note_waiting() RR_REQUIRES(mutex_);
  [[nodiscard]] std::size_t unsent() const RR_REQUIRES(mutex_);
  [[nodiscard]] std::size_t waiting_answers() const RR_REQUIRES(mutex_);
  bool gather_if_streaming(Writer& message, bool& is_first);
  [[nodiscard]] bool has_room_for(const Writer& message) const RR_REQUIRES(gathering_);
  void gather(Writer& message) RR_REQUIRES(gathering_);
  void take_gathered() RR_REQUIRES(mutex_);
  void move_gathered() RR_REQUIRES(mutex_, gathering_);
  std::uint64_t take_gathered_and_tell(Writer& message) RR_REQUIRES(mutex_);

  const Terms terms_;
  const std::size_t many_answers_;
  const ConnectionTap& tap_;
  std::atomic<bool> is_closed_{false};

  mutable Mutex mutex_ RR_ACQUIRED_BEFORE(gathering_);
  Carrier* carrier_ RR_GUARDED_BY(mutex_) = nullptr;
  Outbox outbox_ RR_GUARDED_BY(mutex_);
  Charge charge_ RR_GUARDED_BY(mutex_);                 // for what the socket did not take
  std::size_t answer_bytes_ RR_GUARDED_BY(mutex_) = 0;  // of answers, since nothing has waited
  // Written under mutex_, read by anybody.
  std::atomic<bool> is_over_{false};  // the account refused what waits
  std::atomic<bool> answers_wait_{false};
  std::atomic<bool> has_unsent_{false};
  std::atomic<std::size_t> outbox_bytes_{0};
  std::atomic<Time> last_sent_;
  SentCounts sent_;  // written under mutex_

  Mutex gathering_;
  GatheredMessages gathered_ RR_GUARDED_BY(gathering_);  // they follow the outbox
  Time last_streamed_ RR_GUARDED_BY(gathering_){};
  bool is_corked_ RR_GUARDED_BY(gathering_) =
      false;  // a caller waits for others, and sends what they ask
  unsigned missing_ RR_GUARDED_BY(gathering_) =
      0;                  // callers, until half of those expected have come
  Time crowded_until_{};  // nobody corks before; the same, or by the one who has corked
};

}  // namespace rr::channel
