// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/service/answer_sizes.hpp"

#include <algorithm>

namespace rr::service {
namespace {

// What a smaller answer takes off: a hundred of them, 80 %.
constexpr std::size_t fading = 64;

}  // namespace

[[gnu::hot]] std::size_t AnswerSizes::expected(const Member& member) const {
  if (!has_any_.load(std::memory_order_relaxed)) return 0;
  const MutexLock lock(mutex_);
  const auto found = sizes_.find(&member);
  return found != sizes_.end() ? found->second : 0;
}

[[gnu::hot]] void AnswerSizes::note(const Member& member, std::size_t bytes) {
  if (bytes < large && !has_any_.load(std::memory_order_relaxed)) return;
  const MutexLock lock(mutex_);
  const auto found = sizes_.find(&member);
  if (found == sizes_.end()) {
    if (bytes < large) return;
    sizes_.emplace(&member, bytes);
    has_any_.store(true, std::memory_order_relaxed);
    return;
  }
  std::size_t& size = found->second;
  size = std::max(bytes, size - size / fading);
  if (size < large) sizes_.erase(found);
}

}  // namespace rr::service
