// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/platform/sleep_word.hpp"

#include <windows.h>

#include <algorithm>
#include <chrono>

namespace rr::platform {

static_assert(sizeof(SleepWord) == sizeof(std::uint32_t) && SleepWord::is_always_lock_free,
              "the system looks at the word");

bool sleep_on(const SleepWord& word, std::uint32_t seen, Time deadline) {
  DWORD patience = INFINITE;
  if (deadline != Time::max()) {
    constexpr std::int64_t longest = 1'000'000'000;
    const auto left =
        std::chrono::ceil<std::chrono::milliseconds>(deadline - std::chrono::steady_clock::now());
    patience = static_cast<DWORD>(std::clamp<std::int64_t>(left.count(), 0, longest));
  }
  auto* const address = const_cast<SleepWord*>(&word);
  return WaitOnAddress(address, &seen, sizeof seen, patience) != FALSE ||
         GetLastError() != ERROR_TIMEOUT || std::chrono::steady_clock::now() < deadline;
}

void wake(const SleepWord* word) { WakeByAddressSingle(const_cast<SleepWord*>(word)); }

}  // namespace rr::platform
