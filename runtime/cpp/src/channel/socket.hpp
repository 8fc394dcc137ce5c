// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/socket.h>
#include <sys/types.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "runtime/cpp/src/channel/time.hpp"

namespace rr::channel {

/// Owns a file descriptor.
class Descriptor {
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

 private:
  int number_ = -1;
};

/// Where a socket is, or may be reached.
struct Address {
  sockaddr_storage storage{};
  socklen_t size = 0;
  /// Of a local socket: the users who may listen there. Empty: nobody asks.
  std::vector<uid_t> servers{};

  [[nodiscard]] int family() const { return storage.ss_family; }
  [[nodiscard]] std::uint16_t port() const;
  void set_port(std::uint16_t port);
  /// As in a URL: `10.0.0.5:2355`, `[fe80::1%eth0]:2355`.
  [[nodiscard]] std::string text() const;
};

/// As a URL of TCP with this scheme; empty for what is none.
std::string url_of(const Address& address, std::string_view scheme = "rr+tcp");

/// All addresses of a host: a name, or digits; IPv6 with an optional `%scope`. A link-local address
/// without scope gives one address for each interface. Throws rr::Error (connection_error).
std::vector<Address> resolve(const std::string& host, std::uint16_t port);

/// Addresses to listen at for a host as written in a URL: empty and `*` mean all of both families.
std::vector<Address> resolve_for_listening(const std::string& host, std::uint16_t port);

/// The user at the other end of a local socket: who listens, or who has connected.
std::optional<uid_t> peer_user(int descriptor);

Address local_address(int descriptor);
Address remote_address(int descriptor);

/// What every stream of ours has set: no delay of small segments (04, section 2).
void set_stream_options(int descriptor);

/// A receive that blocks returns after this time without bytes.
void set_receive_timeout(int descriptor, Milliseconds time);
/// Delays TCP's next acknowledgement until it can travel with data. No effect on other sockets.
void acknowledge_with_next_segment(int descriptor);

/// Waits for POLLIN or POLLOUT; false at the deadline.
bool wait_for(int descriptor, short events, Time deadline);
/// Milliseconds for poll(): rounded up, -1 for never.
int poll_milliseconds(Time deadline);

}  // namespace rr::channel
