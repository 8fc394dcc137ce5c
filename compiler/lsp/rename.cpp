// SPDX-License-Identifier: Apache-2.0
// Renaming in all files of a workspace.
#include <algorithm>
#include <string_view>
#include <utility>

#include "compiler/lsp/navigation.hpp"
#include "compiler/syntax/words.hpp"

namespace robdef::lsp {
namespace {

[[noreturn]] void refuse(const std::string& why) {
  throw RequestError(ErrorCode::request_failed, why);
}

const Occurrence& renamed_at(const Analysis& analysis, std::uint32_t offset) {
  const Occurrence* const found = analysis.index().at(offset);
  if (found == nullptr) refuse("there is no name here that a definition declares");
  if (found->symbol->kind == SymbolKind::service) {
    refuse("the name of a service is that of its file, and clients ask for it: it is not renamed");
  }
  return *found;
}

bool is_name(std::string_view name) {
  return !name.empty() && syntax::is_letter(name.front()) && name.back() != '_' &&
         std::ranges::all_of(name, syntax::is_word_character);
}

void check_name(const std::string& name) {
  if (!is_name(name)) {
    refuse("`" + name +
           "` is no name: a name has letters, digits and underscores, begins with a"
           " letter and does not end in an underscore");
  }
  if (syntax::is_reserved_word(name)) refuse("`" + name + "` is a reserved word");
  if (syntax::has_reserved_prefix(name)) refuse("`" + name + "` begins with a reserved prefix");
}

std::string same(const Symbol& other) {
  return "`" + other.name + "` is already the name of " +
         std::string(syntax::article_for(other.word)) + " " + std::string(other.word) +
         " there: `" + other.path() + "`";
}

// Names of one block, file or list of parameters differ.
void check_place(const Found& one, const std::string& name) {
  const Index& index = one.analysis->index();
  const Occurrence* const found = index.at(one.span.begin);
  if (found == nullptr) return;
  const Symbol& symbol = *found->symbol;
  if (symbol.owner != nullptr && one.is_declaration) {
    const Symbol* const other = index.part_of(*symbol.owner, name);
    if (other != nullptr && other != &symbol) refuse(same(*other));
    return;
  }
  if (symbol.owner != nullptr) return;
  // A plain name of this file: own, by `using`, or an alias.
  const Symbol* const other = index.find(one.analysis->file(), name);
  const bool is_plain_here =
      one.is_declaration || index.find(one.analysis->file(), symbol.name) == &symbol;
  if (is_plain_here && other != nullptr && other != &symbol) refuse(same(*other));
}

}  // namespace

Json prepare_rename(const Analysis& analysis, std::uint32_t offset, Encoding encoding) {
  const Occurrence& found = renamed_at(analysis, offset);
  return {{"range", to_json(analysis.text().range(found.span, encoding))},
          {"placeholder", found.symbol->name}};
}

Json rename_at(const Analysis& analysis, Workspace& workspace, std::uint32_t offset,
               const std::string& name, Encoding encoding) {
  const Occurrence& found = renamed_at(analysis, offset);
  Json changes = Json::object();
  if (name == found.symbol->name) return {{"changes", std::move(changes)}};
  check_name(name);
  for (const Found& one : find_all(workspace, analysis, *found.symbol, false)) {
    check_place(one, name);
    const std::string uri = workspace.uri_of_path(one.analysis->path());
    changes[uri].push_back(
        {{"range", to_json(one.analysis->text().range(one.span, encoding))}, {"newText", name}});
  }
  return {{"changes", std::move(changes)}};
}

}  // namespace robdef::lsp
