// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>

namespace rr::realtime::testing {

/// What a thread has cost while it was watched.
struct Cost {
  std::atomic<std::uint64_t> allocations{
      0};                               ///< malloc, calloc, realloc, free, and all that calls them
  std::atomic<std::uint64_t> locks{0};  ///< mutexes, condition variables
  std::atomic<std::uint64_t> kernel_calls{0};  ///< but for clock, send and receive
  std::atomic<std::int64_t> last_call{-1};     ///< number of the last of these
  std::atomic<bool> is_watched{false};         ///< the kernel let its calls be watched
  std::atomic<bool> is_over{false};
};

/// Whether this build can count: the sanitizers replace what is watched.
bool can_watch();
/// Runs `prepare`, which gives the function to be watched, in a process of its own, which ends with
/// it; its other threads go on meanwhile. What it cost; `report` may hand numbers back.
void watch(Cost& cost, const std::function<std::function<void()>()>& prepare);
/// Counts what the calling thread allocates and locks, as long as it lives.
class Watched {
 public:
  explicit Watched(Cost& cost);
  ~Watched();
  Watched(const Watched&) = delete;
  Watched& operator=(const Watched&) = delete;
};
/// Memory that both processes see, for a Cost and whatever is reported.
void* shared_memory(std::size_t size);

}  // namespace rr::realtime::testing
