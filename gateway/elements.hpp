// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <exception>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/carrier.hpp"
#include "rr/dynamic.hpp"
#include "rr/error.hpp"
#include "rr/varvalue.hpp"

/// Values as the elements of message format 4, which payloads consist of.
namespace rr::gateway {

/// The element of one value, called `value`; empty for no type. Throws rr::Error for a value that
/// may not travel.
Bytes encode_element(const dynamic::ValueType& type, const dynamic::Value& value);
/// The reverse. Throws rr::Error for bytes that are no such element.
dynamic::Value decode_element(const dynamic::Definitions& definitions,
                              const dynamic::ValueType& type, const Bytes& bytes);

/// The element of a service's attributes; empty when it has none, or one of a named type.
Bytes encode_attributes(const std::map<std::string, VarValue>& attributes);
/// The reverse; none for bytes that are no such element.
std::map<std::string, VarValue> decode_attributes(const Bytes& bytes);

/// Elements of arguments, back to back, each called as its parameter. Throws as above.
Bytes encode_arguments(const std::vector<dynamic::ParameterDescription>& parameters,
                       const dynamic::List& arguments);
/// The reverse.
dynamic::List decode_arguments(const dynamic::Definitions& definitions,
                               const std::vector<dynamic::ParameterDescription>& parameters,
                               const Bytes& bytes);

/// `double,string` for the property `type` of arguments.
std::string type_text(const std::vector<dynamic::ParameterDescription>& parameters);

/// An rr::Error to hand on.
std::exception_ptr error_pointer(ErrorCode code, std::string text);
/// Puts an error into the properties of an answer: `error` (its code), `error-name`,
/// `error-message`, `error-subname`, and `error-at`, the place where it happened: `robot`,
/// `gateway`, `client`. The parameter of an error is the payload.
void set_error(Message& answer, const std::exception_ptr& error, std::string_view at);
/// The error of an answer; null for none.
std::exception_ptr error_of(const Message& answer);

}  // namespace rr::gateway
