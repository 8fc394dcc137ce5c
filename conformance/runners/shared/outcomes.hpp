// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>

#include "conformance/runners/shared/adapters.hpp"

namespace rr::conformance {

/// The part of `json` with this key, or null.
Json part(const Json& json, std::string_view key);

/// What the call with this number, counted from 0, is to give: outcomes are for one call each, in
/// their order, and the last one is for all calls to come. An outcome that is no list is for all.
Json outcome_of_call(const Json& outcomes, std::size_t call);

/// Reads the parameter of an error.
using ReadVarValue = std::function<VarValue(const Json&)>;

/// Throws what the `throw` of an outcome says. A "$n" stands for parameter n of the call.
[[noreturn]] void raise(const Adapters& adapters, const Json& what,
                        const Json& parameters = Json::array());
[[noreturn]] void raise(const ReadVarValue& read, const Json& what, const Json& parameters);

}  // namespace rr::conformance
