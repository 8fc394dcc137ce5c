// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "compiler/docs/addresses.hpp"
#include "compiler/docs/markup.hpp"
#include "compiler/docs/search.hpp"
#include "compiler/docs/signatures.hpp"
#include "compiler/docs/uses.hpp"
#include "compiler/docs/view.hpp"

/// Parts of the view, each made in a file of its own.
namespace robdef::docs {

/// What is known while the page of one definition is made.
struct Context {
  const model::Definition& definition;
  const Addresses& addresses;
  const Markup& markup;
  const Uses& uses;
  const Signatures& signatures;
};

/// What is declared in a definition: objects, structs, pods, namedarrays, enums, exceptions,
/// constants; each kind that there is, in the order of the file.
std::vector<SectionView> make_sections(const Context& context);

/// The same for the search box, with all members, in the order of the page.
std::vector<Found> searched(const model::Definition& definition);

/// With commas between them.
std::string joined(const std::vector<std::string>& links);

}  // namespace robdef::docs
