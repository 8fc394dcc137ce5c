// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/service/monitors.hpp"

#include <algorithm>
#include <utility>

#include "runtime/cpp/src/endpoint/errors.hpp"
#include "runtime/cpp/src/endpoint/user_code.hpp"

namespace rr::service {
namespace {

// A client that waits is told to wait on after this time (07, section 6).
constexpr channel::Milliseconds step_time{5'000};
// How long an object is asked at a time, so that one that is in use does not keep a thread when
// nobody wants it any more.
constexpr channel::Milliseconds slice{200};

Error not_in_line() { return {ErrorCode::invalid_operation, "Not acquiring monitor lock"}; }

}  // namespace

// A session in line. Guarded by the monitors' lock.
class Monitors::Attempt final : public channel::Timer,
                                public std::enable_shared_from_this<Attempt> {
 public:
  Attempt(const std::shared_ptr<Monitors>& monitors, std::weak_ptr<Monitor> monitor,
          std::uint32_t session, channel::Time limit)
      : endpoint(session),
        deadline(limit),
        core_(monitors->core_),
        monitors_(monitors),
        monitor_(std::move(monitor)) {}
  ~Attempt() { core_->reactor().cancel(*this); }

  void on_timer() override {
    const auto monitors = monitors_.lock();
    const auto monitor = monitor_.lock();
    if (!monitors || !monitor) return;
    monitors->post(
        [monitors, monitor, self = shared_from_this()] { monitors->step(monitor, self); });
  }

  const std::uint32_t endpoint;
  const channel::Time deadline;
  Reply reply;  // empty while the client has been told to wait on

 private:
  const std::shared_ptr<endpoint::Core> core_;
  const std::weak_ptr<Monitors> monitors_;
  const std::weak_ptr<Monitor> monitor_;
};

Monitors::Monitors(std::shared_ptr<endpoint::Core> core, channel::Milliseconds patience,
                   std::size_t limit)
    : core_(std::move(core)), patience_(channel::saturated(patience)), limit_(limit) {}

Monitors::~Monitors() { core_->reactor().cancel(*this); }

void Monitors::post(std::function<void()> work) { core_->reactor().post(std::move(work)); }

// Null when the session is not in line. With the lock.
std::shared_ptr<Monitors::Attempt> Monitors::find_attempt(const Monitor& monitor,
                                                          std::uint32_t endpoint) {
  for (const auto& attempt : monitor.line) {
    if (attempt->endpoint == endpoint) return attempt;
  }
  return nullptr;
}

std::shared_ptr<Monitors::Monitor> Monitors::find(const ServedObject& object) {
  const auto found = monitors_.find({object.path, object.owner});
  return found == monitors_.end() ? nullptr : found->second;
}

void Monitors::enter(const ServedObject& object, std::uint32_t endpoint,
                     channel::Milliseconds timeout, Reply reply) {
  std::shared_ptr<Monitor> monitor;
  {
    const MutexLock lock(mutex_);
    check_count(endpoint);
    std::shared_ptr<Monitor>& place = monitors_[{object.path, object.owner}];
    if (!place) {
      place = std::make_shared<Monitor>();
      place->skeleton = object.skeleton;
    }
    monitor = place;
    if (monitor->holder == endpoint || find_attempt(*monitor, endpoint)) {
      throw Error(ErrorCode::invalid_operation, "Already acquiring or holding the monitor lock");
    }
    monitor->failures.erase(endpoint);
    const channel::Time deadline =
        timeout.count() < 0 ? channel::never : channel::after(channel::Clock::now(), timeout);
    auto attempt = std::make_shared<Attempt>(shared_from_this(), monitor, endpoint, deadline);
    monitor->line.push_back(attempt);
    await(attempt, std::move(reply));
  }
  admit_next(monitor);
}

void Monitors::check_count(std::uint32_t endpoint) const {
  if (monitors_.size() < limit_) return;
  const auto count = std::count_if(monitors_.begin(), monitors_.end(), [&](const auto& each) {
    return each.second->holder == endpoint || find_attempt(*each.second, endpoint) != nullptr;
  });
  if (static_cast<std::size_t>(count) >= limit_) {
    throw Error(ErrorCode::out_of_system_resource,
                "more than " + std::to_string(limit_) + " monitors of one session");
  }
}

void Monitors::await(const std::shared_ptr<Attempt>& attempt, Reply reply) {
  attempt->reply = std::move(reply);
  const channel::Time step_end = channel::after(channel::Clock::now(), step_time);
  core_->reactor().schedule(*attempt, attempt, std::min(step_end, attempt->deadline));
}

void Monitors::go_on(const ServedObject& object, std::uint32_t endpoint, Reply reply) {
  {
    const MutexLock lock(mutex_);
    const auto monitor = find(object);
    if (!monitor) throw not_in_line();
    if (monitor->holder != endpoint) {
      const std::shared_ptr<Attempt> attempt = find_attempt(*monitor, endpoint);
      if (attempt && !attempt->reply) {
        await(attempt, std::move(reply));
        return;
      }
      const auto failed = monitor->failures.extract(endpoint);
      if (failed.empty()) throw not_in_line();
      throw Error(failed.mapped());
    }
  }
  reply(Outcome::entered, nullptr);
}

// A client has waited long enough, for this answer or for the monitor.
void Monitors::step(const std::shared_ptr<Monitor>& monitor,
                    const std::shared_ptr<Attempt>& attempt) {
  Replies replies;
  {
    const MutexLock lock(mutex_);
    const auto place = std::find(monitor->line.begin(), monitor->line.end(), attempt);
    if (place == monitor->line.end()) return;
    const bool is_over = channel::Clock::now() >= attempt->deadline;
    // The object is asked for it at this moment, or will be: even with no time at all once.
    if (is_over && monitor->holder == 0 && place == monitor->line.begin()) return;
    if (is_over) {
      fail(*monitor, *attempt, Error(ErrorCode::operation_timeout, "the monitor is in use"),
           replies);
    } else if (Reply reply = std::exchange(attempt->reply, nullptr)) {
      replies.emplace_back([reply] { reply(Outcome::wait_on, nullptr); });
      if (attempt->deadline != channel::never) {
        core_->reactor().schedule(*attempt, attempt, attempt->deadline);
      }
    }
  }
  for (const auto& reply : replies) reply();
}

// The client hears it now, or when it asks.
void Monitors::fail(Monitor& monitor, Attempt& attempt, const Error& error, Replies& replies) {
  const auto self = attempt.shared_from_this();
  if (!take_out(monitor, attempt)) return;
  if (attempt.reply) {
    replies.emplace_back(
        [reply = std::move(attempt.reply), error] { reply(Outcome::failed, &error); });
    attempt.reply = nullptr;
  } else {
    monitor.failures.insert_or_assign(attempt.endpoint, error);
  }
}

// False when it has been taken out already.
bool Monitors::take_out(Monitor& monitor, const Attempt& attempt) {
  return std::erase_if(monitor.line, [&](const auto& item) { return item.get() == &attempt; }) != 0;
}

void Monitors::admit_next(const std::shared_ptr<Monitor>& monitor) {
  {
    const MutexLock lock(mutex_);
    if (monitor->holder != 0 || monitor->is_busy || monitor->line.empty()) return;
    monitor->is_busy = true;
  }
  post([self = shared_from_this(), monitor] { self->ask(monitor); });
}

// Asks the object on behalf of the first in line until somebody is in or nobody wants to.
void Monitors::ask(const std::shared_ptr<Monitor>& monitor) {
  while (true) {
    std::shared_ptr<Attempt> attempt;
    channel::Milliseconds time = slice;
    {
      const MutexLock lock(mutex_);
      if (monitor->line.empty()) {
        monitor->is_busy = false;
        return;
      }
      attempt = monitor->line.front();
      if (attempt->deadline != channel::never) {
        const auto left =
            std::chrono::ceil<channel::Milliseconds>(attempt->deadline - channel::Clock::now());
        time = std::clamp(left, channel::Milliseconds(0), slice);
      }
    }
    bool is_free = false;
    std::optional<Error> error;
    try {
      is_free = monitor->skeleton->rr_monitor_enter(time);
    } catch (...) {
      error = endpoint::describe(std::current_exception());
    }
    Replies replies;
    bool is_wanted = true;
    {
      const MutexLock lock(mutex_);
      if (error) {
        fail(*monitor, *attempt, *error, replies);
      } else if (is_free) {
        is_wanted = take_out(*monitor, *attempt);
        if (is_wanted) {
          monitor->holder = attempt->endpoint;
          monitor->used = channel::Clock::now();
          monitor->is_busy = false;
          held_.fetch_add(1, std::memory_order_release);
          if (Reply reply = std::exchange(attempt->reply, nullptr)) {
            replies.emplace_back([reply] { reply(Outcome::entered, nullptr); });
          }
        }
      } else if (channel::Clock::now() >= attempt->deadline) {
        fail(*monitor, *attempt, Error(ErrorCode::operation_timeout, "the monitor is in use"),
             replies);
      }
    }
    for (const auto& reply : replies) reply();
    if (is_free && is_wanted) {
      const MutexLock lock(mutex_);
      schedule_drop();
      return;
    }
    if (is_free) leave_object(*monitor);
  }
}

// When the session is in, the object is to be given back.
bool Monitors::begin_exit(Monitor& monitor, std::uint32_t endpoint) {
  if (endpoint == 0 || monitor.holder != endpoint) return false;
  monitor.holder = 0;
  monitor.is_busy = true;
  held_.fetch_sub(1, std::memory_order_release);
  return true;
}

void Monitors::give_back(const std::shared_ptr<Monitor>& monitor) {
  leave_object(*monitor);
  {
    const MutexLock lock(mutex_);
    monitor->is_busy = false;
  }
  admit_next(monitor);
}

void Monitors::leave_object(const Monitor& monitor) {
  endpoint::call_user_code(*core_, "rr_monitor_exit", [&] { monitor.skeleton->rr_monitor_exit(); });
}

bool Monitors::exit(const ServedObject& object, std::uint32_t endpoint) {
  std::shared_ptr<Monitor> monitor;
  Replies replies;
  {
    const MutexLock lock(mutex_);
    monitor = find(object);
    if (!monitor) return false;
    if (!begin_exit(*monitor, endpoint)) {
      const std::shared_ptr<Attempt> attempt = find_attempt(*monitor, endpoint);
      if (!attempt) throw Error(ErrorCode::invalid_operation, "Not holding monitor lock");
      fail(*monitor, *attempt, Error(ErrorCode::operation_cancelled, "left the line"), replies);
      monitor->failures.erase(endpoint);
      monitor.reset();
    }
  }
  for (const auto& reply : replies) reply();
  if (monitor) give_back(monitor);
  return true;
}

void Monitors::leave_lines(std::uint32_t endpoint) {
  std::vector<std::shared_ptr<Attempt>> left;  // end when the lock has
  const MutexLock lock(mutex_);
  for (const auto& [path, monitor] : monitors_) {
    const std::shared_ptr<Attempt> attempt = find_attempt(*monitor, endpoint);
    if (!attempt) continue;
    take_out(*monitor, *attempt);
    left.push_back(attempt);
  }
}

void Monitors::leave(std::uint32_t endpoint) {
  std::vector<std::shared_ptr<Monitor>> held;
  {
    const MutexLock lock(mutex_);
    for (const auto& [path, monitor] : monitors_) {
      std::erase_if(monitor->line, [&](const auto& item) { return item->endpoint == endpoint; });
      monitor->failures.erase(endpoint);
      if (begin_exit(*monitor, endpoint)) held.push_back(monitor);
    }
  }
  for (const auto& monitor : held) give_back(monitor);
}

std::size_t Monitors::end_if(std::uint32_t endpoint,
                             const std::function<bool(const std::string&)>& is_over,
                             const Error& why) {
  std::vector<std::shared_ptr<Monitor>> held;
  Replies replies;
  std::size_t count = 0;
  {
    const MutexLock lock(mutex_);
    for (const auto& [place, monitor] : monitors_) {
      if (!is_over(place.first)) continue;
      if (const std::shared_ptr<Attempt> attempt = find_attempt(*monitor, endpoint)) {
        fail(*monitor, *attempt, why, replies);
        ++count;
      }
      if (begin_exit(*monitor, endpoint)) held.push_back(monitor);
    }
  }
  for (const auto& reply : replies) reply();
  for (const auto& monitor : held) give_back(monitor);
  return count + held.size();
}

void Monitors::forget(const ServedObject& object) {
  std::shared_ptr<Monitor> monitor;
  bool is_held = false;
  Replies replies;
  {
    const MutexLock lock(mutex_);
    monitor = find(object);
    if (!monitor) return;
    monitors_.erase({object.path, object.owner});
    while (!monitor->line.empty()) {
      const std::shared_ptr<Attempt> attempt = monitor->line.front();
      fail(*monitor, *attempt, Error(ErrorCode::object_not_found, "the object was released"),
           replies);
    }
    is_held = begin_exit(*monitor, monitor->holder);
  }
  for (const auto& reply : replies) reply();
  if (is_held) give_back(monitor);
}

void Monitors::check(const ServedObject& object, std::uint32_t endpoint) {
  const MutexLock lock(mutex_);
  const auto monitor = find(object);
  if (!monitor || monitor->holder == 0) return;
  if (monitor->holder != endpoint) {
    throw Error(ErrorCode::invalid_operation, "Monitor lock is held by another client");
  }
  monitor->used = channel::Clock::now();
}

void Monitors::on_timer() {
  post([self = shared_from_this()] { self->drop_unused(); });
}

// Whoever has not used what it holds for too long is out.
void Monitors::drop_unused() {
  std::vector<std::shared_ptr<Monitor>> dropped;
  {
    const MutexLock lock(mutex_);
    const channel::Time now = channel::Clock::now();
    for (const auto& [path, monitor] : monitors_) {
      if (monitor->holder == 0 || now - monitor->used < patience_) continue;
      begin_exit(*monitor, monitor->holder);
      dropped.push_back(monitor);
    }
    schedule_drop();
  }
  for (const auto& monitor : dropped) give_back(monitor);
}

void Monitors::schedule_drop() {
  channel::Time next = channel::never;
  for (const auto& [path, monitor] : monitors_) {
    if (monitor->holder != 0) next = std::min(next, channel::after(monitor->used, patience_));
  }
  if (next != channel::never) core_->reactor().schedule(*this, weak_from_this(), next);
}

}  // namespace rr::service
