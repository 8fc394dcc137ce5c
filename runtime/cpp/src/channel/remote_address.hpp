// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace rr::channel {

/// Who is at the other end of a connected socket: an IP address without its port (`10.0.0.5`,
/// `fe80::1%eth0`), for a local socket the user that the kernel names (`uid 1000`). Empty for
/// what is no socket, or is not connected any more. An IPv4 address in IPv6 form is written as
/// IPv4.
std::string remote_address_of(int socket);

/// What limits for one remote address go by: the address, but for IPv6 its first 64 bits, as a
/// single computer may use all the others.
std::string remote_key(std::string_view remote_address);

}  // namespace rr::channel
