// SPDX-License-Identifier: Apache-2.0
#include "compiler/lsp/navigation.hpp"

#include <algorithm>
#include <memory>
#include <set>
#include <utility>

namespace robdef::lsp {
namespace {

/// A declaration, whichever analysis has met it.
using Key = std::pair<std::string, std::uint32_t>;

Key key_of(const Analysis& analysis, const Symbol& symbol) {
  return {analysis.sources[symbol.span.source].name(), symbol.span.begin};
}

Json location(const Analysis& analysis, const Workspace& workspace, Span span, Encoding encoding) {
  return {{"uri", workspace.uri_of_path(analysis.sources[span.source].name())},
          {"range", to_json(analysis.text(span.source).range(span, encoding))}};
}

// Files that can name it: those in which the word stands.
std::vector<std::shared_ptr<const Analysis>> files_with(Workspace& workspace,
                                                        const Analysis& analysis,
                                                        const Symbol& symbol) {
  std::vector<std::string> files = workspace.files();
  const std::string declaring = analysis.sources[symbol.span.source].name();
  for (const std::string& path : {declaring, analysis.path()}) {
    if (std::ranges::find(files, path) == files.end()) files.push_back(path);
  }
  std::vector<std::shared_ptr<const Analysis>> result;
  for (const std::string& path : files) {
    const std::optional<std::string> text = workspace.text_of(path);
    if (!text || text->find(symbol.name) == text->npos) continue;
    if (auto one = workspace.analysis(path)) result.push_back(std::move(one));
  }
  return result;
}

// The members that have to have one name, over any number of steps.
void add_same_members(const std::vector<std::shared_ptr<const Analysis>>& files,
                      std::set<Key>& keys) {
  for (std::size_t before = 0; before != keys.size();) {
    before = keys.size();
    for (const auto& file : files) {
      for (const auto& [one, other] : file->index().same_members()) {
        const Key first = key_of(*file, *one);
        const Key second = key_of(*file, *other);
        if (keys.contains(first)) keys.insert(second);
        if (keys.contains(second)) keys.insert(first);
      }
    }
  }
}

}  // namespace

std::vector<Found> find_all(Workspace& workspace, const Analysis& analysis, const Symbol& symbol,
                            bool with_aliases) {
  const auto files = files_with(workspace, analysis, symbol);
  std::set<Key> keys{key_of(analysis, symbol)};
  if (symbol.kind == SymbolKind::member) add_same_members(files, keys);
  std::vector<Found> all;
  for (const auto& file : files) {
    for (const Occurrence& one : file->index().occurrences()) {
      const Symbol* const target = one.symbol->target;
      const bool is_named = keys.contains(key_of(*file, *one.symbol));
      const bool is_by_alias = !is_named && with_aliases && target != nullptr &&
                               !one.is_declaration && keys.contains(key_of(*file, *target));
      if (is_named || is_by_alias) {
        all.push_back({file, one.span, one.is_declaration, is_by_alias});
      }
    }
  }
  return all;
}

Json definition_of(const Analysis& analysis, const Workspace& workspace, std::uint32_t offset,
                   Encoding encoding) {
  const Occurrence* const found = analysis.index().at(offset);
  if (found == nullptr) return nullptr;
  const Symbol* symbol = found->symbol;
  if (symbol->target != nullptr) symbol = symbol->target;
  return location(analysis, workspace, symbol->span, encoding);
}

Json references_to(const Analysis& analysis, Workspace& workspace, std::uint32_t offset,
                   bool with_declarations, Encoding encoding) {
  const Occurrence* const found = analysis.index().at(offset);
  if (found == nullptr) return nullptr;
  Json all = Json::array();
  for (const Found& one : find_all(workspace, analysis, *found->symbol, true)) {
    if (one.is_declaration && !with_declarations) continue;
    all.push_back(location(*one.analysis, workspace, one.span, encoding));
  }
  return all;
}

Json highlights_of(const Analysis& analysis, std::uint32_t offset, Encoding encoding) {
  const Occurrence* const found = analysis.index().at(offset);
  if (found == nullptr) return nullptr;
  constexpr int read = 2;
  constexpr int write = 3;
  Json all = Json::array();
  for (const Occurrence& one : analysis.index().occurrences()) {
    if (one.symbol != found->symbol) continue;
    all.push_back({{"range", to_json(analysis.text().range(one.span, encoding))},
                   {"kind", one.is_declaration ? write : read}});
  }
  return all;
}

}  // namespace robdef::lsp
