// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace rr::channel {

/// So many bytes are worth a system call at once.
inline constexpr std::size_t stream_chunk = std::size_t{64} * 1024;
/// What a message that waits costs besides its bytes.
inline constexpr std::size_t bytes_beside_frame = 128;

}  // namespace rr::channel
