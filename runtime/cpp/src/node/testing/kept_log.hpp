// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "rr/options.hpp"

namespace rr::testing {

/// What a node logs, from warnings on.
class KeptLog {
 public:
  /// For a node that goes before this.
  NodeOptions options() {
    NodeOptions made;
    made.log = [this](LogLevel level, std::string_view text) {
      const std::lock_guard lock(mutex_);
      if (level >= LogLevel::warning) lines_.emplace_back(text);
    };
    return made;
  }
  /// The lines with a text in them.
  [[nodiscard]] std::vector<std::string> with(std::string_view part) const {
    const std::lock_guard lock(mutex_);
    std::vector<std::string> found;
    for (const std::string& line : lines_) {
      if (line.find(part) != std::string::npos) found.push_back(line);
    }
    return found;
  }
  [[nodiscard]] std::vector<std::string> all() const { return with(""); }

 private:
  mutable std::mutex mutex_;
  std::vector<std::string> lines_;
};

}  // namespace rr::testing
