// SPDX-License-Identifier: Apache-2.0
#include "compiler/driver/lsp.hpp"

#include <iostream>
#include <utility>

#include "compiler/backends/backend.hpp"
#include "compiler/lsp/session.hpp"

namespace robdef {

ExitStatus serve_editor(const Options& options, std::ostream& out) {
  lsp::WorkspaceOptions wanted;
  wanted.search_path = options.search_path;
  wanted.own_import_folders = options.own_import_folders;
  wanted.version = ROBDEF_VERSION;
  for (const Backend* backend : backends()) wanted.languages.push_back(backend->name());
  return lsp::serve(std::move(wanted), std::cin, out) == 0 ? exit_fine : exit_errors;
}

}  // namespace robdef
