// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/platform/threads.hpp"

#include <pthread.h>
#include <windows.h>

#include <memory>
#include <system_error>
#include <utility>

#include "runtime/cpp/src/platform/thread_object.hpp"

namespace rr::platform {
namespace {

void end_links(void* first) {
  auto* link = static_cast<ThreadEnd*>(first);
  while (link != nullptr) {
    ThreadEnd* const next = link->next;
    link->end(*link);
    link = next;
  }
}

// Keys of winpthreads, with which the compiler makes thread_local as well: a destructor that uses
// such a variable gets a new one, which the next round of destructors takes back.
pthread_key_t links_key() {
  static const pthread_key_t key = [] {
    pthread_key_t made{};
    pthread_key_create(&made, end_links);
    return made;
  }();
  return key;
}

void* run(void* given) {
  const std::unique_ptr<std::function<void()>> work(static_cast<std::function<void()>*>(given));
  (*work)();
  return nullptr;
}

}  // namespace

void run_apart(std::function<void()> work) {
  auto given = std::make_unique<std::function<void()>>(std::move(work));
  pthread_attr_t detached;
  pthread_attr_init(&detached);
  pthread_attr_setdetachstate(&detached, PTHREAD_CREATE_DETACHED);
  pthread_t thread{};
  const int error = pthread_create(&thread, &detached, &run, given.get());
  pthread_attr_destroy(&detached);
  if (error != 0) throw std::system_error(error, std::generic_category(), "no thread is free");
  (void)given.release();
}

// Windows has nothing of the kind for a thread of its own.
void prefer_throughput() {}
void ask_for_short_slices() {}

void lower_priority() { SetThreadPriority(GetCurrentThread(), THREAD_PRIORITY_BELOW_NORMAL); }

// Console events have threads of their own.
void leave_signals_to_others() {}

void at_thread_end(ThreadEnd& link) noexcept {
  const pthread_key_t key = links_key();
  link.next = static_cast<ThreadEnd*>(pthread_getspecific(key));
  pthread_setspecific(key, &link);
}

}  // namespace rr::platform
