// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "rr/options.hpp"
#include "rr/reader.hpp"
#include "rr/wire.hpp"

namespace rr::channel {

/// What both sides of a connection want (04, section 4.4; 02, section 8).
struct Agreement {
  MessageVersion version = MessageVersion::v2;
  bool combined_connect = false;
  bool local_strings = false;     ///< messages may bring string tables of their own
  bool standard_strings = false;  ///< the predefined table may be used
};

/// The codes that a client sends.
std::vector<std::uint32_t> offered_codes(const Offer& offer);

/// What a server makes of them.
struct ServerAnswer {
  std::vector<std::uint32_t> codes;
  Agreement agreement;
};
/// Nothing when the codes are not acceptable, which is a protocol error.
std::optional<ServerAnswer> answer_codes(std::span<const std::uint32_t> requested,
                                         const Offer& offer);

/// What a client makes of a server's answer; nothing when the answer breaks the rules.
std::optional<Agreement> agree(std::span<const std::uint32_t> answered, const Offer& offered);

/// The codes in an element `capabilities`; nothing when it is not an array of uint32.
std::optional<std::vector<std::uint32_t>> read_codes(const Element& element);

/// Level of a stream capability (04, section 4.5); 0 for unknown names.
std::uint32_t stream_capability(std::string_view name);

}  // namespace rr::channel
