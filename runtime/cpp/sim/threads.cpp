// SPDX-License-Identifier: Apache-2.0
// Threads, mutexes, conditions and futexes of the C library, in a run. Programs and the C++ library
// find these definitions instead of the C library's; outside a run they call those.
#include <linux/futex.h>
#include <pthread.h>
#include <sched.h>
#include <sys/resource.h>
#include <sys/syscall.h>

#include <algorithm>
#include <cerrno>
#include <cstdarg>
#include <ctime>
#include <set>

#include "runtime/cpp/sim/clock.hpp"
#include "runtime/cpp/sim/faults.hpp"
#include "runtime/cpp/sim/real.hpp"
#include "runtime/cpp/sim/scheduler.hpp"

namespace rr::sim {
namespace {

using MutexFunction = int(pthread_mutex_t*);
using LockFunction = int(pthread_rwlock_t*);
using ConditionFunction = int(pthread_cond_t*);

void note_held(const void* mutex) {
  const Spared spared;
  Scheduler::self().held.push_back(mutex);
}

void note_free(const void* mutex) {
  auto& held = Scheduler::self().held;
  const auto place = std::find(held.rbegin(), held.rend(), mutex);
  if (place != held.rend()) held.erase(std::next(place).base());
}

int try_mutex(pthread_mutex_t* mutex) {
  static constinit Real<MutexFunction> call{"pthread_mutex_trylock"};
  return call(mutex);
}

// 0 or ETIMEDOUT.
int take_mutex(Scheduler& run, pthread_mutex_t* mutex, Nanoseconds deadline, const void* caller) {
  while (try_mutex(mutex) != 0) {
    if (!run.wait("a mutex", mutex, deadline, caller)) return ETIMEDOUT;
  }
  note_held(mutex);
  return 0;
}

void free_mutex(Scheduler& run, pthread_mutex_t* mutex) {
  static constinit Real<MutexFunction> call{"pthread_mutex_unlock"};
  call(mutex);
  note_free(mutex);
  run.wake(mutex, 1);
}

int wait_condition(Scheduler& run, pthread_cond_t* condition, pthread_mutex_t* mutex,
                   Nanoseconds deadline, const void* caller) {
  run.point("wait", condition, 0, caller);
  free_mutex(run, mutex);
  const Nanoseconds surprise = Faults::current().next_spurious_wake_up(run);
  const bool is_woken = run.wait("a condition", condition, std::min(deadline, surprise), caller);
  take_mutex(run, mutex, never, caller);
  return is_woken || run.now() < deadline ? 0 : ETIMEDOUT;
}

long wait_word(Scheduler& run, const std::uint32_t* word, std::uint32_t seen, Nanoseconds deadline,
               const void* caller) {
  run.point("look at a word", word, seen, caller);
  if (__atomic_load_n(word, __ATOMIC_SEQ_CST) != seen) {
    errno = EAGAIN;
    return -1;
  }
  if (run.wait("a word", word, deadline, caller)) return 0;
  errno = ETIMEDOUT;
  return -1;
}

struct FutexCall {
  std::uint32_t* word;
  int operation;
  std::uint32_t value;
  const timespec* time;
};

long futex(Scheduler& run, const FutexCall& call, const void* caller) {
  const clockid_t clock =
      (call.operation & FUTEX_CLOCK_REALTIME) != 0 ? CLOCK_REALTIME : CLOCK_MONOTONIC;
  switch (call.operation & FUTEX_CMD_MASK) {
    case FUTEX_WAIT: {
      Nanoseconds deadline = never;
      if (call.time != nullptr) {
        const Nanoseconds length = length_of(*call.time);
        if (length < never - run.now()) deadline = run.now() + length;
      }
      return wait_word(run, call.word, call.value, deadline, caller);
    }
    case FUTEX_WAIT_BITSET:
      return wait_word(run, call.word, call.value,
                       call.time == nullptr ? never : time_of(clock, *call.time), caller);
    case FUTEX_WAKE:
    case FUTEX_WAKE_BITSET: {
      const int woken =
          run.wake(call.word, static_cast<int>(std::min<std::uint32_t>(call.value, INT32_MAX)));
      run.point("wake", call.word, woken, caller);
      return woken;
    }
    default:
      run.fail("a futex call that a run does not know");
  }
}

// Initializations that have begun and not ended.
std::set<const pthread_once_t*>& begun() {
  static std::set<const pthread_once_t*> controls;
  return controls;
}

constexpr pthread_once_t done_once = 2;  // as the C library writes it

}  // namespace
}  // namespace rr::sim

using rr::sim::Faults;
using rr::sim::Nanoseconds;
using rr::sim::never;
using rr::sim::Real;
using rr::sim::Scheduler;

#define RR_CALLER __builtin_return_address(0)

extern "C" {

int pthread_create(pthread_t* __restrict thread, const pthread_attr_t* __restrict attributes,
                   void* (*start)(void*), void* __restrict argument) noexcept {
  Scheduler* const run = Scheduler::current();
  if (run == nullptr) {
    static constinit Real<int(pthread_t*, const pthread_attr_t*, void* (*)(void*), void*)> call{
        "pthread_create"};
    return call(thread, attributes, start, argument);
  }
  if (Faults::current().refuses_thread(*run)) {
    run->note("is refused a thread");
    run->point("is refused a thread", nullptr, 0, RR_CALLER);
    return EAGAIN;
  }
  const int result = run->start(thread, attributes, start, argument);
  run->point("start a thread", nullptr, result, RR_CALLER);
  return result;
}

int pthread_join(pthread_t thread, void** value) {
  static constinit Real<int(pthread_t, void**)> call{"pthread_join"};
  if (Scheduler* const run = Scheduler::current()) run->join(thread, RR_CALLER);
  return call(thread, value);
}

int pthread_mutex_lock(pthread_mutex_t* mutex) noexcept {
  Scheduler* const run = Scheduler::current();
  if (run == nullptr) {
    static constinit Real<rr::sim::MutexFunction> call{"pthread_mutex_lock"};
    return call(mutex);
  }
  run->point("lock", mutex, 0, RR_CALLER);
  return rr::sim::take_mutex(*run, mutex, never, RR_CALLER);
}

int pthread_mutex_trylock(pthread_mutex_t* mutex) noexcept {
  Scheduler* const run = Scheduler::current();
  if (run == nullptr) return rr::sim::try_mutex(mutex);
  run->point("try to lock", mutex, 0, RR_CALLER);
  const int result = rr::sim::try_mutex(mutex);
  if (result == 0) rr::sim::note_held(mutex);
  return result;
}

int pthread_mutex_timedlock(pthread_mutex_t* __restrict mutex,
                            const timespec* __restrict time) noexcept {
  return pthread_mutex_clocklock(mutex, CLOCK_REALTIME, time);
}

int pthread_mutex_clocklock(pthread_mutex_t* __restrict mutex, clockid_t clock,
                            const timespec* __restrict time) noexcept {
  Scheduler* const run = Scheduler::current();
  if (run == nullptr) {
    static constinit Real<int(pthread_mutex_t*, clockid_t, const timespec*)> call{
        "pthread_mutex_clocklock"};
    return call(mutex, clock, time);
  }
  run->point("lock", mutex, 0, RR_CALLER);
  return rr::sim::take_mutex(*run, mutex, rr::sim::time_of(clock, *time), RR_CALLER);
}

int pthread_mutex_unlock(pthread_mutex_t* mutex) noexcept {
  Scheduler* const run = Scheduler::current();
  if (run == nullptr) {
    static constinit Real<rr::sim::MutexFunction> call{"pthread_mutex_unlock"};
    return call(mutex);
  }
  rr::sim::free_mutex(*run, mutex);
  run->point("unlock", mutex, 0, RR_CALLER);
  return 0;
}

int pthread_cond_wait(pthread_cond_t* __restrict condition, pthread_mutex_t* __restrict mutex) {
  Scheduler* const run = Scheduler::current();
  if (run == nullptr) {
    static constinit Real<int(pthread_cond_t*, pthread_mutex_t*)> call{"pthread_cond_wait",
                                                                       "GLIBC_2.3.2"};
    return call(condition, mutex);
  }
  return rr::sim::wait_condition(*run, condition, mutex, never, RR_CALLER);
}

int pthread_cond_clockwait(pthread_cond_t* __restrict condition, pthread_mutex_t* __restrict mutex,
                           clockid_t clock, const timespec* __restrict time) {
  Scheduler* const run = Scheduler::current();
  if (run == nullptr) {
    static constinit Real<int(pthread_cond_t*, pthread_mutex_t*, clockid_t, const timespec*)> call{
        "pthread_cond_clockwait"};
    return call(condition, mutex, clock, time);
  }
  return rr::sim::wait_condition(*run, condition, mutex, rr::sim::time_of(clock, *time), RR_CALLER);
}

int pthread_cond_timedwait(pthread_cond_t* __restrict condition, pthread_mutex_t* __restrict mutex,
                           const timespec* __restrict time) {
  Scheduler* const run = Scheduler::current();
  if (run == nullptr) {
    static constinit Real<int(pthread_cond_t*, pthread_mutex_t*, const timespec*)> call{
        "pthread_cond_timedwait", "GLIBC_2.3.2"};
    return call(condition, mutex, time);
  }
  return rr::sim::wait_condition(*run, condition, mutex, rr::sim::time_of(CLOCK_REALTIME, *time),
                                 RR_CALLER);
}

int pthread_cond_signal(pthread_cond_t* condition) noexcept {
  Scheduler* const run = Scheduler::current();
  if (run == nullptr) {
    static constinit Real<rr::sim::ConditionFunction> call{"pthread_cond_signal", "GLIBC_2.3.2"};
    return call(condition);
  }
  run->wake(condition, 1);
  run->point("signal", condition, 0, RR_CALLER);
  return 0;
}

int pthread_cond_broadcast(pthread_cond_t* condition) noexcept {
  Scheduler* const run = Scheduler::current();
  if (run == nullptr) {
    static constinit Real<rr::sim::ConditionFunction> call{"pthread_cond_broadcast", "GLIBC_2.3.2"};
    return call(condition);
  }
  run->wake(condition, INT32_MAX);
  run->point("signal to all", condition, 0, RR_CALLER);
  return 0;
}

int pthread_cond_destroy(pthread_cond_t* condition) noexcept {
  if (Scheduler::current() != nullptr) return 0;  // the C library has not seen its waiters
  static constinit Real<rr::sim::ConditionFunction> call{"pthread_cond_destroy", "GLIBC_2.3.2"};
  return call(condition);
}

int pthread_rwlock_rdlock(pthread_rwlock_t* lock) noexcept {
  Scheduler* const run = Scheduler::current();
  if (run == nullptr) {
    static constinit Real<rr::sim::LockFunction> call{"pthread_rwlock_rdlock"};
    return call(lock);
  }
  static constinit Real<rr::sim::LockFunction> attempt{"pthread_rwlock_tryrdlock"};
  run->point("lock for reading", lock, 0, RR_CALLER);
  while (attempt(lock) != 0) run->wait("a mutex", lock, never, RR_CALLER);
  rr::sim::note_held(lock);
  return 0;
}

int pthread_rwlock_wrlock(pthread_rwlock_t* lock) noexcept {
  Scheduler* const run = Scheduler::current();
  if (run == nullptr) {
    static constinit Real<rr::sim::LockFunction> call{"pthread_rwlock_wrlock"};
    return call(lock);
  }
  static constinit Real<rr::sim::LockFunction> attempt{"pthread_rwlock_trywrlock"};
  run->point("lock", lock, 0, RR_CALLER);
  while (attempt(lock) != 0) run->wait("a mutex", lock, never, RR_CALLER);
  rr::sim::note_held(lock);
  return 0;
}

int pthread_rwlock_unlock(pthread_rwlock_t* lock) noexcept {
  static constinit Real<rr::sim::LockFunction> call{"pthread_rwlock_unlock"};
  Scheduler* const run = Scheduler::current();
  const int result = call(lock);
  if (run == nullptr) return result;
  rr::sim::note_free(lock);
  run->wake(lock, INT32_MAX);
  run->point("unlock", lock, 0, RR_CALLER);
  return result;
}

int pthread_once(pthread_once_t* control, void (*initialize)()) {
  Scheduler* const run = Scheduler::current();
  if (run == nullptr) {
    static constinit Real<int(pthread_once_t*, void (*)())> call{"pthread_once"};
    return call(control, initialize);
  }
  auto& begun = rr::sim::begun();
  while (*control != rr::sim::done_once) {
    if (begun.contains(control)) {
      run->wait("an initialization", control, never, RR_CALLER);
      continue;
    }
    {
      const rr::sim::Spared spared;
      begun.insert(control);
    }
    struct End {
      pthread_once_t* control;
      Scheduler& run;
      ~End() {
        rr::sim::begun().erase(control);
        run.wake(control, INT32_MAX);
      }
    } const end{control, *run};
    initialize();
    *control = rr::sim::done_once;
  }
  return 0;
}

// Priorities mean nothing in a run.
int sched_setscheduler(pid_t process, int policy, const sched_param* parameters) noexcept {
  if (Scheduler::current() != nullptr) return 0;
  static constinit Real<int(pid_t, int, const sched_param*)> call{"sched_setscheduler"};
  return call(process, policy, parameters);
}

int setpriority(__priority_which_t which, id_t who, int priority) noexcept {
  if (Scheduler::current() != nullptr) return 0;
  static constinit Real<int(__priority_which_t, id_t, int)> call{"setpriority"};
  return call(which, who, priority);
}

long syscall(long number, ...) noexcept {
  va_list list;
  va_start(list, number);
  const long a = va_arg(list, long);
  const long b = va_arg(list, long);
  const long c = va_arg(list, long);
  const long d = va_arg(list, long);
  const long e = va_arg(list, long);
  const long f = va_arg(list, long);
  va_end(list);
  Scheduler* const run = Scheduler::current();
  if (run != nullptr && number == SYS_futex) {
    // A system call has its pointers as numbers.
    // NOLINTBEGIN(performance-no-int-to-ptr)
    return rr::sim::futex(*run,
                          {reinterpret_cast<std::uint32_t*>(a), static_cast<int>(b),
                           static_cast<std::uint32_t>(c), reinterpret_cast<const timespec*>(d)},
                          RR_CALLER);
    // NOLINTEND(performance-no-int-to-ptr)
  }
  if (run != nullptr && number == SYS_sched_setattr) return 0;
  static constinit Real<long(long, ...)> call{"syscall"};
  return call(number, a, b, c, d, e, f);
}
}
