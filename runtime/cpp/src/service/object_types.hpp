// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "rr/definition.hpp"

/// What clients are told about types (07, section 4).
namespace rr::service {

/// The type to tell a client of this version: the object's own, or of those it implements the first
/// whose definition is not newer. Nothing when there is none. Without a version: its own.
std::optional<std::string> type_for(const ObjectType& type,
                                    const std::optional<DefinitionVersion>& client);

/// These definitions and all that they import, each once, sorted by name.
std::vector<const Definition*> with_imports(std::span<const Definition* const> definitions);

}  // namespace rr::service
