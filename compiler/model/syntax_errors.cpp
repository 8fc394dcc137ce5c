// SPDX-License-Identifier: Apache-2.0
#include "compiler/model/syntax_errors.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "compiler/syntax/words.hpp"

namespace robdef::model {
namespace {

bool has_word(std::string_view text, std::string_view word) {
  for (std::size_t at = text.find(word); at != text.npos; at = text.find(word, at + 1)) {
    const std::size_t end = at + word.size();
    const bool begins = at == 0 || !syntax::is_word_character(text[at - 1]);
    if (begins && (end == text.size() || !syntax::is_word_character(text[end]))) return true;
  }
  return false;
}

// The whole lines on which the span lies.
std::string_view lines_of(std::string_view text, Span span) {
  const std::size_t first = std::min<std::size_t>(span.begin, text.size());
  const std::size_t end_of_span = span.end > span.begin ? span.end - 1 : span.begin;
  const std::size_t last = std::min<std::size_t>(end_of_span, text.size());
  const std::size_t before = first == 0 ? text.npos : text.rfind('\n', first - 1);
  const std::size_t begin = before == text.npos ? 0 : before + 1;
  const std::size_t end = text.find('\n', last);
  return text.substr(begin, end == text.npos ? text.npos : end - begin);
}

}  // namespace

SyntaxErrors::SyntaxErrors(const Report& report) {
  if (!report.has_errors()) return;
  for (const Diagnostic* diagnostic : report.sorted()) {
    const std::string_view rule = entry_of(diagnostic->code()).rule;
    const bool is_syntax = !rule.empty() && (rule.front() == 'L' || rule.front() == 'P');
    if (diagnostic->severity() != Severity::error || !is_syntax) continue;
    const Span span = diagnostic->primary().span;
    spans_[static_cast<std::uint32_t>(span.source)].push_back(span);
  }
}

bool SyntaxErrors::any_in(const Definition& definition) const {
  return spans_.contains(static_cast<std::uint32_t>(definition.source));
}

bool SyntaxErrors::mention(const Definition& definition, std::string_view word) const {
  const auto found = spans_.find(static_cast<std::uint32_t>(definition.source));
  if (found == spans_.end() || word.empty()) return false;
  return std::any_of(found->second.begin(), found->second.end(),
                     [&](Span span) { return has_word(lines_of(definition.text, span), word); });
}

}  // namespace robdef::model
