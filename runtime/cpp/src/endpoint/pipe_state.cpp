// SPDX-License-Identifier: Apache-2.0
// What arrives at one end of a pipe, and how it ends.
#include "runtime/cpp/src/endpoint/pipe_state.hpp"

#include <algorithm>
#include <optional>
#include <stop_token>
#include <utility>

#include "rr/error.hpp"
#include "runtime/cpp/src/endpoint/call_terms.hpp"

namespace rr {
namespace {

constexpr std::size_t queue_packets = 65'536;
constexpr std::size_t queue_bytes = std::size_t{64} * 1024 * 1024;
// Packets that have come before earlier ones. Nobody sends them so on purpose.
constexpr std::size_t held_packets = 1024;
constexpr std::size_t held_bytes = std::size_t{16} * 1024 * 1024;
// What a packet takes besides its bytes, about; and how much is drawn at a time.
constexpr std::size_t packet_cost = 128;
constexpr std::size_t quantum = 1024;

Error closed_error() { return {ErrorCode::invalid_operation, "the pipe endpoint is closed"}; }

}  // namespace

// A function that gets packets.
class PipeEnd::State::Receiver final : public Subscription::Handler {
 public:
  explicit Receiver(Function<void(std::shared_ptr<void>)> function)
      : function_(std::move(function)) {}
  void receive(std::shared_ptr<void> packet) {
    run([&] { function_(std::move(packet)); });
  }

 private:
  void drop() override { function_ = nullptr; }

  Function<void(std::shared_ptr<void>)> function_;
};

// A completion that waits for a packet. Whoever takes it out of the queue ends it.
class PipeEnd::State::Waiting final : public channel::Timer,
                                      public std::enable_shared_from_this<Waiting> {
 public:
  Waiting(std::shared_ptr<const endpoint::Core> core, std::weak_ptr<State> end,
          std::unique_ptr<Completion> completion)
      : core_(std::move(core)), end_(std::move(end)), completion_(std::move(completion)) {}
  ~Waiting() { core_->reactor().cancel(*this); }

  // Before it is in the queue.
  void heed(const std::stop_token& stop) {
    if (stop.stop_possible()) stopped_by_.emplace(stop, Stop{weak_from_this()});
  }
  void expire_at(channel::Time deadline) {
    if (deadline != channel::never) core_->reactor().schedule(*this, weak_from_this(), deadline);
  }
  // It is in no queue any more, and nothing but its completion follows.
  void leave() {
    stopped_by_.reset();
    core_->reactor().cancel(*this);
  }
  [[nodiscard]] Completion& completion() const { return *completion_; }

  ErrorCode ended_by = ErrorCode::none;  // by time-out or stop; under the lock of the end

 private:
  struct Stop {
    std::weak_ptr<Waiting> waiting;
    void operator()() const {
      if (const auto ended = waiting.lock()) ended->end_by(ErrorCode::operation_cancelled);
    }
  };
  void on_timer() override { end_by(ErrorCode::request_timeout); }
  void end_by(ErrorCode code) {
    if (const auto end = end_.lock()) end->end_receive(*this, code);
  }

  const std::shared_ptr<const endpoint::Core> core_;
  const std::weak_ptr<State> end_;
  const std::unique_ptr<Completion> completion_;
  std::optional<std::stop_callback<Stop>> stopped_by_;
};

PipeEnd::State::State(std::shared_ptr<const endpoint::Core> core,
                      std::shared_ptr<endpoint::PipeSide> side, Identity what)
    : identity(std::move(what)),
      core_(std::move(core)),
      index_text_(std::to_string(identity.index)),
      threads_(side ? side->connection().threads() : nullptr),
      side_(std::move(side)),
      charge_(side_->connection().account()),
      limit_(queue_packets),
      byte_limit_(queue_bytes) {}

[[gnu::hot]] bool PipeEnd::State::may_receive() const {
  return (identity.member->access & (identity.is_client ? writeonly : readonly)) == 0;
}

[[gnu::hot]] bool PipeEnd::State::accept(std::uint32_t number, std::shared_ptr<void> value,
                                         std::size_t size, std::size_t memory) {
  bool has_room = true;
  bool is_awaited = false;
  {
    const MutexLock lock(mutex_);
    if (is_closed_) return true;
    is_awaited = waiting_ != 0;
    Packet packet{std::move(value), size, packet_cost + size + memory};
    if (identity.is_unreliable) {
      has_room = push(std::move(packet));
    } else if (number != expected_) {
      return hold_back(number, std::move(packet));
    } else {
      ++expected_;
      has_room = push(std::move(packet));
      while (!held_.empty()) {
        const auto next = held_.find(expected_);
        if (next == held_.end()) break;
        ++expected_;
        held_bytes_ -= next->second.size;
        give_back(next->second.cost);  // the queue draws again
        has_room = push(std::move(next->second)) && has_room;
        held_.erase(next);
      }
    }
  }
  if (is_awaited) arrived_.notify_all();  // a packet is there for all until one takes it
  return has_room;
}

// Numbers that have passed already come from a sender that counts wrong.
bool PipeEnd::State::hold_back(std::uint32_t number, Packet packet) {
  if (static_cast<std::int32_t>(number - expected_) < 0) return true;
  if (held_.size() >= held_packets || held_bytes_ + packet.size > held_bytes) return false;
  if (held_.contains(number)) return true;
  if (!draw(packet.cost)) return false;
  held_bytes_ += packet.size;
  held_.emplace(number, std::move(packet));
  return true;
}

[[gnu::hot]] bool PipeEnd::State::push(Packet packet) {
  while (true) {
    const bool is_full =
        !queue_.empty() && (queue_.size() >= limit_ || queue_bytes_ + packet.size > byte_limit_);
    if (!is_full && draw(packet.cost)) break;
    if (when_full_ == WhenFull::close) return false;
    ++lost_;
    if (when_full_ == WhenFull::drop_newest || queue_.empty()) return true;
    pop();
  }
  queue_bytes_ += packet.size;
  queue_.push_back(std::move(packet));
  return true;
}

[[gnu::hot]] PipeEnd::State::Packet PipeEnd::State::pop() {
  Packet packet = std::move(queue_.front());
  queue_.pop_front();
  queue_bytes_ -= packet.size;
  give_back(packet.cost);
  return packet;
}

// False when the other side makes this one hold too much.
[[gnu::hot]] bool PipeEnd::State::draw(std::size_t cost) {
  if (cost_ + cost > charge_.bytes()) {
    const std::size_t more = cost_ + cost - charge_.bytes();
    if (!charge_.add(more + quantum) && !charge_.add(more)) return false;
  }
  cost_ += cost;
  return true;
}

// A little stays drawn, for the packet that comes next.
[[gnu::hot]] void PipeEnd::State::give_back(std::size_t cost) {
  cost_ -= cost;
  if (charge_.bytes() > cost_ + 2 * quantum) charge_.reduce(charge_.bytes() - cost_ - quantum);
}

[[gnu::hot]] void PipeEnd::State::deliver() {
  const MutexLock lock(mutex_);
  if (std::exchange(is_delivering_, true)) return;
  while (deliver_one()) {
  }
  is_delivering_ = false;
}

// The lock is given up meanwhile. False when there is nothing to be done. What the functions below
// get is theirs, so that its last owner is never one with the lock.
[[gnu::hot]] bool PipeEnd::State::deliver_one() {
  if (receiver_ && !receiver_->is_connected()) {
    auto ended = std::exchange(receiver_, nullptr);
    const MutexUnlock unlock(mutex_);
    ended.reset();
  } else if (!waitings_.empty() && (!queue_.empty() || is_closed_)) {
    std::shared_ptr<Waiting> waiting = std::move(waitings_.front());
    waitings_.pop_front();
    std::shared_ptr<void> value = queue_.empty() ? nullptr : pop().value;
    const MutexUnlock unlock(mutex_);
    complete(std::move(waiting), std::move(value));
  } else if (receiver_ && !queue_.empty()) {
    auto receiver = receiver_;
    std::shared_ptr<void> value = pop().value;
    const MutexUnlock unlock(mutex_);
    hand_to(std::move(receiver), std::move(value));
  } else if (is_closed_ && (receiver_ || closed_function_)) {
    auto ended = std::exchange(receiver_, nullptr);
    auto closed = std::exchange(closed_function_, nullptr);
    const MutexUnlock unlock(mutex_);
    tell_closed(std::move(ended), std::move(closed));
  } else {
    return false;
  }
  return true;
}

void PipeEnd::State::complete(std::shared_ptr<Waiting> waiting, std::shared_ptr<void> value) const {
  waiting->leave();
  call([&] {
    Completion& completion = waiting->completion();
    if (value) {
      *static_cast<std::shared_ptr<void>*>(completion.result()) = std::move(value);
      completion.succeed();
    } else {
      completion.fail(std::make_exception_ptr(closed_error()));
    }
  });
}

[[gnu::hot]] void PipeEnd::State::hand_to(std::shared_ptr<Receiver> receiver,
                                          std::shared_ptr<void> value) const {
  call([&] { receiver->receive(std::move(value)); });
}

void PipeEnd::State::tell_closed(std::shared_ptr<Receiver> /*receiver*/,
                                 Function<void()> function) const {
  if (function) call(function);
}

void PipeEnd::State::deliver_soon() {
  core_->reactor().post([self = shared_from_this()] { self->deliver(); }, threads_);
}

std::shared_ptr<void> PipeEnd::State::take() {
  const MutexLock lock(mutex_);
  return queue_.empty() ? nullptr : pop().value;
}

std::shared_ptr<const void> PipeEnd::State::peek() const {
  const MutexLock lock(mutex_);
  return queue_.empty() ? nullptr : queue_.front().value;
}

bool PipeEnd::State::wait(std::chrono::milliseconds limit) {
  const channel::Time deadline = channel::after(channel::Clock::now(), limit);
  MutexLock lock(mutex_);
  if (queue_.empty() && !is_closed_) {
    const auto side = side_;
    lock.unlock();
    side->connection().expect();  // no caller will read it
    channel::Reactor::about_to_wait();
    lock.lock();
  }
  ++waiting_;
  while (queue_.empty() && !is_closed_ && channel::Clock::now() < deadline) {
    channel::wait_until(arrived_, mutex_, deadline);
  }
  --waiting_;
  return !queue_.empty();
}

std::size_t PipeEnd::State::available() const {
  const MutexLock lock(mutex_);
  return queue_.size();
}

std::size_t PipeEnd::State::lost_count() const {
  const MutexLock lock(mutex_);
  return lost_;
}

void PipeEnd::State::set_queue_limit(std::size_t packets, WhenFull when_full, std::size_t bytes) {
  const MutexLock lock(mutex_);
  limit_ = packets;
  byte_limit_ = bytes;
  when_full_ = when_full;
}

Subscription PipeEnd::State::on_received(Function<void(std::shared_ptr<void>)> function) {
  auto receiver = std::make_shared<Receiver>(std::move(function));
  bool has_more = false;
  std::shared_ptr<Receiver> before = receiver;
  std::shared_ptr<endpoint::PipeSide> side;
  {
    const MutexLock lock(mutex_);
    receiver_.swap(before);
    has_more = !queue_.empty();
    side = side_;
  }
  if (has_more) deliver_soon();
  if (side) side->connection().expect();
  return Subscription(std::move(receiver));
}

// Its end may come before the completion is in the queue, which then it never is.
void PipeEnd::State::start_receive(std::unique_ptr<Completion> completion) {
  const CallTerms terms = CallTerms::of_started_call();
  const auto waiting = std::make_shared<Waiting>(core_, weak_from_this(), std::move(completion));
  waiting->heed(terms.stop);
  if (terms.timeout.count() > 0) {
    waiting->expire_at(channel::after(channel::coarse_now(), terms.timeout));
  }
  bool is_due = false;
  bool has_ended = false;
  std::shared_ptr<endpoint::PipeSide> side;
  {
    const MutexLock lock(mutex_);
    has_ended = waiting->ended_by != ErrorCode::none;
    if (!has_ended) waitings_.push_back(waiting);
    is_due = !has_ended && (!queue_.empty() || is_closed_);
    side = side_;
  }
  if (has_ended) fail_receive(waiting);
  if (is_due) deliver_soon();
  if (side) side->connection().expect();
}

void PipeEnd::State::end_receive(Waiting& waiting, ErrorCode code) {
  std::shared_ptr<Waiting> found;
  {
    const MutexLock lock(mutex_);
    if (waiting.ended_by != ErrorCode::none) return;
    waiting.ended_by = code;
    const auto place =
        std::ranges::find_if(waitings_, [&](const auto& item) { return item.get() == &waiting; });
    if (place == waitings_.end()) return;  // it has its packet, or is not there yet
    found = std::move(*place);
    waitings_.erase(place);
  }
  fail_receive(found);
}

void PipeEnd::State::fail_receive(const std::shared_ptr<Waiting>& waiting) {
  core_->reactor().post(
      [self = shared_from_this(), waiting] {
        waiting->leave();
        const bool is_late = waiting->ended_by == ErrorCode::request_timeout;
        self->call([&] {
          waiting->completion().fail(std::make_exception_ptr(Error(
              waiting->ended_by, is_late ? "no packet in time" : "the receive was cancelled")));
        });
      },
      threads_);
}

void PipeEnd::State::on_closed(Function<void()> function) {
  {
    const MutexLock lock(mutex_);
    std::swap(closed_function_, function);  // the old one goes without the lock
    if (!is_closed_) return;
  }
  deliver_soon();
}

bool PipeEnd::State::finish() {
  std::shared_ptr<endpoint::PipeSide> side;
  std::map<std::uint32_t, Packet> held;
  {
    const MutexLock sending(sending_);
    const MutexLock lock(mutex_);
    if (is_closed_) return false;
    is_closed_ = true;
    side = std::move(side_);
    held.swap(held_);
    for (const auto& [number, packet] : held) give_back(packet.cost);
    held_bytes_ = 0;
  }
  arrived_.notify_all();
  deliver_soon();
  return true;
}

[[gnu::hot]] std::shared_ptr<endpoint::PipeSide> PipeEnd::State::side() const {
  const MutexLock lock(mutex_);
  return side_;
}

}  // namespace rr
