// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "rr/buffer.hpp"
#include "rr/reader.hpp"
#include "rr/writer.hpp"
#include "runtime/cpp/src/channel/account.hpp"

namespace rr::channel {

/// The bytes of one received message. Without an owner they are in a thread's scratch memory and
/// valid only while it is held.
struct Frame {
  std::span<const std::byte> bytes{};
  MemoryRef owner{};
  Charge charge{};  ///< of who has sent it, until it has been handled
};

/// What a thread needs while it reads connections: idle connections own no buffer, so this is lent
/// to whichever connection the thread reads.
struct Scratch {
  static constexpr std::size_t capacity = 64 * 1024;
  std::array<std::byte, capacity> bytes;        // left uninitialized
  std::size_t received = 0;                     ///< bytes, since the reactor has set it to zero
  Message message;                              ///< the message that was parsed last
  Entry first;                                  ///< and its first entry
  std::vector<Frame> waiting;                   ///< messages that are handled after reading
  std::size_t parsed = 0;                       ///< the one of them that `message` shows, plus one
  std::vector<std::function<void()>> deferred;  ///< other work for after reading
};

/// Holds one of the calling thread's scratches; nested ones get another.
class ScratchLease {
 public:
  ScratchLease();
  ~ScratchLease();
  ScratchLease(const ScratchLease&) = delete;
  ScratchLease& operator=(const ScratchLease&) = delete;

  Scratch& operator*() const { return *scratch_; }
  Scratch* operator->() const { return scratch_.get(); }

 private:
  std::unique_ptr<Scratch> scratch_;
};

/// The calling thread's writer. What is written with it must be sent before anything else can use
/// it: no user code may run in between.
Writer& thread_writer();

}  // namespace rr::channel
