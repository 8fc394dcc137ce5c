// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "rr/mutex.hpp"

namespace rr::gateway::matrix {

/// How old values of several sources were when a reader had them or newer ones, by the phase of the
/// run. Any thread may use it.
class Ages {
 public:
  /// Ages that are added from now on belong to this phase.
  void begin(const std::string& phase) {
    const MutexLock lock(mutex_);
    phase_ = phase;
  }
  /// At time `now` a value has arrived that was sent at time `sent`, in seconds. Sources count
  /// their values from 1; one that is not newer than those before it is ignored. Values between the
  /// one before and this are superseded by it: they count as well, as sent at even intervals.
  /// Without that a broker that drops values would look faster than one that delivers them late.
  void arrived(std::uint64_t source, std::uint64_t number, double sent, double now) {
    const MutexLock lock(mutex_);
    Newest& newest = newest_[source];
    if (number <= newest.number) return;
    std::vector<double>& ages = ages_[phase_];
    ages.push_back(now - sent);
    // Over a longer gap the link itself was away.
    if (newest.number > 0 && sent - newest.sent < longest_gap) {
      const auto count = static_cast<double>(number - newest.number);
      const double interval = (sent - newest.sent) / count;
      for (double i = 1; i < count; ++i) ages.push_back(now - sent + i * interval);
    }
    newest = {number, sent};
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
  struct Newest {
    std::uint64_t number = 0;
    double sent = 0;
  };

  static constexpr double longest_gap = 15;  // seconds

  mutable Mutex mutex_;
  std::string phase_ RR_GUARDED_BY(mutex_) = "start";
  std::map<std::uint64_t, Newest> newest_ RR_GUARDED_BY(mutex_);
  std::map<std::string, std::vector<double>> ages_ RR_GUARDED_BY(mutex_);
};

}  // namespace rr::gateway::matrix
