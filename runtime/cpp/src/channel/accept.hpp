// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "runtime/cpp/src/channel/carrier.hpp"
#include "runtime/cpp/src/channel/channel.hpp"
#include "runtime/cpp/src/channel/link_terms.hpp"
#include "runtime/cpp/src/channel/socket.hpp"

namespace rr::channel {

/// Makes an incoming connection, counts it, and gives it its receiver. Throws rr::Error
/// (connection_error) when the node has as many connections as it may, and what `accept` throws.
std::shared_ptr<Connection> accept_connection(const ChannelContext& context, Descriptor socket,
                                              LinkTerms terms, std::unique_ptr<Carrier> carrier,
                                              const AcceptHandler& accept);

}  // namespace rr::channel
