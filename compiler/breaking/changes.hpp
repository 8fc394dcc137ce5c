// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <set>
#include <vector>

#include "compiler/breaking/rules.hpp"
#include "compiler/diagnostics/report.hpp"

namespace robdef::breaking {

/// One breaking change. The diagnostic's own place is the new one, its second place the old one,
/// unless nothing is left of what the old one was part of.
struct Change {
  const Rule* rule = nullptr;
  Diagnostic diagnostic;
  Span old_place;
  std::optional<Span> new_place;  ///< none: nothing there corresponds to the old place
};

/// Which changes are asked for.
struct Wanted {
  Categories categories = Categories::all();
  std::set<Code> allowed;  ///< not reported
};

/// What compare() finds, in the order of the old definitions.
class Changes {
 public:
  explicit Changes(Wanted wanted = {}) : wanted_(std::move(wanted)) {}

  /// How many are kept; further ones are counted. Nobody reads more, and a text from the network
  /// decides how many there are.
  static constexpr std::size_t most = 10'000;

  /// The reference is valid until the next call.
  Diagnostic& add(Code code, Span old_place, std::optional<Span> new_place, std::string message);

  [[nodiscard]] const std::vector<Change>& list() const { return list_; }
  /// All, those that are not kept included.
  [[nodiscard]] std::size_t count() const { return count_; }

 private:
  Wanted wanted_;
  std::vector<Change> list_;
  std::size_t count_ = 0;
  std::optional<Diagnostic> dropped_;
};

}  // namespace robdef::breaking
