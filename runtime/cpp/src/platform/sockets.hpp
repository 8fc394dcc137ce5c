// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <system_error>
#include <utility>

#include "rr/visibility.hpp"
#include "runtime/cpp/src/platform/address.hpp"
#include "runtime/cpp/src/platform/clock.hpp"

/// Sockets of streams. A socket is a number; errors are comparable with std::errc.
namespace rr::platform {

/// Owns a socket.
class RR_INSIDE Descriptor {
 public:
  Descriptor() = default;
  explicit Descriptor(int number) : number_(number) {}
  Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }
  ~Descriptor();

  [[nodiscard]] int get() const { return number_; }
  explicit operator bool() const { return number_ >= 0; }
  /// The caller closes it.
  int release() { return std::exchange(number_, -1); }

 private:
  int number_ = -1;
};
/// Closes what Descriptor would.
void close_socket(int socket);

// Sending and receiving: results are bytes, or one of these.

/// There is nothing to receive, or no room to send, now; a wait ended without either.
inline constexpr std::ptrdiff_t nothing_now = -1;
/// The connection is broken.
inline constexpr std::ptrdiff_t broken = -2;

/// Bytes that leave together with others. As the system's own, so without initial values.
struct Buffer {
  const std::byte* data;
  std::size_t size;
};

enum class Wait : std::uint8_t {
  none,
  some,  ///< until there is something
  all,   ///< until the room is full
};
/// 0 at the end of the stream. One that waits gives nothing_now when a signal interrupts it, or
/// after the time of set_receive_timeout().
RR_INSIDE std::ptrdiff_t receive(int socket, std::span<std::byte> room, Wait wait);
/// Never waits, here and below: fewer bytes than asked when there is no more room.
RR_INSIDE std::ptrdiff_t send(int socket, std::span<const std::byte> bytes);
/// In one call of the system; at most 64 buffers.
std::ptrdiff_t send_gathered(int socket, std::span<const Buffer> buffers);

// How streams begin and end.

enum class Connecting : std::uint8_t { done, begun, failed };
/// A new socket that connects, without waiting. `begun`: connect_result() says what came of it once
/// there is room to send.
RR_INSIDE Connecting begin_connect(const Address& address, Descriptor& socket,
                                   std::error_code& error);
/// No error when the socket is connected.
RR_INSIDE std::error_code connect_result(int socket);
/// A new socket of TCP that listens, and does not wait in accept_one(). No other socket may listen
/// there, but one that ended a moment ago does not count. IPv6 is IPv6 alone.
Descriptor listen_at(const Address& address, std::error_code& error);
/// The next who has connected. None: operation_would_block when nobody has,
/// too_many_files_open or too_many_files_open_in_system for want of descriptors.
Descriptor accept_one(int listening, std::error_code& error);
/// Two sockets, connected with each other.
RR_INSIDE std::error_code make_pair(Descriptor& first, Descriptor& second);
/// Nothing is sent or received any more; whoever waits at the socket is woken.
void shut_down(int socket);
/// Nothing more is sent; the other side finds the end.
void shut_down_sending(int socket);

// What is known of a socket, and can be set. Nothing of this fails for people to see.

Address local_address(int socket);
Address remote_address(int socket);
/// The user at the other end of a local socket: who listens, or who has connected. The system says
/// so. Nothing for other sockets.
std::optional<UserId> peer_user(int socket);
/// Small segments leave at once (04, section 2). No effect on other sockets than those of TCP, as
/// below.
RR_INSIDE void set_stream_options(int socket);
/// A receive that waits returns after this time without bytes.
void set_receive_timeout(int socket, std::chrono::milliseconds time);
/// Delays TCP's next acknowledgement until it can travel with data.
void acknowledge_with_next_segment(int socket);

}  // namespace rr::platform
