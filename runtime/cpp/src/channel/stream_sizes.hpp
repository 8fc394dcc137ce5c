// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace rr::channel {

/// So many bytes are worth a system call at once.
inline constexpr std::size_t stream_chunk = std::size_t{64} * 1024;
/// A server receives no more of a large message at once, so that it serves other connections before
/// the message is complete; and less while others receive data.
inline constexpr std::size_t largest_receive = std::size_t{128} * 1024;
inline constexpr std::size_t largest_receive_beside_others = std::size_t{32} * 1024;
/// Bytes of a ring in shared memory, of which a connection has two.
inline constexpr std::size_t shared_ring_size = std::size_t{256} * 1024;
/// What a message that waits costs besides its bytes.
inline constexpr std::size_t bytes_beside_frame = 128;

}  // namespace rr::channel
