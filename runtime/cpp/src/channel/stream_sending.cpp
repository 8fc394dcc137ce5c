// SPDX-License-Identifier: Apache-2.0
// How messages leave a connection.
#include <sys/epoll.h>

#include <optional>

#include "rr/error.hpp"
#include "rr/reader.hpp"
#include "runtime/cpp/src/channel/stream_connection.hpp"

namespace rr::channel {
namespace {

// Senders stop this much earlier than receivers (04, section 3).
constexpr std::size_t size_margin = 100;

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
  const std::size_t size = message.size();
  bool has_rest = false;
  bool had_rest = false;
  bool is_broken = false;
  {
    const std::lock_guard lock(sending_);
    had_rest = has_unsent_.load(std::memory_order_relaxed);
    is_broken = !send_under_lock(message, how, has_rest);
  }
  // A large array is not to be kept until this thread sends again.
  if (size >= Writer::attach_threshold) message.reset(message.version());
  if (is_broken) fail_sending();
  if (has_rest && !had_rest) {
    watch_for_room();
    // There may have been room before anybody knew that it was wanted.
    flush();
  }
}

// Under sending_. False when the connection is broken or far too much waits.
bool StreamConnection::send_under_lock(Writer& message, const Sending& how, bool& has_rest) {
  const bool is_unsent = has_unsent_.load(std::memory_order_relaxed);
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
    is_broken = outbox_.size() > options_->send_queue_limit;
    has_unsent_ = true;
  }
  note_waiting();
  return !is_broken;
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
    if (holds_back_answers_ && message.size() < Writer::attach_threshold && !has_strings()) {
      check_size(message);
      const std::lock_guard lock(sending_);
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
      note_waiting();
    } else {
      // The request came a moment ago.
      send(message, last_received_.load(std::memory_order_relaxed), priority);
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
  {
    const std::lock_guard lock(sending_);
    take_streamed();
    if ((outbox_.empty() && carrier_unsent() == 0) || is_closing_) return;
    is_broken = (carrier_ != nullptr && !carrier_->flush()) ||
                outbox_.send(socket_.get(), {}, carrier_.get()) < 0;
    has_rest = !outbox_.empty() || carrier_unsent() != 0;
    has_unsent_ = has_rest;
    note_waiting();
    last_sent_.store(coarse_now(), std::memory_order_relaxed);
  }
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
