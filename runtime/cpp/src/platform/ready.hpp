// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

/// What is waited for at a socket, and what was found there.
namespace rr::platform::ready {

// The bits of Linux's poll() and epoll, so that nothing has to be translated there.
inline constexpr std::uint32_t input = 0x1;  ///< bytes have come
inline constexpr std::uint32_t room = 0x4;   ///< bytes can be sent
/// The other side sends no more, or the connection is broken. Needs not be asked for, but for the
/// first bit.
inline constexpr std::uint32_t end = 0x2018;
inline constexpr std::uint32_t closing = 0x2000;  ///< the bit of `end` that is asked for

}  // namespace rr::platform::ready
