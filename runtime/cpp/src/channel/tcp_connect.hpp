// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "rr/options.hpp"
#include "rr/url.hpp"
#include "runtime/cpp/src/channel/channel.hpp"
#include "runtime/cpp/src/channel/handshake.hpp"
#include "runtime/cpp/src/channel/socket.hpp"
#include "runtime/cpp/src/channel/time.hpp"

namespace rr::channel {

/// What a client goes through with a connected socket.
enum class OpeningStep : std::uint8_t {
  web_tls,     ///< TLS as browsers do it
  web_socket,  ///< the handshake of web sockets
  start_tls,   ///< TLS as the protocol has it
  agree,       ///< what every connection begins with
  ask_memory,  ///< whether the other side shares memory, which ends it when it does not
  get_memory,  ///< that it makes
};

/// Those that the scheme of a URL asks for, without those that an option asks for.
std::vector<OpeningStep> opening_steps(std::string_view scheme);

/// Tries addresses, a new one every few milliseconds; the first with which all steps succeed wins.
/// Throws rr::Error: operation_cancelled when an Interruption ends it.
Agreed connect_stream(const std::vector<Address>& addresses, const Url& url,
                      const ChannelContext& context, Time deadline);

}  // namespace rr::channel
