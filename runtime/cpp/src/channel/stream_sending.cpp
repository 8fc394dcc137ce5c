// SPDX-License-Identifier: Apache-2.0
// How messages leave a connection.
#include <sys/epoll.h>

#include <optional>

#include "rr/error.hpp"
#include "rr/reader.hpp"
#include "runtime/cpp/src/channel/dispatch_turn.hpp"
#include "runtime/cpp/src/channel/stream_connection.hpp"

namespace rr::channel {
namespace {

// Senders stop this much earlier than receivers (04, section 3).
constexpr std::size_t size_margin = 100;

// Large arrays of a message are not to be kept until its thread sends again, whether or not it was
// sent.
class LargeArrays {
 public:
  explicit LargeArrays(Writer& message)
      : message_(message.size() >= Writer::attach_threshold ? &message : nullptr) {}
  ~LargeArrays() { release(); }
  LargeArrays(const LargeArrays&) = delete;
  LargeArrays& operator=(const LargeArrays&) = delete;
  void release() const {
    if (message_ != nullptr) message_->reset(message_->version());
  }

 private:
  Writer* const message_;
};

}  // namespace

void StreamConnection::check_size(const Writer& message) const {
  if (message.failed()) throw Error(message.code(), message.Latch::message());
  if (message.size() + size_margin > largest_message()) {
    throw Error(ErrorCode::protocol_error,
                "the message of " + std::to_string(message.size()) + " bytes is too large");
  }
}

void StreamConnection::send(Writer& message, Time now, Priority priority) {
  send(message, {.now = now, .priority = priority});
}

void StreamConnection::send_newest(Writer& message, const Newest& newest, Time now) {
  send(message, {.now = now, .newest = &newest});
}

void StreamConnection::send(Writer& message, const Sending& how) {
  check_size(message);
  if (message.version() == MessageVersion::v4 && has_strings()) {
    const std::vector<std::byte> coded = with_strings(message);
    Writer writer;
    writer.prepend_bytes(coded.data(), coded.size());
    send_or_queue(writer, how);
  } else {
    send_or_queue(message, how);
  }
}

// Sends what was held back and the message, and queues what the socket does not take.
void StreamConnection::send_or_queue(Writer& message, const Sending& how) {
  if (is_closing_.load(std::memory_order_relaxed)) {
    throw Error(ErrorCode::connection_error, "the connection is closed");
  }
  const LargeArrays arrays(message);
  bool has_rest = false;
  bool had_rest = false;
  bool is_broken = false;
  {
    const std::lock_guard lock(sending_);
    had_rest = has_unsent_.load(std::memory_order_relaxed);
    is_broken = !send_under_lock(message, how, has_rest);
  }
  arrays.release();
  if (is_broken) fail_sending();
  if (has_rest && !had_rest) {
    watch_for_room();
    // There may have been room before anybody knew that it was wanted.
    flush();
  }
}

// Under sending_. False when the connection is broken or far too much waits.
bool StreamConnection::send_under_lock(Writer& message, const Sending& how, bool& has_rest) {
  if (is_closing_.load(std::memory_order_relaxed)) return false;
  const bool is_unsent = has_unsent_.load(std::memory_order_relaxed);
  // A small one that is sent at once costs nothing; of a large one something is mostly left.
  const bool may_wait = is_unsent || message.size() >= Writer::attach_threshold;
  if (account_ != nullptr && may_wait && !admit(message.size(), how.refusal)) return false;
  const bool may_replace = is_unsent && how.newest != nullptr;
  std::optional<std::uint64_t> told;
  if (tap_ == nullptr || may_replace) {
    take_streamed();
  } else {
    told = take_streamed_and_tell(message);
  }
  const bool overtakes = how.priority == Priority::urgent && !outbox_.empty();
  if (overtakes) outbox_.add_urgent(message);
  const std::span<const Piece> rest = overtakes ? std::span<const Piece>() : message.pieces();
  std::ptrdiff_t sent = 0;
  if (!is_unsent) sent = outbox_.send(socket_.get(), rest, carrier_.get());
  last_sent_.store(how.now, std::memory_order_relaxed);
  bool is_broken = sent < 0;
  const bool is_left = !overtakes && sent != static_cast<std::ptrdiff_t>(message.size());
  if (is_left && !is_broken) queue_rest(message, static_cast<std::size_t>(sent), how, told);
  has_rest = !is_broken && (is_left || (overtakes && !outbox_.empty()) || carrier_unsent() != 0);
  if (has_rest) {
    if (how.is_reply) answer_bytes_ += message.size();
    is_broken = outbox_.size() > options_->send_queue_limit;
    has_unsent_ = true;
  }
  note_waiting();
  settle();
  return !is_broken;
}

// Under sending_, with an account: whether so many bytes more may wait. Throws `refusal` when a
// large message may not; what is small may, so that the other side learns of it, up to a point.
bool StreamConnection::admit(std::size_t size, ErrorCode refusal) {
  constexpr std::size_t small = 4 * 1024;
  constexpr std::size_t most_small = 128 * 1024;
  if (outbox_charge_.add(size)) return true;
  is_over_ = true;
  if (size > small || refusal == ErrorCode::buffer_limit_violation) {
    throw Error(refusal,
                "so much waits to be sent to clients that do not take it that no more may wait");
  }
  if (unsent() > most_small) return false;
  outbox_charge_.add_anyway(size);
  return true;
}

// Under sending_: the account is charged for what the socket did not take, and nothing else.
void StreamConnection::settle() {
  if (account_ == nullptr) return;
  const std::size_t waiting = has_unsent_.load(std::memory_order_relaxed) ? unsent() : 0;
  const std::size_t charged = outbox_charge_.bytes();
  if (waiting > charged && !outbox_charge_.add(waiting - charged)) {
    outbox_charge_.add_anyway(waiting - charged);
    is_over_ = true;
  } else if (waiting < charged) {
    outbox_charge_.reduce(charged - waiting);
    if (is_over_.load(std::memory_order_relaxed)) is_over_ = !outbox_charge_.can_add(stream_chunk);
  }
}

// What waits when the connection ends is nobody's.
void StreamConnection::drop_unsent() {
  const std::lock_guard lock(sending_);
  outbox_.clear();
  outbox_charge_.clear();
  const std::lock_guard streaming(streaming_);
  streamed_ = {};
  streamed_size_ = 0;
}

// Under sending_.
void StreamConnection::queue_rest(Writer& message, std::size_t sent, const Sending& how,
                                  std::optional<std::uint64_t> told) {
  if (how.newest != nullptr && tap_ != nullptr && !told) {
    queue_newest_and_tell(message, *how.newest);
  } else if (how.newest != nullptr && sent == 0) {
    const Outbox::Queued queued = outbox_.add_newest(message, how.newest->stream, how.newest->time);
    if (queued.mark != nullptr) *queued.mark = told.value_or(0);
  } else {
    outbox_.add(message, sent);
  }
  if (how.priority != Priority::usual) outbox_.fix_order();
}

// The same under a lock.
void StreamConnection::fail_later() {
  reactor_->post([self = shared_from_this()] {
    self->close(
        Error(ErrorCode::connection_error, "the other side does not take what is sent to it"));
  });
}

void StreamConnection::fail_sending() {
  const Error why(ErrorCode::connection_error, "the other side does not take what is sent to it");
  close(why);
  throw Error(why);
}

bool StreamConnection::has_strings() const {
  return has_local_strings_.load(std::memory_order_relaxed) ||
         has_standard_strings_.load(std::memory_order_relaxed);
}

std::vector<std::byte> StreamConnection::with_strings(Writer& message) const {
  return apply_string_table(message.copy(), has_local_strings_, has_standard_strings_);
}

void StreamConnection::reply(Writer& message, Priority priority) {
  try {
    const Turn* const turn = Turn::current(*this);
    const bool has_turn = turn == nullptr || turn->is_held();
    if (has_turn && holds_back_answers_ && message.size() < Writer::attach_threshold &&
        !has_strings()) {
      check_size(message);
      const std::lock_guard lock(sending_);
      if (account_ != nullptr && has_unsent_ &&
          !admit(message.size(), ErrorCode::out_of_system_resource)) {
        fail_later();
        return;
      }
      if (tap_ == nullptr) {
        take_streamed();
      } else {
        take_streamed_and_tell(message);
      }
      if (priority == Priority::urgent) {
        outbox_.add_urgent(message);
      } else {
        outbox_.add(message, 0);
        if (priority == Priority::fixed) outbox_.fix_order();
      }
      answer_bytes_ += message.size();
      note_waiting();
    } else {
      // The request came a moment ago.
      send(message, {.now = last_received_.load(std::memory_order_relaxed),
                     .priority = priority,
                     .is_reply = true});
    }
  } catch (const Error& error) {
    // When the client is gone nobody is left that could be told.
    if (error.code() != ErrorCode::connection_error) throw;
  }
}

void StreamConnection::send_own(Writer& message) {
  try {
    send(message);
  } catch (const Error&) {
    // The connection ends, which its receiver is told in another way.
  }
}

// Sends what waits, as far as the socket takes it.
void StreamConnection::flush() {
  bool is_broken = false;
  bool has_rest = false;
  bool may_go_on = false;
  {
    const std::lock_guard lock(sending_);
    take_streamed();
    if ((outbox_.empty() && carrier_unsent() == 0) || is_closing_) return;
    const std::size_t before = unsent();
    is_broken = (carrier_ != nullptr && !carrier_->flush()) ||
                outbox_.send(socket_.get(), {}, carrier_.get()) < 0;
    has_rest = !outbox_.empty() || carrier_unsent() != 0;
    has_unsent_ = has_rest;
    note_waiting();
    settle();
    last_sent_.store(coarse_now(), std::memory_order_relaxed);
    if (answers_wait_.load(std::memory_order_relaxed)) {
      // Whoever takes answers is there, though it is not read.
      if (unsent() < before) last_received_.store(coarse_now(), std::memory_order_relaxed);
      may_go_on = waiting_answers() <= most_answers() / 2;
      if (may_go_on) answers_wait_ = false;
    }
  }
  if (may_go_on) reactor_->post([self = shared_from_this()] { self->go_on(); });
  if (is_broken) {
    close(Error(ErrorCode::connection_error, "the other side does not take what is sent to it"));
  } else if (has_rest) {
    watch_for_room();
  }
}

// The reactor flushes when there is room; it does not look while the socket is parked.
void StreamConnection::watch_for_room() {
  const std::lock_guard lock(turns_);
  if (watch_ == Watch::parked) set_watch(Watch::parked);
}

}  // namespace rr::channel
