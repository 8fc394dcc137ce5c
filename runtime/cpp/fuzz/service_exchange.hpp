// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <span>

#include "rr/message_tree.hpp"
#include "rr/node.hpp"
#include "runtime/cpp/fuzz/conversation.hpp"

namespace rr::fuzz {

/// A node and its service under fire. Aborts the process when the node breaks a promise: all that
/// it sends can be read, a connection that the client has ended goes away and leaves nothing
/// behind, and another client is served as if nothing had been.
class ServiceExchange {
 public:
  /// Longer inputs could fill a socket's buffer, and are left out.
  static constexpr std::size_t longest_input = 64 * 1024;

  ServiceExchange();

  /// Offers a new service, sends it `input` on a connection of its own, reads what comes back until
  /// the node closes the connection, and takes the service away.
  void run(std::span<const std::byte> input);

 private:
  using Taker = std::function<void(const MessageTree&)>;

  void offer_service();
  void take_service_away();
  void converse(std::span<const std::byte> input, const Taker& take);
  void send_rest(std::uint32_t service_endpoint);
  void serve_clean_client();

  Node node_;
  std::shared_ptr<const int> life_;  // of the service's objects
  Service service_;
  std::uint64_t runs_ = 0;

  int client_ = -1;   // the client's end of the connection
  int adopted_ = -1;  // the node's

  std::mutex mutex_;
  bool must_send_rest_ = false;
  bool waits_for_answer_ = false;  // before the client has no more to send
  Bytes rest_;                     // waits for the number of the service's endpoint
};

}  // namespace rr::fuzz
