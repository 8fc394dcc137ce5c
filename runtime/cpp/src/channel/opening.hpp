// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "rr/options.hpp"
#include "rr/url.hpp"
#include "runtime/cpp/src/channel/channel.hpp"
#include "runtime/cpp/src/channel/handshake.hpp"
#include "runtime/cpp/src/channel/layered_carrier.hpp"
#include "runtime/cpp/src/channel/socket.hpp"
#include "runtime/cpp/src/channel/tcp_connect.hpp"

namespace rr::channel {

/// One address on its way from nothing to an agreed connection. Never blocks. Each function throws
/// rr::Error, which ends it.
class Opening {
 public:
  /// ChannelContext and URL must live as long.
  Opening(const Address& address, const Url& url, const ChannelContext& context);

  /// What it waits for.
  [[nodiscard]] platform::Awaited wanted() const;
  /// The outcome; to be called after the socket was found ready.
  std::optional<Agreed> go_on();

 private:
  void connected();
  [[noreturn]] void fail_connecting(const std::error_code& error) const;
  void check_server() const;
  void next_step();
  void begin_layer(std::unique_ptr<Layer> layer);
  bool go_on_with_layer();
  bool receive_answer();
  std::ptrdiff_t receive(std::span<std::byte> room);
  void send(std::span<const std::byte> message);
  void agree();
  void open_memory();
  std::optional<Agreed> finish();
  [[noreturn]] void fail_reading(std::ptrdiff_t size) const;
  LayeredCarrier& carrier();

  const Url& url_;
  const ChannelContext& context_;
  const NodeOptions& options_;
  const std::vector<OpeningStep> steps_;
  std::size_t step_ = 0;
  Descriptor socket_;
  std::unique_ptr<LayeredCarrier> carrier_;
  std::string place_;
  const std::vector<platform::UserId> servers_;
  bool is_connected_ = false;
  NodeId said_node_;  // what the other side claimed before TLS
  Agreed agreed_;     // from agree() on
  Descriptor memory_;
  std::vector<std::byte> request_;
  std::vector<std::byte> answer_;
  std::size_t answer_size_ = 0;  // once known
};

}  // namespace rr::channel
