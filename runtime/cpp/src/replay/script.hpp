// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "rr/recording.hpp"

namespace rr::replay {

/// What happened on the connections of a recording, in the order in which it is played: messages
/// that were never sent are left out, and those that took their place stand there.
struct Script {
  struct Opened {};
  struct Closed {};
  struct Step {
    std::chrono::nanoseconds time{};
    std::uint32_t connection = 0;
    std::variant<RecordedMessage, Opened, Closed> what;
  };

  std::vector<Step> steps;
  /// What a recording lacks, in words.
  std::vector<std::string> gaps;
};

/// Reads a recording, or one connection of it. A connection that both of its sides have recorded
/// into the same file is taken once. Throws rr::Error.
Script read_script(const std::filesystem::path& recording,
                   std::optional<std::uint32_t> connection = {});

}  // namespace rr::replay
