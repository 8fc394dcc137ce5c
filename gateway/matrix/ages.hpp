// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "rr/mutex.hpp"

namespace rr::gateway::matrix {

/// How old values were when they arrived, by the phase of the run. Any thread may use it.
class Ages {
 public:
  /// Ages that are added from now on belong to this phase.
  void begin(const std::string& phase) {
    const MutexLock lock(mutex_);
    phase_ = phase;
  }
  /// In seconds.
  void add(double age) {
    const MutexLock lock(mutex_);
    ages_[phase_].push_back(age);
  }
  /// As JSON: an object with a list of ages in milliseconds for each phase, sorted.
  [[nodiscard]] std::string json() const {
    const MutexLock lock(mutex_);
    std::ostringstream text;
    text << "{";
    for (const auto& [phase, all] : ages_) {
      text << (text.tellp() > 1 ? ", " : "") << "\"" << phase << "\": [";
      std::vector<double> sorted = all;
      std::ranges::sort(sorted);
      for (std::size_t i = 0; i < sorted.size(); ++i) {
        text << (i == 0 ? "" : ", ") << sorted[i] * 1'000;
      }
      text << "]";
    }
    text << "}";
    return text.str();
  }

 private:
  mutable Mutex mutex_;
  std::string phase_ RR_GUARDED_BY(mutex_) = "start";
  std::map<std::string, std::vector<double>> ages_ RR_GUARDED_BY(mutex_);
};

}  // namespace rr::gateway::matrix
