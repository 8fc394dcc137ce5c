// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/sim/options.hpp"

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string_view>

namespace rr::sim {

const char* const usage =
    "usage: rr_sim [--scenario NAME] [--seed N | --from N --count N | --seconds S] [--first]\n"
    "              [--repeat]\n"
    "       rr_sim --seeds FILE | --planted\n"
    "  --scenario   sessions, links, scarce, finding, inside, streaming; each seed has one of "
    "them\n"
    "               otherwise\n"
    "  --seed N     one run; when it fails its last steps are printed (RR_SIM_STEPS of them)\n"
    "  --count N    so many seeds, from 1 or --from on\n"
    "  --seconds S  as many seeds as there is time for\n"
    "  --first      stops at the first failure\n"
    "  --repeat     each seed twice: both runs must be the same\n"
    "  --seeds      the runs of a file: a scenario and a seed in each line\n"
    "  --planted    scenarios with faults: each must be found\n";

const Scenario* scenario_named(const std::string& name) {
  for (const Scenario& each : scenarios()) {
    if (each.name == name) return &each;
  }
  return nullptr;
}

namespace {

bool* flag_of(std::string_view word, Options& options) {
  if (word == "--repeat") return &options.repeats;
  if (word == "--planted") return &options.looks_for_planted;
  return word == "--first" ? &options.stops_at_first : nullptr;
}

}  // namespace

bool read_options(int count, char** words, Options& options) {
  for (int i = 1; i < count; ++i) {
    const std::string_view word = words[i];
    bool* const flag = flag_of(word, options);
    if (flag != nullptr) {
      *flag = true;
      continue;
    }
    if (i + 1 == count) return false;
    const char* const value = words[++i];
    const std::uint64_t number = std::strtoull(value, nullptr, 10);
    if (word == "--scenario") {
      options.scenario = scenario_named(value);
      if (options.scenario == nullptr) return false;
    } else if (word == "--seed" || word == "--from") {
      options.from = number;
    } else if (word == "--count") {
      options.count = number;
    } else if (word == "--seconds") {
      options.time = std::chrono::seconds(number);
    } else if (word == "--seeds") {
      options.seeds_file = value;
    } else {
      return false;
    }
  }
  return true;
}

std::vector<Wanted> read_seeds(const std::string& path) {
  std::ifstream file(path);
  std::vector<Wanted> wanted;
  std::string line;
  for (int number = 1; std::getline(file, line); ++number) {
    if (line.empty() || line.front() == '#') continue;
    std::istringstream words(line);
    std::string name;
    std::uint64_t seed = 0;
    words >> name >> seed;
    const Scenario* const scenario = scenario_named(name);
    if (!words || scenario == nullptr) {
      std::fprintf(stderr, "%s:%d: not a scenario and a seed\n", path.c_str(), number);
      std::exit(2);
    }
    wanted.push_back({scenario, seed});
  }
  if (wanted.empty()) {
    std::fprintf(stderr, "%s: no seeds\n", path.c_str());
    std::exit(2);
  }
  return wanted;
}

}  // namespace rr::sim
