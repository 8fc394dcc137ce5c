// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace rr::channel {

class Pollable;

/// What is watched for at a descriptor, and what was found there.
namespace ready {
// The bits of Linux's epoll, so that nothing has to be translated there.
inline constexpr std::uint32_t input = 0x1;  ///< bytes have come
inline constexpr std::uint32_t room = 0x4;   ///< bytes can be sent
/// The other side sends no more, or the connection is broken. Needs not be asked for, but for the
/// first bit.
inline constexpr std::uint32_t end = 0x2018;
inline constexpr std::uint32_t closing = 0x2000;  ///< the bit of `end` that is asked for
}  // namespace ready

/// Watches descriptors: the reactor.
class Watcher {
 public:
  // Descriptors: `events` are bits of rr::channel::ready, each told of once until it is asked for
  // anew (edge-triggered). Throw std::system_error.
  virtual void add(int descriptor, std::uint32_t events, Pollable& pollable) = 0;
  virtual void change(int descriptor, std::uint32_t events, Pollable& pollable) = 0;
  virtual void remove(int descriptor) = 0;

 protected:
  ~Watcher() = default;
};

}  // namespace rr::channel
