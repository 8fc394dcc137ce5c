// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <memory>

#include "rr/mutex.hpp"
#include "runtime/cpp/src/channel/channel.hpp"
#include "runtime/cpp/src/channel/link_terms.hpp"
#include "runtime/cpp/src/channel/reactor.hpp"
#include "runtime/cpp/src/channel/socket.hpp"
#include "runtime/cpp/src/platform/files.hpp"

namespace rr::channel {

/// A socket that listens, and makes connections of those who come. When the process has no more
/// descriptors the oldest connection without a session gives way; a descriptor that is kept for
/// this lets the new one in at once, or refuses it.
class ListeningSocket final : public Pollable,
                              public Timer,
                              public std::enable_shared_from_this<ListeningSocket> {
 public:
  /// The socket must listen, and not block.
  ListeningSocket(ChannelContext context, Descriptor socket, LinkTerms terms, AcceptHandler accept);
  ~ListeningSocket();

  void start();
  /// The end: nobody can connect from now on.
  void stop();
  [[nodiscard]] Address address() const { return platform::local_address(socket_.get()); }

  void on_ready(std::uint32_t events) override;

 private:
  void on_timer() override;
  void take(Descriptor accepted);
  [[nodiscard]] bool is_welcome(const Descriptor& accepted) const;
  bool keep_spare();
  bool may_give_way();
  bool take_with_spare();
  void look_again();
  void ask_again();

  const ChannelContext context_;
  const Descriptor socket_;
  const LinkTerms terms_;
  const AcceptHandler accept_;
  std::atomic<bool> is_stopped_{false};
  Mutex mutex_;
  platform::File spare_ RR_GUARDED_BY(mutex_);
  Time gave_way_ RR_GUARDED_BY(mutex_){};
};

}  // namespace rr::channel
