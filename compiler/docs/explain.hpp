// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "compiler/model/model.hpp"

/// What a reader would have to look up in the language: sentences in plain text, names in
/// backquotes.
namespace robdef::docs {

/// How a function iterates, and what its modifiers mean for this kind of member.
std::vector<std::string> explain(const model::Member& member);
/// The size of a pod or namedarray.
std::vector<std::string> explain(const model::Record& record);

}  // namespace robdef::docs
