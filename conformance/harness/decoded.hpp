// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <rr/message_tree.hpp>

#include "conformance/harness/json.hpp"

/// Messages and elements as the captures write them down: `decoded`. Node ids are written out,
/// texts are whole; names of types and entry types, which only serve readers, are left out.
namespace rr::conformance {

Json json_of_message(const rr::MessageTree& message);
/// Throws std::runtime_error or nlohmann::json::exception when a field is missing or has no
/// meaning.
rr::MessageTree message_of_json(const Json& decoded);

Json json_of_element(const rr::ElementTree& element, rr::MessageVersion version);
rr::ElementTree element_of_json(const Json& decoded, rr::MessageVersion version);

}  // namespace rr::conformance
