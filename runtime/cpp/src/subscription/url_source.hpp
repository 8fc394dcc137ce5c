// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "rr/mutex.hpp"
#include "rr/service_filter.hpp"
#include "runtime/cpp/src/endpoint/core.hpp"

namespace rr::subscription {

class Services;

/// Services that the program names by URLs: they have appeared for as long as it says so.
class UrlSource {
 public:
  explicit UrlSource(Services& services) : services_(services) {}

  /// Of each service its URLs.
  using Lists = std::vector<FoundService>;
  /// Throws rr::Error (invalid_argument) unless each list has URLs, all of the same service, which
  /// those of channels that lead to one service only may leave out.
  static Lists checked(endpoint::Core& core, std::vector<std::vector<std::string>> lists);

  /// These from now on. A service that shares a URL with one before is the same.
  void replace(const Lists& lists);

 private:
  Services& services_;
  Mutex mutex_;  // while it is changed; before those of Services
  std::map<std::string, std::vector<std::string>> known_ RR_GUARDED_BY(mutex_);
  std::uint64_t last_key_ RR_GUARDED_BY(mutex_) = 0;
};

}  // namespace rr::subscription
