// SPDX-License-Identifier: Apache-2.0
// What a send queue gathers for some microseconds, so that it leaves in one system call. How
// several callers do it is in gathering_steps.hpp.
#include <algorithm>
#include <utility>

#include "runtime/cpp/src/channel/connection_tap.hpp"
#include "runtime/cpp/src/channel/send_queue.hpp"

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
  const Time now = Clock::now();
  const Time last_here = std::exchange(last_streamed_here, now);
  const MutexLock lock(gathering_);
  const Time last = std::exchange(last_streamed_, now);
  is_first = gathered_.empty();
  if (!has_room_for(message)) return false;
  if (is_first && (now - last_here > pause_between || now - last > pause_on_connection)) {
    return false;
  }
  gather(message);
  if (terms_.is_server) gathered_.note_packet();
  return true;
}

Corked SendQueue::cork(Writer& message, unsigned expected) {
  if (message.size() >= Writer::attach_threshold || is_closed_) return Corked::no;
  return GatheringSteps<SendQueue>::cork(*this, message, expected);
}

void SendQueue::uncork(const std::atomic<unsigned>& expected) {
  GatheringSteps<SendQueue>::uncork(*this, expected);
}

bool SendQueue::has_room_for(const Writer& message) const {
  return gathered_.has_room_for(message.size());
}

// When there is room.
[[gnu::hot]] void SendQueue::gather(Writer& message) {
  gathered_.add(message);
  if (tap_.is_open()) tap_.sent(message.pieces());
}

[[gnu::hot]] void SendQueue::take_gathered() { GatheringSteps<SendQueue>::take_gathered(*this); }

void SendQueue::move_gathered() {
  GatheredMessages::Taken taken = gathered_.take();
  if (taken.size != 0) outbox_.add(std::move(taken.memory), taken.size);
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
