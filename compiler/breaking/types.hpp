// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "compiler/breaking/pairing.hpp"
#include "compiler/model/model.hpp"

namespace robdef::breaking {

/// How far two types are apart.
enum class TypeChange {
  none,
  same_on_wire,  ///< another type of the language with the same bytes
  length,        ///< the same array with another length, limit or shape
  different,
};

TypeChange compare_types(const model::Type& before, const model::Type& now, const Pairing& pairing);

/// A type for messages: no service name, long names cut.
std::string text_of(const model::Type& type);
/// A name in backquotes for messages, cut when it is long.
std::string in_ticks(std::string_view name);
/// `Arm.speed` in backquotes for messages, likewise.
std::string in_ticks(std::string_view scope, std::string_view name);

}  // namespace robdef::breaking
