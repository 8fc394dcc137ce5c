// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>
#include <unordered_map>
#include <vector>

#include "compiler/diagnostics/report.hpp"
#include "compiler/model/model.hpp"

namespace robdef::model {

/// The lines that could not be parsed. What they would have declared is missing from the model, and
/// a pass that misses something asks here first, so that one mistake is reported once.
class SyntaxErrors {
 public:
  explicit SyntaxErrors(const Report& report);

  /// Whether anything in the definition's file could not be parsed.
  [[nodiscard]] bool any_in(const Definition& definition) const;
  /// Whether a line that could not be parsed holds the word.
  [[nodiscard]] bool mention(const Definition& definition, std::string_view word) const;

 private:
  std::unordered_map<std::uint32_t, std::vector<Span>> spans_;
};

}  // namespace robdef::model
