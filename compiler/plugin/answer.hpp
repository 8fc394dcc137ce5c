// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/diagnostics/report.hpp"
#include "compiler/diagnostics/source.hpp"
#include "compiler/output/file_set.hpp"

/// What a plug-in answers.
namespace robdef::plugin {

/// Limits of an answer. A larger one is refused as a whole.
inline constexpr std::size_t largest_answer = std::size_t{64} << 20;  ///< bytes
inline constexpr std::size_t most_values = 1'000'000;  ///< of JSON, whatever they are
inline constexpr std::size_t most_findings = 10'000;
inline constexpr std::size_t longest_path = 1'000;  ///< bytes

struct Finding {
  Severity severity = Severity::error;
  std::string message;
  std::optional<Span> at;
};

struct Answer {
  FileSet files;
  std::vector<Finding> findings;
};

/// Reads an answer and checks all of it. `sources` are what places may name. Throws PluginError,
/// whose message begins with what is wrong and does not name the plug-in.
Answer read_answer(std::string_view text, const Sources& sources,
                   const std::filesystem::path& folder);

}  // namespace robdef::plugin
