// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <deque>
#include <string>
#include <string_view>
#include <unordered_set>
#include <vector>

#include "rr/mutex.hpp"
#include "rr/url.hpp"

namespace rr::endpoint {

/// The URLs that discovery has given to the program: whoever is on the network can have made them
/// up, so they are told apart from those that the program has from elsewhere. The service that a
/// URL names does not count. Any thread may use it.
class FoundUrls {
 public:
  /// What is no URL is not remembered. The oldest is forgotten when there are too many.
  void add(const std::vector<std::string>& urls);
  [[nodiscard]] bool contains(const Url& url) const;

  static constexpr std::size_t capacity = 65'536;

 private:
  mutable Mutex mutex_;
  std::unordered_set<std::string> known_ RR_GUARDED_BY(mutex_);
  std::deque<const std::string*> order_ RR_GUARDED_BY(mutex_);  // oldest first
};

}  // namespace rr::endpoint
