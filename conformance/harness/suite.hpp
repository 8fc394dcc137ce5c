// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "conformance/harness/report.hpp"
#include "conformance/harness/service_replay.hpp"

namespace rr::conformance {

/// Where a service listens.
struct Address {
  std::string host;
  int port = 0;
};

struct Options {
  std::filesystem::path captures;
  std::string language = "cpp";
  std::vector<std::string> runner;  ///< command of the language's runner
  std::optional<Address> connect;   ///< a foreign service
  std::vector<std::string> channels{"tcp"};
  std::string gateway;        ///< the program for the channels over a broker
  std::size_t jobs = 1;       ///< how many scenarios are played with a runner at once
  std::vector<Role> roles;    ///< those the language has; empty for all
  std::string before;         ///< shell command that resets it before a scenario
  std::optional<int> listen;  ///< port for a foreign client
  std::string only;           ///< regular expression of scenario names; empty for all
  std::optional<std::filesystem::path> expected;
  std::optional<std::filesystem::path> deviations;
  bool deviations_are_borrowed = false;       ///< from other captures
  std::optional<std::filesystem::path> json;  ///< where the matrix is written
};

/// Plays all of a folder with a runner, all services of it against a foreign client, or all clients
/// against a foreign service. Returns true when everything holds.
bool run_suite(const Options& options);

}  // namespace rr::conformance
