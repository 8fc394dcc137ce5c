// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "rr/url.hpp"
#include "runtime/cpp/src/channel/channel.hpp"
#include "runtime/cpp/src/channel/listening_socket.hpp"

namespace rr::channel {

/// Listens at all addresses of a host and accepts connections.
class TcpListener final : public Listener {
 public:
  TcpListener(const ChannelContext& context, const Url& url, const AcceptHandler& accept);
  ~TcpListener() override;

  [[nodiscard]] std::vector<std::string> urls() const override;

 private:
  std::vector<std::shared_ptr<ListeningSocket>> ports_;
  std::vector<std::string> schemes_;  // of what can be used there
};

}  // namespace rr::channel
