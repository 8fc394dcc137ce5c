// SPDX-License-Identifier: Apache-2.0
#include "compiler/backends/cbus/names.hpp"

#include <array>
#include <cctype>

#include "compiler/backends/cpp/names.hpp"
#include "compiler/backends/name_set.hpp"
#include "compiler/backends/words.hpp"

namespace robdef::cbus {

std::string prefix_of(std::string_view service) { return replace_all(service, ".", "_"); }

std::string type_name(const model::Record& record) {
  return prefix_of(record.definition->name) + "_" + code_name(record);
}

std::string guard_of(std::string_view service) {
  std::string guard = prefix_of(service) + "_BUS_H";
  for (char& letter : guard) {
    letter = static_cast<char>(std::toupper(static_cast<unsigned char>(letter)));
  }
  return guard;
}

std::string field_name(std::string_view name, Span span, Report& report) {
  // The header is for both: `restrict` is a word of C alone.
  if (!cpp::is_reserved(name) && name != "restrict") return std::string(name);
  std::string changed = std::string(name) + "_";
  report.add(Code::R0903, span, "`" + std::string(name) + "` is reserved in C or C++")
      .label("becomes `" + changed + "`");
  return changed;
}

void TypeNames::add(const std::string& name, const std::string& written, Span span,
                    const std::string& path) {
  const auto [place, is_new] = taken_.emplace(name, span);
  if (is_new) return;
  Diagnostic& diagnostic = report_.add(
      Code::R0901, span, "`" + written + "` becomes `" + name + "`, which is taken in C");
  diagnostic.also(place->second, "also becomes `" + name + "`");
  help_rename(diagnostic, cbus_language, path);
}

void TypeNames::add(const model::Record& record) {
  const std::string name = type_name(record);
  const std::string path = record.qualified_name();
  add(name, record.name, record.span, path);
  check_file_name(name, cbus_language, path, record.span, report_);
  constexpr std::array endings{"_put",     "_get",  "_pack",  "_unpack",  "_signals", "_frame",
                               "_receive", "_HASH", "_BYTES", "_SIGNALS", "_sfun"};
  for (const char* const ending : endings) add(name + ending, record.name, record.span, path);
}

void TypeNames::add_definition(const model::Definition& definition) {
  const std::string prefix = prefix_of(definition.name);
  add(prefix + "_bus", definition.name, definition.span, "");
  add(prefix + "_buses", definition.name, definition.span, "");
}

}  // namespace robdef::cbus
