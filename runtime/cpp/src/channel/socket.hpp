// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/cpp/src/channel/time.hpp"
#include "runtime/cpp/src/platform/sockets.hpp"
#include "runtime/cpp/src/platform/waiting.hpp"

namespace rr::channel {

using platform::Address;
using platform::Descriptor;
using platform::Family;

/// As a URL of TCP with this scheme; empty for what is none.
std::string url_of(const Address& address, std::string_view scheme = "rr+tcp");

/// All addresses of a host: a name, or digits; IPv6 with an optional `%scope`. A link-local address
/// without scope gives one address for each interface. Throws rr::Error (connection_error).
std::vector<Address> resolve(const std::string& host, std::uint16_t port);

/// Addresses to listen at for a host as written in a URL: empty and `*` mean all of both families.
std::vector<Address> resolve_for_listening(const std::string& host, std::uint16_t port);

}  // namespace rr::channel
