// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
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

/// What becomes of a warning: `deny` makes it an error.
enum class Level { allow, warn, deny };

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

/// A change of a text: what replaces a span. An empty span inserts.
struct Replacement {
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
  /// A change that the last help() asks for; all changes of a help belong together. A change for
  /// each place: they do not overlap.
  Diagnostic& edit(Span span, std::string replacement);
  /// Why it is so.
  Diagnostic& note(std::string text);

  [[nodiscard]] Code code() const { return code_; }
  /// That of its code, but for a warning that is denied.
  [[nodiscard]] Severity severity() const { return severity_; }
  [[nodiscard]] const std::string& message() const { return message_; }
  [[nodiscard]] const Label& primary() const { return primary_; }
  [[nodiscard]] const std::vector<Label>& secondary() const { return secondary_; }
  [[nodiscard]] const std::vector<std::string>& helps() const { return helps_; }
  /// The changes that a help, by its index in helps(), asks for; empty where only a person can
  /// tell.
  [[nodiscard]] std::vector<Replacement> edits_of(std::size_t help) const;
  [[nodiscard]] const std::vector<std::string>& notes() const { return notes_; }

 private:
  struct HelpEdit {
    std::size_t help = 0;
    Replacement replacement;
  };
  friend class Report;

  Code code_;
  Severity severity_;
  std::string message_;
  Label primary_;
  std::vector<Label> secondary_;
  std::vector<std::string> helps_;
  std::vector<HelpEdit> edits_;
  std::vector<std::string> notes_;
};

/// The text with the beginnings only of words of more than a thousand letters, so that a message
/// about a name of a megabyte can be read. All texts of a diagnostic are.
std::string shortened(std::string text);

/// Who wrote the text that is read.
enum class Origin {
  user,     ///< whoever reads the findings
  network,  ///< another node: its mistakes are found, but not explained
};

/// Collects what the passes find. Passes never print and never throw for a user's mistake.
///
/// What a text costs grows with its size, whatever is in it: what was probably meant is looked for
/// as long as a run has time left for that, and never in a text from the network, of which so many
/// findings are kept as anybody may want to see.
class Report {
 public:
  explicit Report(Origin origin = Origin::user) : origin_(origin) {}

  /// The reference stays valid until the report is destroyed, that of a finding which is not kept
  /// until the next one.
  Diagnostic& add(Code code, Span span, std::string message);

  /// How often add() and allow_at() have been called.
  [[nodiscard]] std::size_t remarks() const { return remarks_; }

  /// Whether to look for what was meant, among `count` things by comparing `letters` letters with
  /// each.
  [[nodiscard]] bool may_suggest(std::size_t count, std::size_t letters = 1);

  /// What becomes of a warning in the whole run, where nothing is said at its place. Errors stay
  /// errors, and in a text from the network nothing is denied. To be called before findings are
  /// added.
  void set_level(Code warning, Level level);

  /// Turns a warning off where its place begins in `place`, which a comment asks for. Of two such
  /// places the one that begins later counts. A text from the network asks in vain.
  void allow_at(Code warning, Span place, Span comment);
  /// Warns (R0147) of each allow_at() without a finding, unless that is of a target language: then
  /// it may be meant for another one.
  void report_unused_allows();

  [[nodiscard]] Origin origin() const { return origin_; }
  /// Denied warnings are errors here.
  [[nodiscard]] bool has_errors() const;
  /// Without denied warnings, which leave a definition right. As added, so a repeated one counts
  /// again.
  [[nodiscard]] std::size_t errors() const { return errors_; }
  /// All findings by file (in load order) and place; the same code at the same span appears once.
  [[nodiscard]] std::vector<const Diagnostic*> sorted() const;

 private:
  const Origin origin_;
  std::size_t work_left_ = 30'000'000;
  std::deque<Diagnostic> diagnostics_;
  std::optional<Diagnostic> dropped_;  // the last one of those that are not kept
  /// A comment that turns a warning off.
  struct Allow {
    Span place;
    Span comment;
  };
  using AllowKey = std::pair<SourceId, Code>;

  [[nodiscard]] const Allow* allow_of(const Diagnostic& diagnostic) const;
  [[nodiscard]] bool is_shown(const Diagnostic& diagnostic) const;

  std::map<Code, Level> levels_;
  std::map<AllowKey, std::vector<Allow>> allows_;  // by their places
  std::size_t errors_ = 0;
  std::size_t remarks_ = 0;
  std::vector<const Diagnostic*> denied_;
};

}  // namespace robdef
