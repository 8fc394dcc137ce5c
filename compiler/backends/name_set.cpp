// SPDX-License-Identifier: Apache-2.0
#include "compiler/backends/name_set.hpp"

#include <cstddef>

namespace robdef {

void help_rename(Diagnostic& diagnostic, const LanguageName& language, const std::string& path) {
  if (path.empty()) return;
  // With a number behind it a name is another one in whatever case a language writes it.
  std::string name = path.substr(path.rfind('.') + 1);
  constexpr std::size_t longest = 60;
  constexpr std::size_t kept = 20;
  // What distinguishes long names is at their ends.
  if (name.size() > longest) name = name.substr(0, kept) + name.substr(name.size() - kept);
  name += '2';
  diagnostic.help("rename it for " + std::string(language.shown) + " alone: `\"" + path +
                  "\" = \"" + name + "\"` below `[" + std::string(language.option) +
                  ".rename]` in robdef.toml");
}

void check_file_name(std::string_view name, const LanguageName& language, const std::string& path,
                     Span span, Report& report) {
  // Of 255 bytes, what endings and files beside it take.
  constexpr std::size_t most = 200;
  if (name.size() <= most) return;
  Diagnostic& diagnostic =
      report.add(Code::R0902, span,
                 "a name of " + std::to_string(name.size()) + " letters cannot be that of a file");
  diagnostic.label("a file for " + std::string(language.shown) + " is called so");
  help_rename(diagnostic, language, path);
}

bool NameSet::add(const std::string& name, Span span, std::string_view what,
                  const std::string& path) {
  const auto [place, is_new] = taken_.emplace(name, span);
  if (is_new) return true;
  Diagnostic& diagnostic =
      report_.add(Code::R0901, span,
                  "the " + std::string(language_.shown) + " name `" + name + "` is made twice");
  diagnostic.label("the " + std::string(what) + " made here")
      .also(place->second, "is called like this one");
  help_rename(diagnostic, language_, path);
  return false;
}

void refuse_rename(std::string_view name, std::string_view renamed, std::string_view what,
                   const LanguageName& language, Span span, Report& report) {
  if (renamed == name) return;
  report
      .add(Code::R0902, span,
           "the " + std::string(what) + " `" + std::string(name) + "` cannot be called `" +
               std::string(renamed) + "` in " + std::string(language.shown))
      .label("has its name on the wire there")
      .help("remove the rename of this " + std::string(what));
}

void report_renamed(std::string_view name, std::string_view renamed, std::string_view language,
                    Span span, Report& report) {
  if (renamed == name) return;
  report
      .add(Code::R0903, span, "`" + std::string(name) + "` is reserved in " + std::string(language))
      .label("becomes `" + std::string(renamed) + "`");
}

}  // namespace robdef
