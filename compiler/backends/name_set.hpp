// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <string>
#include <string_view>

#include "compiler/diagnostics/report.hpp"

namespace robdef {

/// Names that must differ in the target language, with where each comes from.
class NameSet {
 public:
  /// `language` as in "the C# name `x` is made twice".
  NameSet(std::string_view language, Report& report) : language_(language), report_(report) {}
  /// Reports R0901 for a name that is there. `what` says what is called so: `stub`.
  /// False when it was there.
  bool add(const std::string& name, Span span, std::string_view what);

 private:
  std::string_view language_;
  Report& report_;
  std::map<std::string, Span, std::less<>> taken_;
};

/// Reports R0903 when a name of the definition had to be changed.
void report_renamed(std::string_view name, std::string_view renamed, std::string_view language,
                    Span span, Report& report);

}  // namespace robdef
