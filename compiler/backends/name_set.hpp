// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <string>
#include <string_view>

#include "compiler/diagnostics/report.hpp"

namespace robdef {

/// A language as messages call it, and as options and project files do.
struct LanguageName {
  std::string_view shown;   ///< `C#`
  std::string_view option;  ///< `csharp`
};

inline constexpr LanguageName cpp_language{"C++", "cpp"};
inline constexpr LanguageName csharp_language{"C#", "csharp"};
inline constexpr LanguageName matlab_language{"MATLAB", "matlab"};
inline constexpr LanguageName typescript_language{"TypeScript", "typescript"};
inline constexpr LanguageName arduino_language{"Arduino", "arduino"};
inline constexpr LanguageName cbus_language{"C", "cbus"};

/// The line of a project file that gives what stands at `path` another name, as the help of a
/// finding. Nothing for an empty path: then a rename does not help.
void help_rename(Diagnostic& diagnostic, const LanguageName& language, const std::string& path);

/// Reports R0902 for a name of which a file cannot be called.
void check_file_name(std::string_view name, const LanguageName& language, const std::string& path,
                     Span span, Report& report);

/// Names that must differ in the target language, with where each comes from.
class NameSet {
 public:
  NameSet(const LanguageName& language, Report& report) : language_(language), report_(report) {}
  /// Reports R0901 for a name that is there. `what` says what is called so: `stub`. `path` is the
  /// full name of what it comes from (rename.hpp). False when it was there.
  bool add(const std::string& name, Span span, std::string_view what, const std::string& path);

 private:
  LanguageName language_;
  Report& report_;
  std::map<std::string, Span, std::less<>> taken_;
};

/// Reports R0902 for what has another name in code, where the language cannot give it one.
void refuse_rename(std::string_view name, std::string_view renamed, std::string_view what,
                   const LanguageName& language, Span span, Report& report);

/// Reports R0903 when a name of the definition had to be changed.
void report_renamed(std::string_view name, std::string_view renamed, std::string_view language,
                    Span span, Report& report);

}  // namespace robdef
