// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <unordered_set>
#include <utility>
#include <vector>

#include "compiler/diagnostics/report.hpp"
#include "compiler/diagnostics/source.hpp"
#include "compiler/lsp/index.hpp"
#include "compiler/lsp/text.hpp"
#include "compiler/model/model.hpp"
#include "compiler/syntax/ast.hpp"
#include "compiler/syntax/read.hpp"

namespace robdef::lsp {

/// One file with all that it imports, taken through all passes, as `robdef check FILE` does it.
/// Sources are called by the paths of their files.
class Analysis {
 public:
  Sources sources;
  Report report;
  ast::Program program;  ///< the file itself comes first
  model::Model model;
  bool misses_import = false;  ///< another file may change what is found
  /// Files that were read from the disk, and when they had been written.
  std::vector<std::pair<std::string, std::filesystem::file_time_type>> read_files;

  [[nodiscard]] const ast::File& file() const { return program.files.front().file; }
  [[nodiscard]] const model::Definition& definition() const { return *model.definitions().front(); }
  [[nodiscard]] const std::string& path() const { return sources[SourceId{}].name(); }
  [[nodiscard]] bool reads(const std::string& path) const;

  /// All that was read, for reading later versions; the end of this analysis. Texts are those of
  /// `sources`.
  [[nodiscard]] ast::EarlierFiles files() &&;

  /// What the file's names mean; made when it is first asked for.
  [[nodiscard]] const Index& index() const;
  /// The text of a source with its lines, likewise.
  [[nodiscard]] const Text& text(SourceId id = {}) const;

 private:
  mutable std::unordered_set<std::string_view> paths_;  // of sources
  mutable std::uint32_t known_paths_ = 0;               // of sources, in their order
  mutable std::unique_ptr<Index> index_;
  mutable std::map<SourceId, Text> texts_;
};

}  // namespace robdef::lsp
