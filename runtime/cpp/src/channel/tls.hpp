// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "rr/node_id.hpp"
#include "runtime/cpp/src/channel/layer.hpp"

namespace rr::channel {

class Connection;

/// A node's side of TLS: its certificate, whom it trusts, and connections with them (04, section
/// 6). Any thread may use it. See components.hpp for who makes one.
class Tls {
 public:
  virtual ~Tls() = default;

  [[nodiscard]] virtual bool has_certificate() const = 0;
  /// The other side has to prove that it is `expected`, or any node when that is zero.
  [[nodiscard]] virtual std::unique_ptr<Layer> make_client(const NodeId& expected) const = 0;
  /// The other side has to be the host by the rules of the web, or a node. It has to prove that it
  /// is `expected` unless that is zero: with a node's certificate, or one that is pinned for it.
  [[nodiscard]] virtual std::unique_ptr<Layer> make_web_client(const std::string& host,
                                                               const NodeId& expected) const = 0;
  /// Whether a node has to show one certain certificate.
  [[nodiscard]] virtual bool is_pinned(const NodeId& node) const = 0;
  /// With `asks`, the client has to prove which node it is.
  [[nodiscard]] virtual std::unique_ptr<Layer> make_server(bool asks) const = 0;

  /// Closes a connection when the other side would not be let in any more with what it has shown.
  virtual void watch(const std::shared_ptr<Connection>& connection,
                     std::shared_ptr<const PeerProof> proof) const = 0;
};

}  // namespace rr::channel
