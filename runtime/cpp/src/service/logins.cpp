// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/service/logins.hpp"

#include <algorithm>
#include <deque>
#include <map>
#include <optional>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "rr/error.hpp"
#include "rr/mutex.hpp"
#include "runtime/cpp/src/channel/remote_address.hpp"
#include "runtime/cpp/src/platform/threads.hpp"

namespace rr::service {
namespace {

using channel::Clock;
using channel::Milliseconds;
using channel::Time;

// Failures of an address that cost it nothing, as several clients may be behind it.
constexpr unsigned free_failures = 4;
// Addresses whose failures are remembered.
constexpr std::size_t most_addresses = 4096;
// So many failures a second are logged one by one.
constexpr unsigned logged_at_once = 10;
constexpr std::chrono::seconds log_period{1};
// Of a name in the log.
constexpr std::size_t longest_name = 64;

Error busy() {
  return {ErrorCode::authentication_error, "the service is busy with logins: try again later"};
}

std::string text_of(const std::exception_ptr& error) {
  try {
    std::rethrow_exception(error);
  } catch (const Error& known) {
    return known.message();
  } catch (const std::exception& other) {
    return other.what();
  } catch (...) {
    return "something that is no exception was thrown";
  }
}

unsigned threads_of(const LoginOptions& options) {
  if (options.threads != 0) return options.threads;
  return std::thread::hardware_concurrency() > 2 ? 2 : 1;
}

}  // namespace

std::string printable_name(std::string_view name) {
  constexpr std::string_view digits = "0123456789abcdef";
  std::string text;
  for (const char c : name.substr(0, longest_name)) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte >= 0x20 && byte < 0x7f && c != '`' && c != '\\') {
      text += c;
    } else {
      text += {'\\', 'x', digits[byte >> 4], digits[byte & 15]};
    }
  }
  return name.size() > longest_name ? text + "..." : text;
}

struct Logins::State : std::enable_shared_from_this<State> {
  State(const LoginOptions& given, Log log_function, channel::Milliseconds idle_limit)
      : options(given),
        threads_limit(threads_of(given)),
        log(std::move(log_function)),
        idle_time(idle_limit) {}

  using Attempts = std::deque<std::shared_ptr<Attempt>>;
  struct Remote {
    Attempts waiting;
    unsigned failures = 0;
    Time last_failure{};
    std::uint64_t last_turn = 0;
  };

  const LoginOptions options;
  const unsigned threads_limit;
  const Log log;
  const channel::Milliseconds idle_time;

  Mutex mutex;
  Condition wake;
  Condition ended;
  bool is_stopping RR_GUARDED_BY(mutex) = false;
  unsigned live RR_GUARDED_BY(mutex) = 0;
  unsigned idle RR_GUARDED_BY(mutex) = 0;
  std::vector<std::thread::id> runners RR_GUARDED_BY(mutex);
  std::size_t waiting_count RR_GUARDED_BY(mutex) = 0;
  std::uint64_t turns RR_GUARDED_BY(mutex) = 0;
  std::map<std::string, Remote> remotes RR_GUARDED_BY(mutex);
  // The log: failures since `log_begin`, of which the first ones have been told.
  Time log_begin RR_GUARDED_BY(mutex) = Time::min();
  unsigned log_count RR_GUARDED_BY(mutex) = 0;

  bool put(const std::shared_ptr<Attempt>& attempt, std::shared_ptr<Attempt>& evicted)
      RR_REQUIRES(mutex);
  bool make_room(std::size_t own, std::shared_ptr<Attempt>& evicted) RR_REQUIRES(mutex);
  void make_thread() RR_REQUIRES(mutex);
  Remote& remote_of(const std::string& key) RR_REQUIRES(mutex);
  void forget_some(Time now) RR_REQUIRES(mutex);
  std::shared_ptr<Attempt> next(Time now, Time& due) RR_REQUIRES(mutex);
  [[nodiscard]] bool is_runner() const RR_REQUIRES(mutex) {
    return std::find(runners.begin(), runners.end(), std::this_thread::get_id()) != runners.end();
  }
  void run();
  void check(Attempt& attempt);
  void note_failure(const Attempt& attempt);
  void report_rest();
  void refuse(Attempt& attempt, const Error& why);
  [[nodiscard]] bool is_forgotten(const Remote& remote, Time now) const {
    return now - remote.last_failure >= channel::saturated(options.memory);
  }
};

Milliseconds Logins::delay(const LoginOptions& options, unsigned of_connection,
                           unsigned of_address) {
  const unsigned beyond = of_address > free_failures ? of_address - free_failures : 0;
  const unsigned failures = std::max(of_connection, beyond);
  if (failures == 0) return {};
  constexpr unsigned most_doublings = 20;
  const Milliseconds first = channel::saturated(options.first_delay);
  const Milliseconds longest = channel::saturated(options.max_delay);
  Milliseconds delay = std::min(first, longest);
  for (unsigned i = 1; i < std::min(failures, most_doublings); ++i) {
    delay = std::min(2 * delay, longest);
  }
  return delay;
}

Logins::Logins(const LoginOptions& options, Log log, channel::Milliseconds idle_time)
    : state_(std::make_shared<State>(options, std::move(log), idle_time)) {}

Logins::~Logins() { stop(); }

std::shared_ptr<Logins::Attempt> Logins::add(Request request) {
  auto attempt = std::make_shared<Attempt>(std::move(request));
  std::shared_ptr<Attempt> evicted;
  bool is_in = false;
  {
    const MutexLock lock(state_->mutex);
    is_in = state_->put(attempt, evicted);
  }
  state_->wake.notify_one();
  if (evicted) state_->refuse(*evicted, busy());
  if (!is_in) state_->refuse(*attempt, busy());
  return attempt;
}

void Logins::cancel(const std::shared_ptr<Attempt>& attempt) {
  {
    const MutexLock lock(state_->mutex);
    const auto remote = state_->remotes.find(channel::remote_key(attempt->request.address));
    if (remote == state_->remotes.end()) return;
    if (std::erase(remote->second.waiting, attempt) == 0) return;
    --state_->waiting_count;
  }
  attempt->refusal =
      std::make_exception_ptr(Error(ErrorCode::connection_error, "the client has left"));
  std::exchange(attempt->request.on_finished, nullptr)();
}

void Logins::refuse_all() {
  std::vector<std::shared_ptr<Attempt>> refused;
  {
    const MutexLock lock(state_->mutex);
    state_->is_stopping = true;
    for (auto& [key, remote] : state_->remotes) {
      refused.insert(refused.end(), remote.waiting.begin(), remote.waiting.end());
      remote.waiting.clear();
    }
    state_->waiting_count = 0;
  }
  state_->wake.notify_all();
  for (const auto& attempt : refused) state_->refuse(*attempt, busy());
}

void Logins::stop() {
  refuse_all();
  const MutexLock lock(state_->mutex);
  if (state_->is_runner()) return;
  while (state_->live != 0) state_->ended.wait(state_->mutex);
}

bool Logins::is_own_thread() const {
  const MutexLock lock(state_->mutex);
  return state_->is_runner();
}

// False when there is no room.
bool Logins::State::put(const std::shared_ptr<Attempt>& attempt,
                        std::shared_ptr<Attempt>& evicted) {
  if (is_stopping) return false;
  Remote& remote = remote_of(channel::remote_key(attempt->request.address));
  if (waiting_count >= options.queue_limit && !make_room(remote.waiting.size(), evicted)) {
    return false;
  }
  remote.waiting.push_back(attempt);
  ++waiting_count;
  if (idle < waiting_count && live < threads_limit) make_thread();
  if (live != 0) return true;
  remote.waiting.pop_back();  // no thread is to be had
  --waiting_count;
  return false;
}

// The address that has most attempts in the queue gives one of them for one that has `own`, if that
// still has less then.
bool Logins::State::make_room(std::size_t own, std::shared_ptr<Attempt>& evicted) {
  const auto largest =
      std::max_element(remotes.begin(), remotes.end(), [](const auto& a, const auto& b) {
        return a.second.waiting.size() < b.second.waiting.size();
      });
  if (largest == remotes.end() || largest->second.waiting.size() <= own + 1) return false;
  evicted = std::move(largest->second.waiting.back());
  largest->second.waiting.pop_back();
  --waiting_count;
  return true;
}

void Logins::State::make_thread() {
  try {
    platform::run_apart([self = shared_from_this()] { self->run(); });
    ++live;
  } catch (const std::system_error&) {
    // Those that there are go on.
  }
}

Logins::State::Remote& Logins::State::remote_of(const std::string& key) {
  const auto found = remotes.find(key);
  if (found != remotes.end()) return found->second;
  if (remotes.size() >= most_addresses) forget_some(Clock::now());
  return remotes[key];
}

// What is old; if that is nothing, what is oldest.
void Logins::State::forget_some(Time now) {
  const std::size_t before = remotes.size();
  std::erase_if(remotes, [&](const auto& item) {
    return item.second.waiting.empty() && is_forgotten(item.second, now);
  });
  if (remotes.size() != before) return;
  auto oldest = remotes.end();
  for (auto item = remotes.begin(); item != remotes.end(); ++item) {
    if (!item->second.waiting.empty()) continue;
    const bool is_older =
        oldest == remotes.end() || item->second.last_failure < oldest->second.last_failure;
    if (is_older) oldest = item;
  }
  if (oldest != remotes.end()) remotes.erase(oldest);
}

// The first attempt that is due, of the address that has not had a turn for longest. Null when none
// is; `due` is when one will be.
std::shared_ptr<Logins::Attempt> Logins::State::next(Time now, Time& due) {
  due = channel::never;
  Remote* chosen = nullptr;
  Attempts::iterator place;
  for (auto& [key, remote] : remotes) {
    if (remote.waiting.empty()) continue;
    if (is_forgotten(remote, now)) remote.failures = 0;
    for (auto item = remote.waiting.begin(); item != remote.waiting.end(); ++item) {
      const Attempt& attempt = **item;
      const Time when = attempt.added + delay(options, attempt.request.failures, remote.failures);
      due = std::min(due, when);
      if (when > now || (chosen != nullptr && chosen->last_turn <= remote.last_turn)) continue;
      chosen = &remote;
      place = item;
      break;
    }
  }
  if (chosen == nullptr) return nullptr;
  chosen->last_turn = ++turns;
  std::shared_ptr<Attempt> attempt = std::move(*place);
  chosen->waiting.erase(place);
  --waiting_count;
  return attempt;
}

void Logins::State::run() {
  // Hashing is not to take the processor from the node's other threads, but to get on where other
  // programs want it as well.
  platform::lower_priority();
  MutexLock lock(mutex);
  runners.push_back(std::this_thread::get_id());
  Time idle_since = Clock::now();
  while (!is_stopping) {
    const Time now = Clock::now();
    Time due{};
    if (std::shared_ptr<Attempt> attempt = next(now, due)) {
      lock.unlock();
      check(*attempt);
      attempt.reset();
      lock.lock();
      idle_since = Clock::now();
      continue;
    }
    if (waiting_count == 0 && now - idle_since >= idle_time) break;
    Time until = std::min(due, idle_since + idle_time);
    if (waiting_count != 0) until = due;
    const bool has_rest = log_count > logged_at_once;
    if (has_rest) until = std::min(until, log_begin + log_period);
    ++idle;
    channel::wait_until(wake, mutex, until);
    --idle;
    if (has_rest && Clock::now() >= log_begin + log_period) {
      lock.unlock();
      report_rest();
      lock.lock();
    }
  }
  std::erase(runners, std::this_thread::get_id());
  --live;
  ended.notify_all();
}

// Runs user code.
void Logins::State::check(Attempt& attempt) {
  try {
    attempt.user = std::make_shared<const User>(attempt.request.check());
  } catch (...) {
    attempt.refusal = std::current_exception();
  }
  attempt.request.check = nullptr;
  if (attempt.refusal) {
    {
      const MutexLock lock(mutex);
      Remote& remote = remote_of(channel::remote_key(attempt.request.address));
      ++remote.failures;
      remote.last_failure = Clock::now();
    }
    note_failure(attempt);
  }
  std::exchange(attempt.request.on_finished, nullptr)();
}

void Logins::State::refuse(Attempt& attempt, const Error& why) {
  attempt.refusal = std::make_exception_ptr(why);
  note_failure(attempt);
  std::exchange(attempt.request.on_finished, nullptr)();
}

void Logins::State::note_failure(const Attempt& attempt) {
  const Time now = Clock::now();
  unsigned rest = 0;
  bool is_told = false;
  {
    const MutexLock lock(mutex);
    if (log_begin == Time::min() || now - log_begin >= log_period) {
      rest = log_count > logged_at_once ? log_count - logged_at_once : 0;
      log_begin = now;
      log_count = 0;
    }
    is_told = ++log_count <= logged_at_once;
  }
  if (rest != 0) log(LogLevel::warning, std::to_string(rest) + " more logins have failed");
  if (!is_told) return;
  log(LogLevel::warning, "`" + printable_name(attempt.request.user) + "` from " +
                             printable_name(attempt.request.address) +
                             " is not logged in: " + text_of(attempt.refusal));
}

void Logins::State::report_rest() {
  unsigned rest = 0;
  {
    const MutexLock lock(mutex);
    if (log_count <= logged_at_once) return;
    rest = log_count - logged_at_once;
    log_count = 0;
    log_begin = Clock::now();
  }
  log(LogLevel::warning, std::to_string(rest) + " more logins have failed");
}

}  // namespace rr::service
