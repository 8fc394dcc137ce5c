// SPDX-License-Identifier: Apache-2.0
#include "compiler/backends/name_set.hpp"

namespace robdef {

bool NameSet::add(const std::string& name, Span span, std::string_view what) {
  const auto [place, is_new] = taken_.emplace(name, span);
  if (is_new) return true;
  report_
      .add(Code::R0901, span,
           "the " + std::string(language_) + " name `" + name + "` is made twice")
      .label("the " + std::string(what) + " made here")
      .also(place->second, "is called like this one");
  return false;
}

void report_renamed(std::string_view name, std::string_view renamed, std::string_view language,
                    Span span, Report& report) {
  if (renamed == name) return;
  report
      .add(Code::R0903, span, "`" + std::string(name) + "` is reserved in " + std::string(language))
      .label("becomes `" + std::string(renamed) + "`");
}

}  // namespace robdef
