// SPDX-License-Identifier: Apache-2.0
// How messages leave a connection.
#include <algorithm>

#include "rr/error.hpp"
#include "rr/reader.hpp"
#include "runtime/cpp/src/channel/caller_steps.hpp"
#include "runtime/cpp/src/channel/strand_turn.hpp"
#include "runtime/cpp/src/channel/stream_connection.hpp"

namespace rr::channel {
namespace {

// Senders stop this much earlier than receivers (04, section 3).
constexpr std::size_t size_margin = 100;

constexpr const char* not_taken = "the other side does not take what is sent to it";

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

[[gnu::hot]] void StreamConnection::check_size(const Writer& message) const {
  if (message.failed()) throw Error(message.code(), message.Latch::message());
  if (message.size() + size_margin > largest_message()) {
    throw Error(ErrorCode::protocol_error,
                "the message of " + std::to_string(message.size()) + " bytes is too large");
  }
}

bool StreamConnection::has_strings() const {
  return has_local_strings_.load(std::memory_order_relaxed) ||
         has_standard_strings_.load(std::memory_order_relaxed);
}

std::vector<std::byte> StreamConnection::with_strings(Writer& message) const {
  return apply_string_table(message.copy(), has_local_strings_, has_standard_strings_);
}

// One message

[[gnu::hot]] void StreamConnection::send(Writer& message, Time now, Priority priority) {
  send(message, {.now = now, .priority = priority});
}

void StreamConnection::send_newest(Writer& message, const Newest& newest, Time now) {
  send(message, {.now = now, .newest = &newest});
}

// One receive often brings the answers of several callers, which then ask again one after the
// other. The first of them waits for the rest, and sends what all of them ask.
[[gnu::hot]] void StreamConnection::send_call(Writer& message, Time now, Priority priority) {
  if (lease().arrive() && priority == Priority::usual && !has_strings()) {
    check_size(message);
    if (CallerSteps<StreamConnection>::send_together(*this, message)) return;
  }
  send(message, now, priority);
}

[[gnu::hot]] void StreamConnection::send(Writer& message, const SendQueue::How& how) {
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

[[gnu::hot]] void StreamConnection::send_or_queue(Writer& message, const SendQueue::How& how) {
  if (is_closed()) throw Error(ErrorCode::connection_error, "the connection is closed");
  const LargeArrays arrays(message);
  const SendQueue::Sent sent = sending_.send(message, how);
  arrays.release();
  if (sent == SendQueue::Sent::taken) return;
  if (sent == SendQueue::Sent::broken) fail_sending();
  watch_for_room();
  // There may have been room before anybody knew that it was wanted.
  flush();
}

void StreamConnection::fail_sending() {
  const Error why(ErrorCode::connection_error, not_taken);
  close(why);
  throw Error(why);
}

// The same under a lock.
void StreamConnection::fail_later() {
  reactor_->post(
      [self = shared_from_this()] { self->close(Error(ErrorCode::connection_error, not_taken)); });
}

[[gnu::hot]] void StreamConnection::reply(Writer& message, Priority priority) {
  try {
    const StrandTurn* const turn = StrandTurn::current(strand());
    const bool has_strand = turn == nullptr || turn->is_held();
    if (has_strand && holds_back_answers_ && message.size() < Writer::attach_threshold &&
        !has_strings()) {
      check_size(message);
      if (!sending_.hold_back(message, priority)) fail_later();
    } else {
      // The request came a moment ago.
      send(message, {.now = keep_alive_.last_received(), .priority = priority, .is_answer = true});
    }
  } catch (const Error& error) {
    // When the client is gone nobody is left that could be told.
    if (error.code() != ErrorCode::connection_error) throw;
  }
}

void StreamConnection::send_own(Writer& message) {
  try {
    send(message, coarse_now(), Priority::usual);
  } catch (const Error&) {
    // The connection ends, which its receiver is told in another way.
  }
}

// Sends what waits, as far as the socket takes it.
void StreamConnection::flush() {
  const SendQueue::Flushed flushed = sending_.flush();
  // Whoever takes answers is there, though it is not read.
  if (flushed.took_answers) keep_alive_.note_received(coarse_now());
  if (flushed.may_read_on) reactor_->post([self = shared_from_this()] { self->go_on(); });
  if (flushed.is_broken) {
    close(Error(ErrorCode::connection_error, not_taken));
  } else if (flushed.has_rest) {
    watch_for_room();
  }
}

// The reactor flushes when there is room; it does not look while the socket is idle.
void StreamConnection::watch_for_room() {
  const MutexLock lock(mutex_);
  watch_.update(sending_.has_unsent());
}

// Streams

[[gnu::hot]] void StreamConnection::stream(Writer& message) {
  check_size(message);
  if (message.version() == MessageVersion::v4 && has_strings()) {
    const std::vector<std::byte> coded = with_strings(message);
    Writer writer;
    writer.prepend_bytes(coded.data(), coded.size());
    stream_or_queue(writer);
  } else {
    stream_or_queue(message);
  }
}

[[gnu::hot]] void StreamConnection::stream_or_queue(Writer& message) {
  if (is_closed()) throw Error(ErrorCode::connection_error, "the connection is closed");
  sending_.check_room_for_packet(message.size());
  const std::size_t size = message.size();
  const SendQueue::Sent sent = sending_.stream(message);
  if (size >= Writer::attach_threshold) message.reset(message.version());
  if (sent == SendQueue::Sent::broken) {
    // What closes it may run what is left over, so not here, under the caller's lock.
    fail_later();
  } else if (sent == SendQueue::Sent::first) {
    // It sends, or waits for room. Without its thread one of the node's does, not this one: what a
    // broken connection leaves over would run here, under the caller's lock.
    if (!reactor_->flusher().add(shared_from_this())) {
      reactor_->post([self = shared_from_this()] { self->flush_streamed(); });
    }
  }
}

[[gnu::hot]] bool StreamConnection::has_sent(std::size_t bytes) const {
  return sending_.waiting_bytes() <= bytes;
}

bool StreamConnection::wait_sent(std::size_t bytes, Time deadline) {
  if (has_sent(bytes)) return true;
  Reactor::about_to_wait();
  while (!is_closing_) {
    flush();
    if (has_sent(bytes)) return true;
    const Time now = Clock::now();
    if (now >= deadline) return false;
    const Time until = std::min(deadline, now + std::chrono::seconds(1));
    if (Carrier* const carrier = sending_.carrier()) {
      carrier->wait_for_room(until);
    } else {
      platform::wait_for(socket_.get(), ready::room, until);
    }
  }
  return false;
}

}  // namespace rr::channel
