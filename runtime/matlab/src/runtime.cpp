// SPDX-License-Identifier: Apache-2.0
#include "runtime/matlab/src/runtime.hpp"

#include <algorithm>
#include <utility>

#include "rr/serial.hpp"
#include "runtime/matlab/src/ending_signals.hpp"
#include "runtime/matlab/src/objects.hpp"

namespace rr::matlab {

using Clock = std::chrono::steady_clock;

Runtime::Runtime(std::uint32_t generation, RuntimeOptions given)
    : generator_limit(given.node.budget.client_session),
      allow_clear_credentials(given.allow_clear_credentials),
      queue_(std::make_shared<Queue>()),
      log_(std::make_shared<Log>()),
      handles_(generation),
      interrupts_(std::make_unique<Interrupts>([this] { interrupted(); })) {
  NodeOptions& options = given.node;
  options.log = [log = log_](LogLevel level, std::string_view text) { log->write(level, text); };
  options.channels.emplace("rr+serial", serial_channel());
  node_ = std::make_unique<Node>(std::move(options));
}

// What waits for the interpreter's thread is let go first, then the threads end, then what they
// used goes.
Runtime::~Runtime() {
  current.reset();
  last_error.reset();
  queue_->refuse_requests();
  handles_.clear();
  functions_.clear();
  node_->shutdown();
  queue_->clear();
}

Runtime::Waiting::Waiting(Runtime& runtime) : runtime_(runtime) {
  EndingSignals::prepare();
  const MutexLock lock(runtime.waiting_mutex_);
  runtime.waiting_.push_back(cancellation);
  if (runtime.waiting_.size() == 1) runtime.interrupts_->begin();
}

Runtime::Waiting::~Waiting() {
  const MutexLock lock(runtime_.waiting_mutex_);
  runtime_.waiting_.pop_back();
  if (runtime_.waiting_.empty()) runtime_.interrupts_->end();
}

CallOptions Runtime::options_of(const Waiting& waiting,
                                std::optional<std::chrono::milliseconds> limit) const {
  return {limit.value_or(request_timeout), waiting.cancellation.get_token()};
}

void Runtime::note_error(const Error& error, std::shared_ptr<Connection> connection) {
  last_error.emplace(LastError{error, std::move(connection)});
  const std::string identifier = identifier_of(error.name());
  if (name_of_identifier(identifier) == error.name()) {
    foreign_names_.erase(identifier);
    return;
  }
  constexpr std::size_t most_names = 256;  // a service must not fill the memory with them
  if (foreign_names_.size() >= most_names) foreign_names_.clear();
  foreign_names_[identifier] = error.name();
}

std::string Runtime::name_of_failure(const Failure& failure) const {
  const auto foreign = foreign_names_.find(failure.identifier);
  return foreign != foreign_names_.end() ? foreign->second : name_of_identifier(failure.identifier);
}

// The parameter of a service's error is of that service's types, which another one need not know.
Error Runtime::error_of_failure(const Failure& failure) const {
  if (!last_error) return error_of(failure);
  const Error& error = last_error->error;
  const Failure known = failure_of(error);
  if (known.identifier != failure.identifier || known.message != failure.message) {
    return error_of(failure);
  }
  if (!last_error->connection) return error;
  return {error.code(), error.name(), error.message(), error.subname()};
}

void Runtime::interrupted() {
  std::vector<std::stop_source> waiting;
  {
    const MutexLock lock(waiting_mutex_);
    // Ctrl-C may have ended a call already, and what waits now is the next one.
    if (!Interrupts::is_pending()) return;
    waiting = waiting_;
  }
  for (std::stop_source& one : waiting) one.request_stop();
  queue_->wake();
}

bool Runtime::may_block() const {
  return !Interrupts::must_be_asked() && !functions_.has_callbacks();
}

bool Runtime::wait_until(const std::function<bool()>& is_true, std::chrono::milliseconds limit) {
  Waiting waiting(*this);
  const bool is_limited = limit < std::chrono::hours(24 * 365);
  const auto end = is_limited ? Clock::now() + limit : Clock::time_point::max();
  while (true) {
    run_calls();
    EndingSignals::prepare();
    if (is_true()) return true;
    if (waiting.cancellation.stop_requested() || Interrupts::is_pending()) {
      throw Error(ErrorCode::operation_cancelled, "interrupted");
    }
    const auto now = Clock::now();
    if (now >= end) return false;
    constexpr std::chrono::milliseconds slice(20);
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(end - now);
    queue_->wait(is_limited ? std::min(slice, left) : slice);
  }
}

std::size_t Runtime::run_queue() {
  run_calls();
  std::size_t count = 0;
  for (std::size_t left = queue_->size(); left != 0; --left) {
    const Queue::Work work = queue_->pop();
    if (!work) break;
    ++count;
    work();
    run_calls();
  }
  return count;
}

void Runtime::run_calls() {
  while (const std::shared_ptr<PendingCall> call = queue_->pop_call()) {
    // Whatever ends it, the service's call must not wait for ever.
    struct Ended {
      ~Ended() {
        call.fail(std::make_exception_ptr(
            Error(ErrorCode::operation_aborted, "the client's function was interrupted")));
      }
      PendingCall& call;
    } ended{*call};
    try {
      call->finish(run_callback(*this, *call));
    } catch (const Error&) {
      call->fail(std::current_exception());
    } catch (const Misfit& misfit) {
      call->fail(std::make_exception_ptr(misfit.error("")));
    }
  }
  while (const Queue::Work request = queue_->pop_request()) {
    ++served_count;
    request();
  }
}

}  // namespace rr::matlab
