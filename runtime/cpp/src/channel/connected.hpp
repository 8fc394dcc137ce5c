// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "runtime/cpp/src/channel/channel.hpp"
#include "runtime/cpp/src/channel/handshake.hpp"
#include "runtime/cpp/src/channel/link_terms.hpp"

namespace rr::channel {

/// Makes a client's connection of what was agreed, and gives it its receiver.
std::shared_ptr<Connection> connected(const ChannelContext& context, Agreed agreed, LinkTerms terms,
                                      const AcceptHandler& make_receiver);

}  // namespace rr::channel
