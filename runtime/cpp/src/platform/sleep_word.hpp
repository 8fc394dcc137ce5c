// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>

#include "runtime/cpp/src/platform/clock.hpp"

namespace rr::platform {

/// A word on which one thread sleeps until others have changed it. Unlike a condition variable it
/// needs no lock, and who wakes the thread does not touch the word again: it may be gone by then.
using SleepWord = std::atomic<std::uint32_t>;

/// Sleeps while the word is `seen`; returns for no reason, too. False when the deadline has come;
/// Time::max() is none.
bool sleep_on(const SleepWord& word, std::uint32_t seen, Time deadline);
/// Wakes the thread that sleeps on the word, which must have been changed before. `word` is an
/// address only.
void wake(const SleepWord* word);

}  // namespace rr::platform
