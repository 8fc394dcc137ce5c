// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "compiler/diagnostics/report.hpp"

/// Limits that the language cannot express, given in the documentation of a member or field
/// (docs/decisions/0011-limits-for-boards.md).
namespace robdef::arduino {

class Limits {
 public:
  /// Reads the lines of `documentation` that begin with `@limit`. `span` is of what is documented;
  /// a line that cannot be understood is reported there (R0923).
  Limits(std::string_view documentation, Span span, Report& report);

  /// The limit for a parameter, `return`, or, with an empty name, the value itself.
  [[nodiscard]] std::optional<std::uint32_t> of(std::string_view name) const;
  /// Reports names that nobody has asked for (R0923).
  void report_unused(Report& report) const;

 private:
  struct Limit {
    std::uint32_t value = 0;
    mutable bool is_used = false;
  };
  std::map<std::string, Limit, std::less<>> limits_;
  Span span_;
};

/// Documentation without the lines that are for boards.
std::string without_limits(std::string_view documentation);
/// Whether a line says `@root`.
bool is_marked_root(std::string_view documentation);

}  // namespace robdef::arduino
