// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/channel/strand.hpp"

#include <array>
#include <cstring>
#include <new>

#include "rr/mutex.hpp"
#include "runtime/cpp/src/channel/strand_turn.hpp"
#include "runtime/cpp/src/channel/stream_sizes.hpp"

namespace rr::channel {

/// A thread that wants the strand back, on its stack.
struct Strand::Returning {
  Condition wake;
  Returning* next = nullptr;
};

std::span<const Transition<Strand::State>> Strand::transitions() {
  using enum State;
  static constexpr std::array<Transition<State>, 8> rows = {{
      {free, "enter", held},
      {free, "orphan", orphaned},
      {free, "step_in", held},
      {held, "finish, leave, step_out", free},
      {held, "orphan, step_out", orphaned},
      {held, "suspend", suspended},
      {orphaned, "adopt, step_in", held},
      {suspended, "resume", orphaned},
  }};
  return rows;
}

void Strand::become(State state) { change(state_, state, transitions()); }

bool Strand::enter() {
  if (is_taken() || queue_) return false;
  become(State::held);
  return true;
}

void Strand::orphan() {
  become(State::orphaned);
  if (returning_ != nullptr) returning_->wake.notify_one();
}

bool Strand::adopt() {
  if (!is_orphaned()) return false;
  become(State::held);
  return true;
}

bool Strand::finish() {
  queue_.reset();
  become(State::free);
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
  ++outside_;
  turn.set_held(false);
  push_rest(turn);
  const bool must_post = is_full_ || has_queued();
  if (must_post || returning_ != nullptr) {
    orphan();
  } else {
    become(State::free);
  }
  return must_post;
}

bool Strand::step_in(StrandTurn& turn, Mutex& mutex, Time deadline) {
  Returning self;
  Returning** link = &returning_;
  while (*link != nullptr) link = &(*link)->next;
  *link = &self;
  // Posted work may come too late, as when the node is shut down: then this thread is faster.
  const auto is_elsewhere = [this] { return state_ == State::held || state_ == State::suspended; };
  while (is_elsewhere() && Clock::now() < deadline) wait_until(self.wake, mutex, deadline);
  for (link = &returning_; *link != &self;) link = &(*link)->next;
  *link = self.next;
  if (is_elsewhere()) return false;
  become(State::held);
  --outside_;
  turn.set_held(true);
  return true;
}

// Suspending

bool Strand::suspend(StrandTurn& turn, Frame frame) {
  push_rest(turn);
  push_first(std::move(frame));
  turn.scratch().waiting.clear();
  if (std::exchange(suspension_, Suspension::no) == Suspension::resumed) return false;
  become(State::suspended);
  return true;
}

bool Strand::resume() {
  if (suspension_ == Suspension::begun) {
    suspension_ = Suspension::resumed;
    return false;
  }
  if (state_ != State::suspended) return false;
  orphan();
  return true;
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
