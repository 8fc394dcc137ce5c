// SPDX-License-Identifier: Apache-2.0
// How streams of messages leave a connection: what is sent without a pause leaves together.
#include <poll.h>

#include <algorithm>
#include <cstring>
#include <utility>

#include "rr/error.hpp"
#include "runtime/cpp/src/channel/stream_connection.hpp"

namespace rr::channel {
namespace {

// A thread sends without a pause when it has begun to send another message this little before, to
// whomever, and one on the same connection not long before that. Paced senders, of one packet at a
// time to many connections too, are therefore never held back.
constexpr std::chrono::microseconds pause_between{20};
constexpr std::chrono::microseconds pause_on_connection{200};

thread_local Time last_streamed_here{};

}  // namespace

void StreamConnection::stream(Writer& message) {
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

std::size_t StreamConnection::waiting_bytes() const {
  return outbox_bytes_.load(std::memory_order_relaxed) +
         streamed_bytes_.load(std::memory_order_relaxed);
}

// Under sending_.
void StreamConnection::note_waiting() {
  const std::size_t waiting = unsent();
  if (waiting == 0) answer_bytes_ = 0;
  outbox_bytes_.store(waiting, std::memory_order_relaxed);
}

// Under sending_: what streams have left behind is next.
void StreamConnection::take_streamed() {
  if (streamed_bytes_.load(std::memory_order_relaxed) == 0) return;
  const std::lock_guard lock(streaming_);
  move_streamed();
}

// Under sending_ and streaming_.
void StreamConnection::move_streamed() {
  Allocation memory = std::exchange(streamed_, {});
  const std::size_t size = std::exchange(streamed_size_, 0);
  streamed_bytes_.store(0, std::memory_order_relaxed);
  if (size != 0) outbox_.add(std::move(memory), size);
  note_waiting();
}

// Leaves a message to the flusher if it is one of many; false when it is to be sent now.
bool StreamConnection::add_to_stream(Writer& message, bool& is_first) {
  const std::size_t size = message.size();
  const Time now = Clock::now();
  const Time last_here = std::exchange(last_streamed_here, now);
  const std::lock_guard lock(streaming_);
  const Time last = std::exchange(last_streamed_, now);
  is_first = streamed_size_ == 0;
  if (size > stream_chunk - streamed_size_) return false;
  if (is_first && (now - last_here > pause_between || now - last > pause_on_connection)) {
    return false;
  }
  gather(message);
  return true;
}

// Under streaming_, when there is room.
void StreamConnection::gather(Writer& message) {
  if (streamed_size_ == 0) streamed_ = allocate(stream_chunk);
  for (const Piece& piece : message.pieces()) {
    std::memcpy(streamed_.bytes + streamed_size_, piece.data, piece.size);
    streamed_size_ += piece.size;
  }
  streamed_bytes_.store(streamed_size_, std::memory_order_relaxed);
  if (tap_ != nullptr) tell_tap(true, message.pieces());
}

void StreamConnection::stream_or_queue(Writer& message) {
  if (is_closing_.load(std::memory_order_relaxed)) {
    throw Error(ErrorCode::connection_error, "the connection is closed");
  }
  // The other half is for answers.
  const std::size_t waiting = waiting_bytes();
  if (waiting != 0 && (waiting + message.size() > options_->send_queue_limit / 2 ||
                       is_over_.load(std::memory_order_relaxed))) {
    throw Error(ErrorCode::buffer_limit_violation,
                "the other side does not take packets as fast as they are sent");
  }
  bool is_first = false;
  if (add_to_stream(message, is_first)) {
    if (is_first) reactor_->flusher().add(shared_from_this());
    return;
  }
  const std::size_t size = message.size();
  bool has_rest = false;
  bool had_rest = false;
  bool is_broken = false;
  {
    const std::lock_guard lock(sending_);
    had_rest = has_unsent_;
    is_broken = !send_under_lock(
        message, {.now = coarse_now(), .refusal = ErrorCode::buffer_limit_violation}, has_rest);
  }
  if (size >= Writer::attach_threshold) message.reset(message.version());
  if (is_broken) {
    // What closes it may run what is left over, so not here, under the caller's lock.
    fail_later();
  } else if (has_rest && !had_rest) {
    reactor_->flusher().add(shared_from_this());  // sends it, or waits for room
  }
}

bool StreamConnection::wait_sent(std::size_t bytes, Time deadline) {
  if (waiting_bytes() <= bytes) return true;
  Reactor::about_to_wait();
  while (!is_closing_) {
    flush();
    if (waiting_bytes() <= bytes) return true;
    const Time now = Clock::now();
    if (now >= deadline) return false;
    const Time until = std::min(deadline, now + std::chrono::seconds(1));
    if (Carrier* const carrier = sending_carrier()) {
      carrier->wait_for_room(until);
    } else {
      wait_for(socket_.get(), POLLOUT, until);
    }
  }
  return false;
}

}  // namespace rr::channel
