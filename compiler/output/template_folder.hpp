// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/output/template.hpp"

namespace robdef {

/// One line of a template folder's `outputs.txt`.
struct OutputRule {
  std::string subject = {};  ///< once for each ...: a word that the backend knows
  std::string name = {};     ///< the template
  std::string path = {};     ///< of the file that it makes: text with holes itself
  std::size_t line = 1;      ///< in outputs.txt
};

/// Templates, and what they make. A folder holds files `NAME.mustache` and one `outputs.txt`, whose
/// lines are three words each; `#` begins a comment:
///
///   # once for each   template                  makes
///   definition        definition.hpp.mustache   {{path}}.hpp
struct TemplateFolder {
  static constexpr std::string_view rules_name = "outputs.txt";

  TemplateSources sources;  ///< by file name
  std::vector<OutputRule> rules;
  bool has_rules = false;

  /// Of files that were compiled in, the rules among them.
  static TemplateFolder from_sources(TemplateSources files);
  /// Of a folder, which is read now. Throws TemplateError when it cannot be.
  static TemplateFolder from_disk(const std::filesystem::path& folder);

  /// This folder with another laid over it: its rules, if it has any, replace these; of templates
  /// with the same name, its own are taken.
  [[nodiscard]] TemplateFolder overlaid_with(const TemplateFolder& other) const;
};

}  // namespace robdef
