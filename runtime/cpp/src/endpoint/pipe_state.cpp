// SPDX-License-Identifier: Apache-2.0
// What arrives at one end of a pipe, and how it ends.
#include "runtime/cpp/src/endpoint/pipe_state.hpp"

#include <utility>

#include "rr/error.hpp"

namespace rr {
namespace {

constexpr std::size_t queue_packets = 65'536;
constexpr std::size_t queue_bytes = std::size_t{64} * 1024 * 1024;
// Packets that have come before earlier ones. Nobody sends them so on purpose.
constexpr std::size_t held_packets = 1024;
constexpr std::size_t held_bytes = std::size_t{16} * 1024 * 1024;

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

PipeEnd::State::State(std::shared_ptr<const endpoint::Core> core,
                      std::shared_ptr<endpoint::PipeSide> side, Identity what)
    : identity(std::move(what)),
      core_(std::move(core)),
      index_text_(std::to_string(identity.index)),
      side_(std::move(side)),
      limit_(queue_packets),
      byte_limit_(queue_bytes) {}

bool PipeEnd::State::may_receive() const {
  return (identity.member->access & (identity.is_client ? writeonly : readonly)) == 0;
}

bool PipeEnd::State::accept(std::uint32_t number, std::shared_ptr<void> value, std::size_t size) {
  bool has_room = true;
  bool is_awaited = false;
  {
    const std::lock_guard lock(mutex_);
    if (is_closed_) return true;
    is_awaited = waiting_ != 0;
    Packet packet{std::move(value), size};
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
        has_room = push(std::move(next->second)) && has_room;
        held_.erase(next);
      }
    }
  }
  if (is_awaited) arrived_.notify_one();
  return has_room;
}

// Under mutex_. Numbers that have passed already come from a sender that counts wrong.
bool PipeEnd::State::hold_back(std::uint32_t number, Packet packet) {
  if (static_cast<std::int32_t>(number - expected_) < 0) return true;
  if (held_.size() >= held_packets || held_bytes_ + packet.size > held_bytes) return false;
  const std::size_t size = packet.size;
  if (held_.emplace(number, std::move(packet)).second) held_bytes_ += size;
  return true;
}

// Under mutex_.
bool PipeEnd::State::push(Packet packet) {
  while (!queue_.empty() && (queue_.size() >= limit_ || queue_bytes_ + packet.size > byte_limit_)) {
    if (when_full_ == WhenFull::close) return false;
    ++lost_;
    if (when_full_ == WhenFull::drop_newest) return true;
    pop();
  }
  queue_bytes_ += packet.size;
  queue_.push_back(std::move(packet));
  return true;
}

// Under mutex_.
PipeEnd::State::Packet PipeEnd::State::pop() {
  Packet packet = std::move(queue_.front());
  queue_.pop_front();
  queue_bytes_ -= packet.size;
  return packet;
}

void PipeEnd::State::deliver() {
  std::unique_lock lock(mutex_);
  if (std::exchange(is_delivering_, true)) return;
  while (deliver_one(lock)) {
  }
  is_delivering_ = false;
}

// Under the lock, which is given up meanwhile. False when there is nothing to be done.
bool PipeEnd::State::deliver_one(std::unique_lock<std::mutex>& lock) {
  if (receiver_ && !receiver_->is_connected()) {
    const auto ended = std::exchange(receiver_, nullptr);
    lock.unlock();
  } else if (!completions_.empty() && (!queue_.empty() || is_closed_)) {
    const std::unique_ptr<Completion> completion = std::move(completions_.front());
    completions_.pop_front();
    std::shared_ptr<void> value = queue_.empty() ? nullptr : pop().value;
    lock.unlock();
    call([&] {
      if (value) {
        *static_cast<std::shared_ptr<void>*>(completion->result()) = std::move(value);
        completion->succeed();
      } else {
        completion->fail(std::make_exception_ptr(closed_error()));
      }
    });
  } else if (receiver_ && !queue_.empty()) {
    const auto receiver = receiver_;
    std::shared_ptr<void> value = pop().value;
    lock.unlock();
    call([&] { receiver->receive(std::move(value)); });
  } else if (is_closed_ && (receiver_ || closed_function_)) {
    const auto ended = std::exchange(receiver_, nullptr);
    const auto closed = std::exchange(closed_function_, nullptr);
    lock.unlock();
    if (closed) call(closed);
  } else {
    return false;
  }
  lock.lock();
  return true;
}

void PipeEnd::State::tell_thrown(const char* what) const {
  core_->log(LogLevel::error, "a function of the pipe `" + std::string(identity.member->name) +
                                  "` has thrown: " + what);
}

void PipeEnd::State::deliver_soon() {
  core_->reactor().post([self = shared_from_this()] { self->deliver(); });
}

std::shared_ptr<void> PipeEnd::State::take() {
  const std::lock_guard lock(mutex_);
  return queue_.empty() ? nullptr : pop().value;
}

std::shared_ptr<const void> PipeEnd::State::peek() const {
  const std::lock_guard lock(mutex_);
  return queue_.empty() ? nullptr : queue_.front().value;
}

bool PipeEnd::State::wait(std::chrono::milliseconds limit) {
  const channel::Time deadline = channel::after(channel::Clock::now(), limit);
  std::unique_lock lock(mutex_);
  if (queue_.empty() && !is_closed_) {
    const auto side = side_;
    lock.unlock();
    side->connection().expect();  // no caller will read it
    channel::Reactor::about_to_wait();
    lock.lock();
  }
  ++waiting_;
  while (queue_.empty() && !is_closed_ && channel::Clock::now() < deadline) {
    channel::wait_until(arrived_, lock, deadline);
  }
  --waiting_;
  return !queue_.empty();
}

std::size_t PipeEnd::State::available() const {
  const std::lock_guard lock(mutex_);
  return queue_.size();
}

std::size_t PipeEnd::State::lost_count() const {
  const std::lock_guard lock(mutex_);
  return lost_;
}

void PipeEnd::State::set_queue_limit(std::size_t packets, WhenFull when_full, std::size_t bytes) {
  const std::lock_guard lock(mutex_);
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
    const std::lock_guard lock(mutex_);
    receiver_.swap(before);
    has_more = !queue_.empty();
    side = side_;
  }
  if (has_more) deliver_soon();
  if (side) side->connection().expect();
  return Subscription(std::move(receiver));
}

void PipeEnd::State::start_receive(std::unique_ptr<Completion> completion) {
  bool is_due = false;
  std::shared_ptr<endpoint::PipeSide> side;
  {
    const std::lock_guard lock(mutex_);
    completions_.push_back(std::move(completion));
    is_due = !queue_.empty() || is_closed_;
    side = side_;
  }
  if (is_due) deliver_soon();
  if (side) side->connection().expect();
}

void PipeEnd::State::on_closed(Function<void()> function) {
  {
    const std::lock_guard lock(mutex_);
    std::swap(closed_function_, function);  // the old one goes without the lock
    if (!is_closed_) return;
  }
  deliver_soon();
}

bool PipeEnd::State::finish() {
  std::shared_ptr<endpoint::PipeSide> side;
  std::map<std::uint32_t, Packet> held;
  {
    const std::scoped_lock lock(sending_, mutex_);
    if (is_closed_) return false;
    is_closed_ = true;
    side = std::move(side_);
    held.swap(held_);
  }
  arrived_.notify_all();
  deliver_soon();
  return true;
}

std::shared_ptr<endpoint::PipeSide> PipeEnd::State::side() const {
  const std::lock_guard lock(mutex_);
  return side_;
}

}  // namespace rr
