// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>

namespace rr::tap {

/// Replaces the values of the credentials of a login (07, section 6) by as many bytes that say
/// nothing: `*` in texts, zeros elsewhere. Names, types and sizes stay. Where bytes are no message
/// but mention credentials, everything from there on is replaced.
void mask_credentials(std::span<std::byte> message);

}  // namespace rr::tap
