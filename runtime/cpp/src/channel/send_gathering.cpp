// SPDX-License-Identifier: Apache-2.0
// What a send queue gathers for some microseconds, so that it leaves in one system call.
#include <algorithm>
#include <cstring>
#include <thread>
#include <utility>

#include "runtime/cpp/src/channel/connection_tap.hpp"
#include "runtime/cpp/src/channel/send_queue.hpp"
#include "runtime/cpp/src/channel/stream_sizes.hpp"

namespace rr::channel {
namespace {

// A thread sends without a pause when it has begun to send another message this little before, to
// whomever, and one on the same connection not long before that. Paced senders, of one packet at a
// time to many connections too, are therefore never held back.
constexpr std::chrono::microseconds pause_between{20};
constexpr std::chrono::microseconds pause_on_connection{200};

thread_local Time last_streamed_here{};

}  // namespace

void SendQueue::check_room_for_packet(std::size_t size) const {
  // The other half is for answers.
  const std::size_t waiting = waiting_bytes();
  if (waiting != 0 &&
      (waiting + size > terms_.limit / 2 || is_over_.load(std::memory_order_relaxed))) {
    throw Error(ErrorCode::buffer_limit_violation,
                "the other side does not take packets as fast as they are sent");
  }
}

SendQueue::Sent SendQueue::stream(Writer& message) {
  bool is_first = false;
  if (gather_if_streaming(message, is_first)) return is_first ? Sent::first : Sent::taken;
  return send(message, {.now = coarse_now(),
                        .refusal = ErrorCode::buffer_limit_violation,
                        .is_packet = terms_.is_server});
}

[[gnu::hot]] bool SendQueue::gather_if_streaming(Writer& message, bool& is_first) {
  const std::size_t size = message.size();
  const Time now = Clock::now();
  const Time last_here = std::exchange(last_streamed_here, now);
  const MutexLock lock(gathering_);
  const Time last = std::exchange(last_streamed_, now);
  is_first = gathered_size_ == 0;
  if (size > stream_chunk - gathered_size_) return false;
  if (is_first && (now - last_here > pause_between || now - last > pause_on_connection)) {
    return false;
  }
  gather(message);
  if (terms_.is_server) gathered_packets_.add(1);
  return true;
}

// Only the first looks whether it may wait.
SendQueue::Corked SendQueue::cork(Writer& message, unsigned expected) {
  if (message.size() >= Writer::attach_threshold || is_closed()) return Corked::no;
  const MutexLock lock(gathering_);
  if (message.size() > stream_chunk - gathered_size_) return Corked::no;
  if (!is_corked_) {
    if (expected == 0 || has_unsent_ || Clock::now() < crowded_until_) return Corked::no;
    missing_ = (expected + 1) / 2;
  } else if (missing_ != 0 && --missing_ == 0) {
    return Corked::no;  // with what the others have left
  }
  gather(message);
  return std::exchange(is_corked_, true) ? Corked::joined : Corked::first;
}

// Those expected are ready to run, maybe on this thread's processor. It is not given up for a while
// where something else has kept it for long.
void SendQueue::uncork(const std::atomic<unsigned>& expected) {
  constexpr Milliseconds long_turn{1};
  constexpr Milliseconds crowded_for{50};
  Time before = Clock::now();
  std::size_t gathered = 0;
  while (expected.load(std::memory_order_relaxed) != 0) {
    const std::size_t now_gathered = gathered_bytes_.load(std::memory_order_relaxed);
    if (now_gathered == gathered) break;  // nobody has come
    gathered = now_gathered;
    std::this_thread::yield();
    const Time now = Clock::now();
    if (now - before > long_turn) crowded_until_ = now + crowded_for;
    before = now;
  }
  const MutexLock lock(gathering_);
  is_corked_ = false;
}

// When there is room.
[[gnu::hot]] void SendQueue::gather(Writer& message) {
  if (gathered_size_ == 0) gathered_ = allocate(stream_chunk);
  for (const Piece& piece : message.pieces()) {
    std::memcpy(gathered_.bytes + gathered_size_, piece.data, piece.size);
    gathered_size_ += piece.size;
  }
  gathered_bytes_.store(gathered_size_, std::memory_order_relaxed);
  gathered_messages_.add(1);
  all_gathered_bytes_.add(message.size());
  if (tap_.is_open()) tap_.sent(message.pieces());
}

// What was gathered is next.
[[gnu::hot]] void SendQueue::take_gathered() {
  if (!has_gathered()) return;
  const MutexLock lock(gathering_);
  move_gathered();
}

void SendQueue::move_gathered() {
  Allocation memory = std::exchange(gathered_, {});
  const std::size_t size = std::exchange(gathered_size_, 0);
  gathered_bytes_.store(0, std::memory_order_relaxed);
  if (size != 0) outbox_.add(std::move(memory), size);
  note_waiting();
}

// What was gathered goes first, and nothing comes in between: the tap is told of
// messages in the order in which they leave.
std::uint64_t SendQueue::take_gathered_and_tell(Writer& message) {
  const MutexLock lock(gathering_);
  move_gathered();
  return tap_.sent(message.pieces());
}

}  // namespace rr::channel
