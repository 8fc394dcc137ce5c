// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <memory>

#include "runtime/cpp/src/channel/channel.hpp"
#include "runtime/cpp/src/channel/link_terms.hpp"
#include "runtime/cpp/src/channel/reactor.hpp"
#include "runtime/cpp/src/channel/socket.hpp"

namespace rr::channel {

/// A socket that listens, and makes connections of those who come.
class ListeningSocket final : public Pollable,
                              public Timer,
                              public std::enable_shared_from_this<ListeningSocket> {
 public:
  /// The socket must listen, and not block.
  ListeningSocket(Ground ground, Descriptor socket, LinkTerms terms, AcceptHandler accept);
  ~ListeningSocket();

  void start();
  /// The end: nobody can connect from now on.
  void stop();
  [[nodiscard]] Address address() const { return local_address(socket_.get()); }

  void on_ready(std::uint32_t events) override;

 private:
  void on_timer() override;
  void take(Descriptor accepted);

  const Ground ground_;
  const Descriptor socket_;
  const LinkTerms terms_;
  const AcceptHandler accept_;
  std::atomic<bool> is_stopped_{false};
};

}  // namespace rr::channel
