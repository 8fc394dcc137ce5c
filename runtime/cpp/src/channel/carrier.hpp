// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>

#include "runtime/cpp/src/channel/scratch.hpp"
#include "runtime/cpp/src/channel/time.hpp"

namespace rr::platform {
struct Buffer;
}

namespace rr::channel {

class SharedCarrier;

/// Carries what a connection sends and receives where that is not the plain bytes of its socket,
/// whose readiness still says when there is something to receive.
///
/// Receiving is for whoever has the read turn of the connection, sending for whoever has its lock
/// for sending; both may happen at once.
class Carrier {
 public:
  virtual ~Carrier() = default;

  /// True when it carries whole messages, which receive() gives, and not bytes.
  [[nodiscard]] virtual bool carries_messages() const = 0;
  /// As platform::receive(): bytes, 0 at the end, nothing_now or broken. What is not bytes for the
  /// connection, but moves things on, is not told of.
  virtual std::ptrdiff_t receive(std::span<std::byte> room, bool may_block) = 0;
  /// The same for a whole message, which counts as 1.
  virtual std::ptrdiff_t receive(Frame& message, bool may_block) = 0;
  /// True when receive() has something without asking the socket: of bytes never more than fit into
  /// a scratch.
  [[nodiscard]] virtual bool has_received() const = 0;

  /// Without blocking: how many bytes were taken, 0 when there is no room now, platform::broken.
  virtual std::ptrdiff_t send(std::span<const platform::Buffer> pieces) = 0;
  /// Bytes that were taken, and wait for the socket. One that carries bytes may have some of its
  /// own, and be asked by any thread.
  [[nodiscard]] virtual std::size_t unsent() const = 0;
  /// Sends them, as far as there is room; false when the connection is broken.
  virtual bool flush() = 0;
  /// Waits until there is room, or for a while.
  virtual void wait_for_room(Time deadline) = 0;

  /// `on_room` is called, on any thread, when there is room again after send() has taken nothing
  /// and the socket does not tell.
  virtual void set_on_room(std::function<void()> on_room) = 0;
  /// The connection has ended.
  virtual void end() = 0;
  /// This, where it is one whose socket is a bell; else null.
  [[nodiscard]] virtual SharedCarrier* shared() { return nullptr; }
  /// Why it cannot go on, for people; empty when there is nothing to say.
  [[nodiscard]] virtual std::string failure() const { return {}; }
};

}  // namespace rr::channel
