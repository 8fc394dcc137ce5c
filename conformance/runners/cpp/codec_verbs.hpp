// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "conformance/runners/cpp/adapters.hpp"

namespace rr::conformance {

/// `decode`: {do: message, hex} gives {decoded}; {do: element, message_version, type, hex} gives
/// {decoded, value}. Throws what makes an answer of {error}.
Json decode(const Adapters& adapters, const Json& request);

/// `encode`: {do: message, decoded} and {do: element, message_version, decoded} give {hex}; {do:
/// value, message_version, type, value, element_name or element_number, metadata, extended} gives
/// {hex}, or {refused} with the runtime's reason.
Json encode(const Adapters& adapters, const Json& request);

}  // namespace rr::conformance
