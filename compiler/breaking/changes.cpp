// SPDX-License-Identifier: Apache-2.0
#include "compiler/breaking/changes.hpp"

#include <utility>

namespace robdef::breaking {

Diagnostic& Changes::add(Code code, Span old_place, std::optional<Span> new_place,
                         std::string message) {
  const Rule& rule = *find_rule(code);
  const bool is_wanted =
      rule.categories.meets(wanted_.categories) && !wanted_.allowed.contains(code);
  if (is_wanted) ++count_;
  Diagnostic diagnostic(code, new_place.value_or(old_place), std::move(message));
  diagnostic.label(new_place ? "new" : "old");
  if (new_place) diagnostic.also(old_place, "old");
  diagnostic.note(rule.categories.text() + ": " + std::string(rule.effect));
  if (!is_wanted || list_.size() >= most) return dropped_.emplace(std::move(diagnostic));
  return list_.emplace_back(Change{&rule, std::move(diagnostic), old_place, new_place}).diagnostic;
}

}  // namespace robdef::breaking
