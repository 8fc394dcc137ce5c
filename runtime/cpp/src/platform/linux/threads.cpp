// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/platform/threads.hpp"

#include <pthread.h>
#include <sched.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cstdint>
#include <thread>
#include <utility>

#include "runtime/cpp/src/platform/thread_object.hpp"

namespace rr::platform {
namespace {

// As <linux/sched/types.h> has it, which cannot be included beside <sched.h>.
struct SchedulingAttributes {
  std::uint32_t size = sizeof(SchedulingAttributes);
  std::uint32_t policy = 0;
  std::uint64_t flags = 0;
  std::int32_t nice = 0;
  std::uint32_t priority = 0;
  std::uint64_t runtime = 0;  // nanoseconds; of ordinary threads: the slice
  std::uint64_t deadline = 0;
  std::uint64_t period = 0;
};

// Links of the calling thread.
struct Ends {
  ThreadEnd* first = nullptr;

  constexpr Ends() = default;
  ~Ends() {
    // One that ends may add others.
    while (first != nullptr) {
      ThreadEnd* const link = std::exchange(first, first->next);
      link->end(*link);
    }
  }
  Ends(const Ends&) = delete;
  Ends& operator=(const Ends&) = delete;
};
constinit thread_local Ends ends;

}  // namespace

void run_apart(std::function<void()> work) { std::thread(std::move(work)).detach(); }

void prefer_throughput() {
  const sched_param none{};
  sched_setscheduler(0, SCHED_BATCH, &none);
}

// Since Linux 6.12 a thread may say how long it wants to run when others want its processor, too.
// Older kernels leave it as it is.
void ask_for_short_slices() {
  SchedulingAttributes attributes;
  if (::syscall(SYS_sched_getattr, 0, &attributes, sizeof attributes, 0) != 0) return;
  if (attributes.policy != SCHED_OTHER) return;
  attributes.runtime = 100'000;
  ::syscall(SYS_sched_setattr, 0, &attributes, 0);
}

void lower_priority() {
  constexpr int niceness = 5;
  setpriority(PRIO_PROCESS, 0, niceness);  // of this thread only, on Linux
}

void leave_signals_to_others() {
  sigset_t signals;
  sigfillset(&signals);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
}

void at_thread_end(ThreadEnd& link) noexcept { link.next = std::exchange(ends.first, &link); }

}  // namespace rr::platform
