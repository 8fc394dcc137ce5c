// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "rr/visibility.hpp"
#include "runtime/cpp/src/platform/users.hpp"

namespace rr::platform {

/// An IP address without a port.
struct RR_INSIDE IpAddress {
  std::array<std::uint8_t, 16> bytes{};  ///< as on the wire; the first four of IPv4
  bool is_v6 = false;
  std::uint32_t scope = 0;  ///< the number of an interface; 0 for none

  [[nodiscard]] bool is_loopback() const;
  [[nodiscard]] bool is_link_local() const;  ///< of IPv6 only
  [[nodiscard]] bool is_v4_in_v6() const;    ///< `::ffff:10.0.0.5`
  /// The same as IPv4, for one that is_v4_in_v6().
  [[nodiscard]] IpAddress as_v4() const;
  /// `10.0.0.5`, `fe80::1`: without a scope.
  [[nodiscard]] std::string text() const;
};
/// One in digits, without a scope.
RR_INSIDE std::optional<IpAddress> parse_ip(const std::string& text);

enum class Family : std::uint8_t { none, v4, v6, local };

/// Where a socket is, or may be reached. The bytes are as the system has them.
struct RR_INSIDE Address {
  alignas(std::uint64_t) std::array<std::byte, 128> bytes{};
  std::uint32_t size = 0;  ///< of the bytes that are used; 0: it is nowhere
  /// Of a local socket: the users who may listen there. Empty: nobody asks.
  std::vector<UserId> servers{};

  [[nodiscard]] Family family() const;
  /// Nothing for a local socket.
  [[nodiscard]] std::optional<IpAddress> ip() const;
  [[nodiscard]] std::uint16_t port() const;
  void set_port(std::uint16_t port);
  /// As in a URL, without a port: `10.0.0.5`, `fe80::1%eth0`.
  [[nodiscard]] std::string host() const;
  /// As in a URL: `10.0.0.5:2355`, `[fe80::1%eth0]:2355`. The path of a local socket.
  [[nodiscard]] std::string text() const;
};
Address address_of(const IpAddress& ip, std::uint16_t port);
/// All addresses of a family on this machine.
Address any_address(Family family, std::uint16_t port);
/// The local socket of a path; nothing when the path is longer than longest_local_path().
std::optional<Address> local_socket_address(const std::string& path);
/// Bytes.
std::size_t longest_local_path();

/// How the name of a host is looked up.
enum class LookUp : std::uint8_t {
  digits,      ///< nobody is asked: the name is an address
  configured,  ///< of the families that this machine has addresses of
  all,
  own,         ///< of this machine, on the loopback interface; the name does not count
  everywhere,  ///< to listen at, on all interfaces; the name does not count
};
/// Empty when nothing is found. May take seconds. Ports are 0.
RR_INSIDE std::vector<Address> look_up(const std::string& host, LookUp how);

}  // namespace rr::platform
