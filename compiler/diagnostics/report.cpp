// SPDX-License-Identifier: Apache-2.0
#include "compiler/diagnostics/report.hpp"

#include <algorithm>
#include <set>
#include <tuple>
#include <utility>

namespace robdef {
namespace {

// In codes.def each explanation begins on a line of its own, for the eye.
constexpr std::string_view without_first_break(std::string_view text) {
  return text.starts_with('\n') ? text.substr(1) : text;
}

// Several languages may say the same of a name, each with other words.
bool is_of_target(const Diagnostic* finding) {
  return entry_of(finding->code()).name.starts_with("R09");
}

bool same_finding(const Diagnostic* a, const Diagnostic* b) {
  return a->code() == b->code() && a->primary().span == b->primary().span &&
         (!is_of_target(a) || a->message() == b->message());
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

std::string shortened(std::string text) {
  constexpr std::size_t longest = 1000;
  constexpr std::size_t kept = 100;
  if (text.size() <= longest) return text;
  std::string result;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find(' ', begin), text.size() - 1) + 1;
    const bool is_long = end - begin > longest;
    result += text.substr(begin, is_long ? kept : end - begin);
    if (is_long) result += "... ";
    begin = end;
  }
  return result;
}

Diagnostic::Diagnostic(Code code, Span span, std::string message)
    : code_(code),
      severity_(entry_of(code).severity),
      message_(shortened(std::move(message))),
      primary_{span, {}} {}

Diagnostic& Diagnostic::label(std::string text) {
  primary_.text = shortened(std::move(text));
  return *this;
}

Diagnostic& Diagnostic::also(Span span, std::string text) {
  constexpr std::size_t most = 2;
  if (secondary_.size() < most) secondary_.push_back({span, shortened(std::move(text))});
  return *this;
}

Diagnostic& Diagnostic::help(std::string text) {
  helps_.push_back(shortened(std::move(text)));
  return *this;
}

Diagnostic& Diagnostic::edit(Span span, std::string replacement) {
  if (!helps_.empty()) edits_.push_back({helps_.size() - 1, {span, std::move(replacement)}});
  return *this;
}

std::vector<Replacement> Diagnostic::edits_of(std::size_t help) const {
  std::vector<Replacement> result;
  for (const HelpEdit& edit : edits_) {
    if (edit.help == help) result.push_back(edit.replacement);
  }
  return result;
}

Diagnostic& Diagnostic::note(std::string text) {
  notes_.push_back(shortened(std::move(text)));
  return *this;
}

Diagnostic& Report::add(Code code, Span span, std::string message) {
  ++remarks_;
  if (entry_of(code).severity == Severity::error) ++errors_;
  // Warnings of a text from the network are nobody's.
  constexpr std::size_t most = 100;
  if (origin_ == Origin::network && diagnostics_.size() >= most) {
    return dropped_.emplace(code, span, std::move(message));
  }
  Diagnostic& diagnostic = diagnostics_.emplace_back(code, span, std::move(message));
  const auto level = levels_.find(code);
  if (level != levels_.end() && level->second == Level::deny) {
    diagnostic.severity_ = Severity::error;
    diagnostic.note("a warning that is denied");
    denied_.push_back(&diagnostic);
  }
  return diagnostic;
}

bool Report::may_suggest(std::size_t count, std::size_t letters) {
  if (origin_ == Origin::network) return false;
  if (count != 0 && letters > work_left_ / count) return false;
  work_left_ -= count * letters;
  return true;
}

void Report::set_level(Code warning, Level level) {
  if (entry_of(warning).severity != Severity::warning) return;
  if (origin_ == Origin::network && level == Level::deny) return;
  levels_[warning] = level;
}

void Report::allow_at(Code warning, Span place, Span comment) {
  ++remarks_;
  if (origin_ == Origin::network) return;
  allows_[{place.source, warning}].push_back({place, comment});
}

const Report::Allow* Report::allow_of(const Diagnostic& diagnostic) const {
  const Span span = diagnostic.primary().span;
  const auto found = allows_.find({span.source, diagnostic.code()});
  if (found == allows_.end()) return nullptr;
  // Lines are read in their order, so the places are in theirs.
  const std::vector<Allow>& all = found->second;
  const auto behind =
      std::upper_bound(all.begin(), all.end(), span.begin,
                       [](std::uint32_t at, const Allow& one) { return at < one.place.begin; });
  if (behind == all.begin()) return nullptr;
  const Allow& nearest = *(behind - 1);
  return span.begin < nearest.place.end ? &nearest : nullptr;
}

void Report::report_unused_allows() {
  std::set<const Allow*> used;
  for (const Diagnostic& diagnostic : diagnostics_) used.insert(allow_of(diagnostic));
  for (const auto& [key, all] : allows_) {
    const CodeEntry& entry = entry_of(key.second);
    if (entry.name.starts_with("R09")) continue;
    for (const Allow& one : all) {
      if (used.contains(&one)) continue;
      add(Code::R0147, one.comment, "there is no `" + std::string(entry.name) + "` to be allowed")
          .label("stands above no such warning")
          .help("remove it");
    }
  }
}

bool Report::has_errors() const {
  return errors_ > 0 || std::any_of(denied_.begin(), denied_.end(),
                                    [&](const Diagnostic* one) { return is_shown(*one); });
}

bool Report::is_shown(const Diagnostic& diagnostic) const {
  const auto level = levels_.find(diagnostic.code());
  if (level != levels_.end() && level->second == Level::allow) return false;
  return allow_of(diagnostic) == nullptr;
}

std::vector<const Diagnostic*> Report::sorted() const {
  std::vector<Place> places;
  for (const Diagnostic& diagnostic : diagnostics_) {
    if (is_shown(diagnostic)) places.push_back({&diagnostic, places.size()});
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
