// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/channel/strand.hpp"

#include <cstring>
#include <new>

#include "runtime/cpp/src/channel/strand_turn.hpp"
#include "runtime/cpp/src/channel/stream_sizes.hpp"

namespace rr::channel {

bool Strand::finish() {
  queue_.reset();
  state_.set_free();
  return std::exchange(is_full_, false);
}

// The queue

std::deque<Frame>& Strand::queue() {
  if (!queue_) queue_ = std::make_unique<std::deque<Frame>>();
  return *queue_;
}

[[gnu::hot]] bool Strand::put(Frame frame, bool is_first) {
  const std::size_t size = frame.bytes.size();
  try {
    Frame kept = keep(std::move(frame));
    if (is_first) {
      queue().push_front(std::move(kept));
    } else {
      queue().push_back(std::move(kept));
    }
  } catch (const std::bad_alloc&) {
    has_lost_ = true;
    return false;
  }
  queued_bytes_ += size;
  return true;
}

[[gnu::hot]] void Strand::push(Frame frame) {
  if (put(std::move(frame), false)) charge(queue_->back());
}

void Strand::push_first(Frame frame) {
  if (put(std::move(frame), true)) charge(queue_->front());
}

Frame Strand::pop() {
  Frame frame = std::move(queue_->front());
  queue_->pop_front();
  queued_bytes_ -= frame.bytes.size();
  return frame;
}

std::unique_ptr<std::deque<Frame>> Strand::take_queue() {
  queued_bytes_ = 0;
  return std::exchange(queue_, nullptr);
}

// What waits is its sender's, who is not read further when it is too much.
[[gnu::hot]] void Strand::charge(Frame& frame) {
  if (account_ == nullptr || frame.charge.bytes() != 0) return;
  const std::size_t size = frame.bytes.size() + bytes_beside_frame;
  frame.charge = Charge(account_);
  if (frame.charge.add(size)) return;
  frame.charge.add_anyway(size);
  is_full_ = true;
}

Frame Strand::keep(Frame frame) {
  if (frame.owner) return frame;
  Allocation memory = allocate(frame.bytes.size());
  std::memcpy(memory.bytes, frame.bytes.data(), frame.bytes.size());
  return {{memory.bytes, frame.bytes.size()}, std::move(memory.owner), {}};
}

void Strand::push_rest(StrandTurn& turn) {
  while (turn.has_next()) push_first(turn.take_last());
  check_limit();
}

// Waiting inside a handler

bool Strand::step_out(StrandTurn& turn) {
  state_.go_outside();
  turn.set_held(false);
  push_rest(turn);
  const bool must_post = is_full_ || has_queued();
  state_.give_up(must_post);
  return must_post;
}

bool Strand::step_in(StrandTurn& turn, Mutex& mutex, Time deadline) {
  if (!state_.step_in(mutex, deadline)) return false;
  turn.set_held(true);
  return true;
}

// Suspending

bool Strand::suspend(StrandTurn& turn, Frame frame) {
  push_rest(turn);
  push_first(std::move(frame));
  turn.scratch().waiting.clear();
  return state_.suspend();
}

// A thread's turn

constinit thread_local StrandTurn* StrandTurn::innermost = nullptr;

StrandTurn::StrandTurn(const Strand& strand, Scratch& scratch, std::chrono::microseconds longest)
    : strand_(&strand),
      scratch_(scratch),
      longest_(longest),
      outer_(std::exchange(innermost, this)) {}

StrandTurn::~StrandTurn() { innermost = outer_; }

}  // namespace rr::channel
