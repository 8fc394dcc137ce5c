// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/subscription/waits.hpp"

#include <algorithm>
#include <atomic>
#include <exception>

#include "runtime/cpp/src/channel/reactor.hpp"
#include "runtime/cpp/src/channel/time.hpp"

namespace rr::subscription {

// A completion that waits. Whoever sets `is_done` completes it.
class Waits::Waiting final : public channel::Timer, public std::enable_shared_from_this<Waiting> {
 public:
  Waiting(std::shared_ptr<Waits> waits, const ObjectType* type,
          std::unique_ptr<Completion> completion)
      : waits_(std::move(waits)), type_(type), completion_(std::move(completion)) {}
  ~Waiting() { waits_->core_->reactor().cancel(*this); }

  void schedule(channel::Time deadline) {
    waits_->core_->reactor().schedule(*this, weak_from_this(), deadline);
  }
  void look_soon(bool is_over_time) {
    waits_->core_->reactor().post(
        [self = shared_from_this(), is_over_time] { self->look(is_over_time); });
  }

 private:
  void on_timer() override { look_soon(true); }

  void look(bool is_over_time) {
    std::shared_ptr<Stub> stub;
    std::exception_ptr error;
    try {
      stub = waits_->find(type_);
      if (!stub && waits_->has_ended()) {
        throw Error(ErrorCode::invalid_operation, "the subscription is closed");
      }
      if (!stub && is_over_time) {
        throw waits_->error_for(ErrorCode::operation_timeout, "no client in time");
      }
    } catch (const Error&) {
      error = std::current_exception();
    }
    if ((!stub && !error) || is_done_.exchange(true)) return;
    waits_->forget(*this);
    if (error) {
      completion_->fail(std::move(error));
    } else {
      *static_cast<std::shared_ptr<Stub>*>(completion_->result()) = std::move(stub);
      completion_->succeed();
    }
    completion_.reset();
  }

  const std::shared_ptr<Waits> waits_;
  const ObjectType* const type_;
  std::unique_ptr<Completion> completion_;
  std::atomic<bool> is_done_{false};
};

Error Waits::error_for(ErrorCode code, std::string text) const {
  if (const auto why = why_none()) text += ": " + std::string(why->what());
  return {code, std::move(text)};
}

std::shared_ptr<Stub> Waits::need(const ObjectType* type) {
  auto stub = find(type);
  if (!stub) throw error_for(ErrorCode::connection_error, "no client is connected");
  return stub;
}

std::shared_ptr<Stub> Waits::wait(const ObjectType* type, std::chrono::milliseconds limit) {
  const channel::Time deadline = channel::after(channel::Clock::now(), limit);
  std::uint64_t seen = 0;
  while (true) {
    {
      const MutexLock lock(waiting_mutex_);
      seen = changes_;
    }
    if (auto stub = find(type)) return stub;
    if (has_ended()) throw Error(ErrorCode::invalid_operation, "the subscription is closed");
    channel::Reactor::about_to_wait();
    MutexLock lock(waiting_mutex_);
    while (changes_ == seen && channel::Clock::now() < deadline) {
      channel::wait_until(waiting_changed_, waiting_mutex_, deadline);
    }
    if (changes_ != seen) continue;
    lock.unlock();
    throw error_for(ErrorCode::operation_timeout, "no client in time");
  }
}

void Waits::start_wait(const ObjectType* type, std::chrono::milliseconds limit,
                       std::unique_ptr<Completion> completion) {
  const auto waiting = std::make_shared<Waiting>(share(), type, std::move(completion));
  {
    const MutexLock lock(waiting_mutex_);
    waiting_.push_back(waiting);
  }
  waiting->schedule(channel::after(channel::Clock::now(), limit));
  waiting->look_soon(false);
}

void Waits::changed() {
  std::vector<std::shared_ptr<Waiting>> waiting;
  {
    const MutexLock lock(waiting_mutex_);
    ++changes_;
    waiting = waiting_;
  }
  waiting_changed_.notify_all();
  for (const auto& each : waiting) each->look_soon(false);
}

void Waits::forget(const Waiting& waiting) {
  const MutexLock lock(waiting_mutex_);
  std::erase_if(waiting_, [&](const auto& other) { return other.get() == &waiting; });
}

}  // namespace rr::subscription
