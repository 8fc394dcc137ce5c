// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
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
  /// Whether lines that could not be parsed hold the word, or the parts of a qualified name. Not
  /// for several threads at once.
  [[nodiscard]] bool mention(const Definition& definition, std::string_view word) const;

 private:
  struct File {
    std::vector<Span> spans;
    std::optional<std::unordered_set<std::string_view>> words;  // on their lines; when first asked
  };
  mutable std::unordered_map<std::uint32_t, File> files_;
};

}  // namespace robdef::model
