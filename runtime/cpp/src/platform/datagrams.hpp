// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string_view>
#include <system_error>

#include "runtime/cpp/src/platform/sockets.hpp"

/// Sockets of UDP that send to everybody, and receive what was sent so.
namespace rr::platform {

/// Opens one at an address and port, which others may share. IPv6 is IPv6 alone; IPv4 may be
/// broadcast. With an interface, groups are sent to there, and are received on this machine, too.
Descriptor open_datagrams(const Address& at, std::optional<unsigned> interface_number,
                          std::error_code& error);
/// Receives what is sent to a group of IPv6 on an interface, if that has groups.
void join_group(int socket, const IpAddress& group, unsigned interface_number);

/// Sends one, without waiting. It may get lost on the way, or here.
void send_datagram(int socket, std::string_view content, const Address& to);
/// The next one, cut to the room. nothing_now when there is none; broken is of one datagram only,
/// such as one that nobody took.
std::ptrdiff_t receive_datagram(int socket, std::span<char> room, Address& sender);
/// True when there is one to receive, or an error.
bool has_datagram(int socket);

}  // namespace rr::platform
