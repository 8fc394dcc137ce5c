// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/platform/sleep_word.hpp"

#include <linux/futex.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <ctime>

namespace rr::platform {
namespace {

constexpr Time never = Time::max();

}  // namespace

static_assert(sizeof(SleepWord) == sizeof(std::uint32_t) && SleepWord::is_always_lock_free,
              "the kernel looks at the word");

bool sleep_on(const SleepWord& word, std::uint32_t seen, Time deadline) {
  timespec until{};
  if (deadline != never) {
    // The kernel's monotonic clock is the one of Time; it takes no time before its beginning.
    const auto since = std::max(deadline.time_since_epoch(), Time::duration::zero());
    const auto seconds = std::chrono::floor<std::chrono::seconds>(since);
    until.tv_sec = seconds.count();
    until.tv_nsec = std::chrono::nanoseconds(since - seconds).count();
  }
  const long result =
      syscall(SYS_futex, &word, FUTEX_WAIT_BITSET_PRIVATE, seen,
              deadline == never ? nullptr : &until, nullptr, FUTEX_BITSET_MATCH_ANY);
  return result == 0 || errno != ETIMEDOUT;
}

void wake(const SleepWord* word) {
  syscall(SYS_futex, word, FUTEX_WAKE_PRIVATE, 1, nullptr, nullptr, 0);
}

}  // namespace rr::platform
