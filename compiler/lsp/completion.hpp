// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "compiler/lsp/analysis.hpp"
#include "compiler/lsp/protocol.hpp"
#include "compiler/lsp/workspace.hpp"

namespace robdef::lsp {

/// What can be written at an offset: a CompletionList. Each item replaces the word, dots included,
/// that ends there.
Json completions_at(const Analysis& analysis, Workspace& workspace, std::uint32_t offset,
                    Encoding encoding);

}  // namespace robdef::lsp
