// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <deque>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/diagnostics/source.hpp"

namespace robdef {

/// Every diagnostic that the compiler can report; codes.def is the one list of them.
enum class Code {
#define ROBDEF_CODE(code, rule, severity, summary, explanation) code,
#include "compiler/diagnostics/codes.def"
#undef ROBDEF_CODE
};

enum class Severity { error, warning };

/// What codes.def says about one code.
struct CodeEntry {
  Code code;
  std::string_view name;  ///< `R0203`
  std::string_view rule;  ///< rule id of the language description, `V12`
  Severity severity;
  std::string_view summary;      ///< one line, for lists
  std::string_view explanation;  ///< paragraphs for `robdef explain`
};

/// All codes in the order of codes.def.
const std::vector<CodeEntry>& code_entries();
const CodeEntry& entry_of(Code code);
/// The entry of `R0203`, or null for a name that is not a code.
const CodeEntry* find_code(std::string_view name);

/// A span with what to say about it.
struct Label {
  Span span;
  std::string text;
};

/// One finding. Built in place by the pass that found it:
///   report.add(Code::R0203, span, "unknown type `Angle`").label("no struct ... has this name")
///       .help("`Angles`, declared on line 7, is close");
class Diagnostic {
 public:
  Diagnostic(Code code, Span span, std::string message);

  /// Text under the carets of the primary span.
  Diagnostic& label(std::string text);
  /// A second place that matters, for instance the first declaration. At most two are kept.
  Diagnostic& also(Span span, std::string text);
  /// What to do about it.
  Diagnostic& help(std::string text);
  /// Why it is so.
  Diagnostic& note(std::string text);

  [[nodiscard]] Code code() const { return code_; }
  [[nodiscard]] Severity severity() const { return entry_of(code_).severity; }
  [[nodiscard]] const std::string& message() const { return message_; }
  [[nodiscard]] const Label& primary() const { return primary_; }
  [[nodiscard]] const std::vector<Label>& secondary() const { return secondary_; }
  [[nodiscard]] const std::vector<std::string>& helps() const { return helps_; }
  [[nodiscard]] const std::vector<std::string>& notes() const { return notes_; }

 private:
  Code code_;
  std::string message_;
  Label primary_;
  std::vector<Label> secondary_;
  std::vector<std::string> helps_;
  std::vector<std::string> notes_;
};

/// Collects what the passes find. Passes never print and never throw for a user's mistake.
class Report {
 public:
  /// The reference stays valid until the report is destroyed.
  Diagnostic& add(Code code, Span span, std::string message);

  /// Turns a warning off by code, for the whole run. Errors cannot be turned off.
  void silence(Code warning);

  [[nodiscard]] bool has_errors() const { return errors_ > 0; }
  /// As added, so a repeated one counts again.
  [[nodiscard]] std::size_t errors() const { return errors_; }
  /// All findings by file (in load order) and place; the same code at the same span appears once.
  [[nodiscard]] std::vector<const Diagnostic*> sorted() const;

 private:
  std::deque<Diagnostic> diagnostics_;
  std::vector<Code> silenced_;
  std::size_t errors_ = 0;
};

}  // namespace robdef
