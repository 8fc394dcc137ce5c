// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "compiler/lsp/analysis.hpp"
#include "compiler/lsp/protocol.hpp"
#include "compiler/lsp/workspace.hpp"

/// What a file declares and how it is written: outlines, folds, colours, layout.
namespace robdef::lsp {

/// Declarations with their parts: DocumentSymbol[].
Json document_symbols(const Analysis& analysis, Encoding encoding);
/// Declarations and members of all files whose names have the letters of a query in their order, in
/// either case; at most 500.
Json workspace_symbols(Workspace& workspace, std::string_view query, Encoding encoding);
/// Blocks, and comments of several lines.
Json folding_ranges(const Analysis& analysis, Encoding encoding);

/// The legend of semantic_tokens().
Json semantic_legend();
Json semantic_tokens(const Analysis& analysis, Encoding encoding);

/// TextEdit[] as compiler/format makes them.
Json formatting_edits(const Analysis& analysis, Encoding encoding);

}  // namespace robdef::lsp
