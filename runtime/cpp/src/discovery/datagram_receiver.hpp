// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <set>
#include <string_view>
#include <system_error>
#include <vector>

#include "rr/discovery.hpp"
#include "rr/mutex.hpp"
#include "runtime/cpp/src/channel/reactor.hpp"
#include "runtime/cpp/src/channel/socket.hpp"

namespace rr::discovery {

/// Listens to the datagrams of discovery, of both families.
class DatagramReceiver : public std::enable_shared_from_this<DatagramReceiver> {
 public:
  /// On a thread of the node, by one at a time for each family.
  using Handler = std::function<void(std::string_view packet, const channel::Address& sender)>;

  DatagramReceiver(std::shared_ptr<channel::Reactor> reactor, DiscoveryNetwork network,
                   Handler handler);
  ~DatagramReceiver();

  /// Opens the sockets. Throws rr::Error (connection_error) when IPv4 cannot be listened to; a
  /// machine may lack IPv6.
  void start();
  void stop();
  /// Joins the groups on interfaces that have come since.
  void join_groups();

 private:
  class Socket;
  std::shared_ptr<Socket> open(channel::Family family, std::error_code& error);

  const std::shared_ptr<channel::Reactor> reactor_;
  const DiscoveryNetwork network_;
  const Handler handler_;
  Mutex mutex_;
  std::vector<std::shared_ptr<Socket>> sockets_ RR_GUARDED_BY(mutex_);
  std::shared_ptr<Socket> v6_ RR_GUARDED_BY(mutex_);
  std::set<unsigned> joined_ RR_GUARDED_BY(mutex_);
};

/// The groups of IPv6 that a network uses, as texts.
std::vector<const char*> groups_of(const DiscoveryNetwork& network, bool is_loopback);

}  // namespace rr::discovery
