// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <rr/dynamic.hpp>

#include "conformance/harness/json.hpp"

/// Values of types that are known at run time only, in the notation of the captures.
namespace rr::conformance {

/// Values as what is under test has them: the C++ client and service as they are, other languages
/// by way of their own. Defined by each runner. Throws rr::Error for what is not of the type.
dynamic::Value passed(const dynamic::Definitions& definitions, const dynamic::ValueType& type,
                      const dynamic::Value& value);

/// Definitions are needed for what varvalues hold. Throws std::runtime_error for what is no such
/// value; whether it fits the type in every respect is found out when it is sent.
dynamic::Value value_of_json(const dynamic::Definitions& definitions,
                             const dynamic::ValueType& type, const Json& json);
/// The type decides how a value is spelled, where that leaves a choice.
Json json_of_value(const dynamic::Definitions& definitions, const dynamic::ValueType& type,
                   const dynamic::Value& value);
/// The parameters of a function, event or callback. Throws std::runtime_error for another count.
Json json_of_parameters(const dynamic::Definitions& definitions,
                        const dynamic::MemberDescription& member, const dynamic::List& values);
dynamic::List parameters_of_json(const dynamic::Definitions& definitions,
                                 const dynamic::MemberDescription& member, const Json& json);
/// `{type, value}`, or null.
Json json_of_any(const dynamic::Definitions& definitions, const dynamic::Value& value);

}  // namespace rr::conformance
