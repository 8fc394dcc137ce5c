// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <unordered_map>

#include "rr/definition.hpp"
#include "rr/mutex.hpp"

namespace rr::service {

/// How large the answers of the members of a service are, for those that have given large ones:
/// what a handler makes counts before it is made (docs/reference/limits.md). Any thread.
class AnswerSizes {
 public:
  /// Answers below this are not counted, in bytes.
  static constexpr std::size_t large = 256 * 1024;

  /// Bytes that the next answer of a member will probably have; 0 for a small one.
  [[nodiscard]] std::size_t expected(const Member& member) const;
  /// A member has given an answer. A larger one counts at once; smaller ones are believed slowly,
  /// because the client may choose the size.
  void note(const Member& member, std::size_t bytes);

 private:
  std::atomic<bool> has_any_{false};  // so that services with small answers do not lock
  mutable Mutex mutex_;
  std::unordered_map<const Member*, std::size_t> sizes_ RR_GUARDED_BY(mutex_);
};

}  // namespace rr::service
