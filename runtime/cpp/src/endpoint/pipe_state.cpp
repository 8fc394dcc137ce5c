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
      name_(identity.member->name),
      access_(identity.member->access),
      threads_(side ? side->connection().threads() : nullptr),
      side_(std::move(side)),
      has_numbers_(!identity.is_unreliable),
      packets_(side_->connection().account()) {}

[[gnu::hot]] bool PipeEnd::State::may_receive() const {
  return (access_ & (identity.is_client ? writeonly : readonly)) == 0;
}

[[gnu::hot]] bool PipeEnd::State::accept(std::uint32_t number, std::shared_ptr<void> value,
                                         std::size_t size, std::size_t memory) {
  bool has_room = true;
  bool is_awaited = false;
  {
    const MutexLock lock(mutex_);
    if (is_closed_) return true;
    is_awaited = waiting_ != 0;
    has_room = has_numbers_ ? packets_.add_numbered(number, std::move(value), size, memory)
                            : packets_.add(std::move(value), size, memory);
  }
  if (is_awaited) arrived_.notify_all();  // a packet is there for all until one takes it
  return has_room;
}

void PipeEnd::State::use_numbers() {
  const MutexLock lock(mutex_);
  has_numbers_ = true;
}

bool PipeEnd::State::has_come_up_to(std::uint32_t number) const {
  const MutexLock lock(mutex_);
  return static_cast<std::int32_t>(packets_.expected() - number) >= 0;
}

bool PipeEnd::State::is_listening() const {
  const MutexLock lock(mutex_);
  return waiting_ != 0 || receiver_ != nullptr || !waitings_.empty();
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
  } else if (!waitings_.empty() && (!packets_.empty() || is_closed_)) {
    std::shared_ptr<Waiting> waiting = std::move(waitings_.front());
    waitings_.pop_front();
    std::shared_ptr<void> value = packets_.empty() ? nullptr : packets_.pop();
    const MutexUnlock unlock(mutex_);
    complete(std::move(waiting), std::move(value));
  } else if (receiver_ && !packets_.empty()) {
    auto receiver = receiver_;
    std::shared_ptr<void> value = packets_.pop();
    const MutexUnlock unlock(mutex_);
    hand_to(std::move(receiver), std::move(value));
  } else if (is_closed_ && (receiver_ || closed_function_ || acknowledged_function_)) {
    auto ended = std::exchange(receiver_, nullptr);
    auto acknowledged = std::exchange(acknowledged_function_, nullptr);
    auto closed = std::exchange(closed_function_, nullptr);
    const MutexUnlock unlock(mutex_);
    acknowledged = nullptr;
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

// Both end here, without the lock.
// NOLINTBEGIN(performance-unnecessary-value-param)
void PipeEnd::State::tell_closed(std::shared_ptr<Receiver> /*receiver*/,
                                 Function<void()> function) const {
  if (function) call(function);
}
// NOLINTEND(performance-unnecessary-value-param)

void PipeEnd::State::deliver_soon() {
  core_->reactor().post([self = shared_from_this()] { self->deliver(); }, threads_);
}

std::shared_ptr<void> PipeEnd::State::take() {
  look();
  const MutexLock lock(mutex_);
  return packets_.empty() ? nullptr : packets_.pop();
}

std::shared_ptr<const void> PipeEnd::State::peek() {
  look();
  const MutexLock lock(mutex_);
  return packets_.empty() ? nullptr : packets_.front();
}

bool PipeEnd::State::wait(std::chrono::milliseconds limit) {
  const channel::Time deadline = channel::after(channel::Clock::now(), limit);
  look();
  MutexLock lock(mutex_);
  ++waiting_;
  if (packets_.empty() && !is_closed_) {
    const auto side = side_;
    lock.unlock();
    listen();
    side->connection().expect();  // no caller will read it
    channel::Reactor::about_to_wait();
    lock.lock();
  }
  while (packets_.empty() && !is_closed_ && channel::Clock::now() < deadline) {
    channel::wait_until(arrived_, mutex_, deadline);
  }
  --waiting_;
  return !packets_.empty();
}

std::size_t PipeEnd::State::available() {
  look();
  const MutexLock lock(mutex_);
  return packets_.size();
}

std::size_t PipeEnd::State::lost_count() const {
  const MutexLock lock(mutex_);
  return packets_.lost_count();
}

void PipeEnd::State::set_queue_limit(std::size_t packets, WhenFull when_full, std::size_t bytes) {
  const MutexLock lock(mutex_);
  packets_.set_limit(packets, when_full, bytes);
}

Subscription PipeEnd::State::on_received(Function<void(std::shared_ptr<void>)> function) {
  auto receiver = std::make_shared<Receiver>(std::move(function));
  bool has_more = false;
  std::shared_ptr<Receiver> before = receiver;
  std::shared_ptr<endpoint::PipeSide> side;
  {
    const MutexLock lock(mutex_);
    receiver_.swap(before);
    has_more = !packets_.empty() || is_closed_;  // after the end it goes, with what it holds
    side = side_;
  }
  if (has_more) deliver_soon();
  if (side) {
    listen();
    side->connection().expect();
  }
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
    is_due = !has_ended && (!packets_.empty() || is_closed_);
    side = side_;
  }
  if (has_ended) fail_receive(waiting);
  if (is_due) deliver_soon();
  if (side) {
    listen();
    side->connection().expect();
  }
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
  endpoint::ReceivedPackets::Held held;  // goes without a lock
  {
    const MutexLock sending(sending_);
    const MutexLock lock(mutex_);
    if (is_closed_) return false;
    is_closed_ = true;
    side = std::move(side_);
    held = packets_.drop_held();
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
