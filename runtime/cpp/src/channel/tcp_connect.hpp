// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "rr/node_id.hpp"
#include "rr/options.hpp"
#include "rr/url.hpp"
#include "runtime/cpp/src/channel/capabilities.hpp"
#include "runtime/cpp/src/channel/socket.hpp"
#include "runtime/cpp/src/channel/time.hpp"

namespace rr::channel {

/// A socket on which both sides have agreed how to talk.
struct Agreed {
  Descriptor socket;
  NodeId remote_node;
  std::string remote_name;
  Agreement agreement;
  // The two messages that did it.
  std::vector<std::byte> request;
  std::vector<std::byte> answer;
};

/// Tries all addresses of the URL's host, a new one every few milliseconds; the first with which
/// the handshake succeeds wins. Throws rr::Error: operation_cancelled when an Interruption ends it.
Agreed connect_stream(const Url& url, const NodeOptions& options, Time deadline);

}  // namespace rr::channel
