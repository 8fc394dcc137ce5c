// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <vector>

#include "rr/url.hpp"
#include "runtime/cpp/src/channel/channel.hpp"
#include "runtime/cpp/src/channel/reactor.hpp"
#include "runtime/cpp/src/channel/socket.hpp"

namespace rr::channel {

/// Listens at all addresses of a host and accepts connections.
class TcpListener final : public Listener {
 public:
  TcpListener(Ground ground, const Url& url, AcceptHandler accept);
  ~TcpListener() override;

  [[nodiscard]] std::vector<std::string> urls() const override;

 private:
  class Port;  // one listening socket
  std::vector<std::shared_ptr<Port>> ports_;
  std::shared_ptr<Reactor> reactor_;
};

}  // namespace rr::channel
