// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <random>
#include <vector>

namespace rr::serial::testing {

/// What a bad line makes of bytes. The same seed damages the same way.
class BadLine {
 public:
  struct Rates {
    double damage = 0;  ///< a byte becomes another one
    double drop = 0;    ///< a byte is lost
    double twice = 0;   ///< a byte comes twice
    double burst = 0;   ///< before a byte there are up to 20 of noise
    double half = 0;    ///< of what is sent at once the rest is lost
  };
  BadLine(const Rates& rates, unsigned seed) : rates_(rates), random_(seed) {}

  std::vector<std::uint8_t> pass(const std::vector<std::uint8_t>& bytes) {
    std::vector<std::uint8_t> result;
    for (const std::uint8_t byte : bytes) {
      if (happens(rates_.half)) break;
      if (happens(rates_.burst)) {
        for (auto count = random_() % 20; count > 0; --count) result.push_back(any());
      }
      if (happens(rates_.drop)) continue;
      if (happens(rates_.damage)) {
        result.push_back(static_cast<std::uint8_t>(byte ^ (1 + random_() % 255)));
      } else {
        result.push_back(byte);
      }
      if (happens(rates_.twice)) result.push_back(result.back());
    }
    return result;
  }
  void end_noise() { rates_ = {}; }

 private:
  bool happens(double rate) { return rate > 0 && chance_(random_) < rate; }
  std::uint8_t any() { return static_cast<std::uint8_t>(random_()); }

  Rates rates_;
  std::mt19937 random_;
  std::uniform_real_distribution<double> chance_{0, 1};
};

}  // namespace rr::serial::testing
