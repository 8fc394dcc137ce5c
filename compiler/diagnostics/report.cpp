// SPDX-License-Identifier: Apache-2.0
#include "compiler/diagnostics/report.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

namespace robdef {
namespace {

// In codes.def each explanation begins on a line of its own, for the eye.
constexpr std::string_view without_first_break(std::string_view text) {
  return text.starts_with('\n') ? text.substr(1) : text;
}

bool same_finding(const Diagnostic* a, const Diagnostic* b) {
  return a->code() == b->code() && a->primary().span == b->primary().span;
}

// Findings at one place stay in the order in which they were made.
struct Place {
  const Diagnostic* diagnostic;
  std::size_t order;

  bool operator<(const Place& other) const { return key() < other.key(); }

 private:
  [[nodiscard]] std::tuple<SourceId, std::uint32_t, std::uint32_t, Code, std::size_t> key() const {
    const Span span = diagnostic->primary().span;
    return {span.source, span.begin, span.end, diagnostic->code(), order};
  }
};

}  // namespace

const std::vector<CodeEntry>& code_entries() {
  static const std::vector<CodeEntry> entries = {
#define ROBDEF_CODE(code, rule, severity, summary, explanation) \
  CodeEntry{Code::code, #code, rule, Severity::severity, summary, without_first_break(explanation)},
#include "compiler/diagnostics/codes.def"
#undef ROBDEF_CODE
  };
  return entries;
}

const CodeEntry& entry_of(Code code) { return code_entries()[static_cast<std::size_t>(code)]; }

const CodeEntry* find_code(std::string_view name) {
  const auto& entries = code_entries();
  const auto found = std::find_if(entries.begin(), entries.end(),
                                  [name](const CodeEntry& entry) { return entry.name == name; });
  return found == entries.end() ? nullptr : &*found;
}

Diagnostic::Diagnostic(Code code, Span span, std::string message)
    : code_(code), message_(std::move(message)), primary_{span, {}} {}

Diagnostic& Diagnostic::label(std::string text) {
  primary_.text = std::move(text);
  return *this;
}

Diagnostic& Diagnostic::also(Span span, std::string text) {
  constexpr std::size_t most = 2;
  if (secondary_.size() < most) secondary_.push_back({span, std::move(text)});
  return *this;
}

Diagnostic& Diagnostic::help(std::string text) {
  helps_.push_back(std::move(text));
  return *this;
}

Diagnostic& Diagnostic::note(std::string text) {
  notes_.push_back(std::move(text));
  return *this;
}

Diagnostic& Report::add(Code code, Span span, std::string message) {
  if (entry_of(code).severity == Severity::error) ++errors_;
  return diagnostics_.emplace_back(code, span, std::move(message));
}

void Report::silence(Code warning) {
  if (entry_of(warning).severity == Severity::warning) silenced_.push_back(warning);
}

std::vector<const Diagnostic*> Report::sorted() const {
  std::vector<Place> places;
  for (const Diagnostic& diagnostic : diagnostics_) {
    const bool is_silenced =
        std::find(silenced_.begin(), silenced_.end(), diagnostic.code()) != silenced_.end();
    if (!is_silenced) places.push_back({&diagnostic, places.size()});
  }
  std::sort(places.begin(), places.end());
  std::vector<const Diagnostic*> result;
  for (const Place& place : places) {
    const bool is_repeated = !result.empty() && same_finding(result.back(), place.diagnostic);
    if (!is_repeated) result.push_back(place.diagnostic);
  }
  return result;
}

}  // namespace robdef
