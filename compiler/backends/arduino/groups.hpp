// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "compiler/backends/arduino/limits.hpp"
#include "compiler/model/model.hpp"

/// The objects of a service: all that objrefs lead to, with their numbers.
namespace robdef::arduino {

/// Objects of one type that are reached the same way, so that only indices differ.
struct Group {
  const model::Object* object = nullptr;
  std::vector<std::string> path;       ///< the objrefs that lead to it; empty for the root
  std::size_t parent = 0;              ///< its group; the root's own is 0
  const model::Member* via = nullptr;  ///< objref of the parent
  std::size_t fan = 1;                 ///< objects for each of the parent's
  std::size_t first = 0;               ///< number of the first object
  std::size_t count = 1;
};

/// All groups, each behind its parent. Reports what cannot be reached from a board.
std::vector<Group> find_groups(const model::Object& root, Report& report);

/// The root of what a definition serves: the only object that no objref of the definition leads to,
/// or the one marked `@root`. Null, and reported, when it is not clear which that is.
const model::Object* find_root(const model::Definition& definition, Report& report);

}  // namespace robdef::arduino
