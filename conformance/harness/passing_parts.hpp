// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>

#include "conformance/harness/json.hpp"

/// Parts of decoded entries that are new in each run: times and generator indices.
namespace rr::conformance {

/// Live generator indices by recorded ones.
using Generators = std::map<std::int32_t, std::int32_t>;

/// Puts the recorded `packettime` of a wire into the live entry, when that has one too.
void put_aside_packet_time(const Json& recorded, Json& live);

/// The service gives an index with the answer to the call: notes it, and puts the recorded one into
/// the live entry.
void put_aside_generator_index(const Json& recorded, Json& live, Generators& generators);

/// Replaces the index in a request for a generator by what `generators` says; others stay.
void rename_generator(Json& entry, const Generators& generators);

}  // namespace rr::conformance
