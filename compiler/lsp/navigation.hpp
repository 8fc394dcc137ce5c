// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "compiler/lsp/analysis.hpp"
#include "compiler/lsp/protocol.hpp"
#include "compiler/lsp/workspace.hpp"

/// From names to what they stand for and back, in all files of a workspace.
namespace robdef::lsp {

/// A name in a file.
struct Found {
  std::shared_ptr<const Analysis> analysis;  ///< of the file
  Span span;
  bool is_declaration = false;
  bool is_by_alias = false;  ///< an alias stands there
};

/// Where a symbol is named. `with_aliases`: also where only an alias of it is. With the members
/// that have to have the name of a member.
std::vector<Found> find_all(Workspace& workspace, const Analysis& analysis, const Symbol& symbol,
                            bool with_aliases);

Json definition_of(const Analysis& analysis, const Workspace& workspace, std::uint32_t offset,
                   Encoding encoding);
Json references_to(const Analysis& analysis, Workspace& workspace, std::uint32_t offset,
                   bool with_declarations, Encoding encoding);
Json highlights_of(const Analysis& analysis, std::uint32_t offset, Encoding encoding);
/// Null where nothing is to say.
Json hover_at(const Analysis& analysis, std::uint32_t offset, Encoding encoding);

/// The range of the name at a place, and what it is. RequestError request_failed when it cannot be
/// renamed.
Json prepare_rename(const Analysis& analysis, std::uint32_t offset, Encoding encoding);
/// A WorkspaceEdit. RequestError request_failed when the new name is none, or is taken.
Json rename_at(const Analysis& analysis, Workspace& workspace, std::uint32_t offset,
               const std::string& name, Encoding encoding);

}  // namespace robdef::lsp
