// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include "runtime/cpp/sim/scenario.hpp"

namespace rr::sim {

/// A run to be made.
struct Wanted {
  const Scenario* scenario;
  std::uint64_t seed;
};

/// What the program is asked for.
struct Options {
  const Scenario* scenario = nullptr;  ///< null: each seed has one
  std::uint64_t from = 1;
  std::uint64_t count = 1;
  std::chrono::seconds time{0};  ///< instead of a count
  bool repeats = false;          ///< each seed twice
  bool looks_for_planted = false;
  bool stops_at_first = false;
  std::string seeds_file{};  ///< of seeds that have found something once
};

extern const char* const usage;

/// False when the words are no options.
bool read_options(int count, char** words, Options& options);
/// The lines of a file: scenario and seed. Ends the program when it cannot be read.
std::vector<Wanted> read_seeds(const std::string& path);
/// The scenario of a name; null for none.
const Scenario* scenario_named(const std::string& name);

}  // namespace rr::sim
