// SPDX-License-Identifier: Apache-2.0
#include "compiler/model/syntax_errors.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "compiler/syntax/words.hpp"

namespace robdef::model {
namespace {

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

// The words of a text, each once.
void add_words(std::string_view text, std::unordered_set<std::string_view>& words) {
  std::size_t begin = 0;
  for (std::size_t at = 0; at <= text.size(); ++at) {
    if (at < text.size() && syntax::is_word_character(text[at])) continue;
    if (at > begin) words.insert(text.substr(begin, at - begin));
    begin = at + 1;
  }
}

}  // namespace

SyntaxErrors::SyntaxErrors(const Report& report) {
  if (!report.has_errors()) return;
  for (const Diagnostic* diagnostic : report.sorted()) {
    const std::string_view rule = entry_of(diagnostic->code()).rule;
    const bool is_syntax = !rule.empty() && (rule.front() == 'L' || rule.front() == 'P');
    if (diagnostic->severity() != Severity::error || !is_syntax) continue;
    const Span span = diagnostic->primary().span;
    files_[static_cast<std::uint32_t>(span.source)].spans.push_back(span);
  }
}

bool SyntaxErrors::any_in(const Definition& definition) const {
  return files_.contains(static_cast<std::uint32_t>(definition.source));
}

bool SyntaxErrors::mention(const Definition& definition, std::string_view word) const {
  const auto found = files_.find(static_cast<std::uint32_t>(definition.source));
  if (found == files_.end() || word.empty()) return false;
  File& file = found->second;
  if (!file.words) {
    std::unordered_set<std::string_view>& words = file.words.emplace();
    std::string_view before;
    for (const Span span : file.spans) {
      const std::string_view lines = lines_of(definition.text, span);
      if (lines.data() != before.data()) add_words(lines, words);
      before = lines;
    }
  }
  std::unordered_set<std::string_view> parts;
  add_words(word, parts);
  return std::all_of(parts.begin(), parts.end(),
                     [&](std::string_view part) { return file.words->contains(part); });
}

}  // namespace robdef::model
