// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "compiler/model/model.hpp"
#include "compiler/output/file_set.hpp"

/// Reference pages of definitions: model -> view -> templates -> files.
namespace robdef::docs {

/// What pages are written in.
enum class Form { html, markdown };

/// One page for each definition of the model, imported ones among them, and an index; in HTML also
/// the file with the search index of all pages. The model must be free of errors. The same model
/// gives the same bytes, in whatever order its files were given.
FileSet make_pages(const model::Model& model, Form form);

}  // namespace robdef::docs
