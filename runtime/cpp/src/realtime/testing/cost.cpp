// SPDX-License-Identifier: Apache-2.0
// Counts what a thread allocates and locks, by standing in front of the C library's functions, and
// what it asks of the kernel, by a filter that sends the thread a signal for each call that is not
// allowed.
#include "runtime/cpp/src/realtime/testing/cost.hpp"

#include <dlfcn.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <pthread.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstddef>
#include <cstdlib>
#include <stdexcept>

namespace {

thread_local rr::realtime::testing::Cost* watched = nullptr;
rr::realtime::testing::Cost* of_process = nullptr;

[[maybe_unused]] void count_allocation() {
  if (watched != nullptr) ++watched->allocations;
}
[[maybe_unused]] void count_lock() {
  if (watched != nullptr) ++watched->locks;
}

}  // namespace

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define ROBDEF_CANNOT_WATCH
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define ROBDEF_CANNOT_WATCH
#endif
#endif

#ifndef ROBDEF_CANNOT_WATCH
extern "C" {
// The names of the C library.
// NOLINTBEGIN(bugprone-reserved-identifier, readability-identifier-naming)
void* __libc_malloc(size_t size);
void* __libc_calloc(size_t count, size_t size);
void* __libc_realloc(void* memory, size_t size);
void __libc_free(void* memory);
// NOLINTEND(bugprone-reserved-identifier, readability-identifier-naming)

void* malloc(size_t size) {
  count_allocation();
  return __libc_malloc(size);
}
void* calloc(size_t count, size_t size) {
  count_allocation();
  return __libc_calloc(count, size);
}
void* realloc(void* memory, size_t size) {
  count_allocation();
  return __libc_realloc(memory, size);
}
void free(void* memory) {
  count_allocation();
  __libc_free(memory);
}
int pthread_mutex_lock(pthread_mutex_t* mutex) {
  using Function = int (*)(pthread_mutex_t*);
  static const auto next = reinterpret_cast<Function>(dlsym(RTLD_NEXT, "pthread_mutex_lock"));
  count_lock();
  return next(mutex);
}
int pthread_cond_wait(pthread_cond_t* condition, pthread_mutex_t* mutex) {
  using Function = int (*)(pthread_cond_t*, pthread_mutex_t*);
  static const auto next = reinterpret_cast<Function>(dlsym(RTLD_NEXT, "pthread_cond_wait"));
  count_lock();
  return next(condition, mutex);
}
}
#endif

namespace rr::realtime::testing {
namespace {

void on_call(int /*signal*/, siginfo_t* info, void* /*context*/) {
  ++of_process->kernel_calls;
  of_process->last_call = info->si_syscall;
}

/// From here on this thread may use clock, send and receive, and end its process; anything else is
/// counted, and not done.
bool watch_kernel_calls() {
  struct sigaction action {};
  action.sa_sigaction = on_call;
  action.sa_flags = SA_SIGINFO;
  if (sigaction(SIGSYS, &action, nullptr) != 0) return false;
  constexpr std::uint32_t allowed[] = {SYS_clock_nanosleep, SYS_clock_gettime, SYS_sendto,
                                       SYS_recvfrom,        SYS_exit_group,    SYS_rt_sigreturn};
  constexpr std::size_t count = std::size(allowed);
  sock_filter program[count + 3];
  program[0] = BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr));
  for (std::size_t i = 0; i < count; ++i) {
    program[i + 1] =
        BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, allowed[i], static_cast<std::uint8_t>(count - i), 0);
  }
  program[count + 1] = BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_TRAP);
  program[count + 2] = BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW);
  const sock_fprog filter{static_cast<unsigned short>(count + 3), program};
  return prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 &&
         syscall(SYS_seccomp, SECCOMP_SET_MODE_FILTER, 0, &filter) == 0;
}

}  // namespace

bool can_watch() {
#ifdef ROBDEF_CANNOT_WATCH
  return false;
#else
  return true;
#endif
}

Watched::Watched(Cost& cost) { watched = &cost; }
Watched::~Watched() { watched = nullptr; }

void* shared_memory(std::size_t size) {
  void* const memory =
      mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) throw std::runtime_error("no shared memory");
  return memory;
}

void watch(Cost& cost, const std::function<std::function<void()>()>& prepare) {
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error("no process");
  if (child == 0) {
    const std::function<void()> function = prepare();
    of_process = &cost;
    cost.is_watched = watch_kernel_calls();
    watched = &cost;
    function();
    watched = nullptr;
    cost.is_over = true;
    _exit(0);
  }
  waitpid(child, nullptr, 0);
}

}  // namespace rr::realtime::testing
