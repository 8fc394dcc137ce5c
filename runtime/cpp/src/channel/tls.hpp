// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "rr/node_id.hpp"
#include "rr/options.hpp"
#include "runtime/cpp/src/channel/connection.hpp"
#include "runtime/cpp/src/channel/layer.hpp"

namespace rr::channel {

class PeerWatch;
class Reactor;
class TlsFiles;
struct TlsPeer;
struct TlsRules;

/// A node's side of TLS: its certificate, whom it trusts, and connections with them (04, section
/// 6). Files that change are read again. Any thread may use it.
class Tls {
 public:
  /// Reads the files. Throws rr::Error (invalid_configuration) when one cannot be used, or when the
  /// certificate is of another node than `own`. Without a reactor nothing is done by itself.
  Tls(const TlsOptions& options, const NodeId& own, std::shared_ptr<Reactor> reactor = nullptr,
      const std::function<void(LogLevel, std::string_view)>& log = {});
  ~Tls();
  Tls(const Tls&) = delete;
  Tls& operator=(const Tls&) = delete;

  [[nodiscard]] bool has_certificate() const { return has_certificate_; }
  /// The other side has to prove that it is `expected`, or any node when that is zero.
  [[nodiscard]] std::unique_ptr<Layer> make_client(const NodeId& expected) const;
  /// The other side has to be the host by the rules of the web, or a node. It has to prove that it
  /// is `expected` unless that is zero: with a node's certificate, or one that is pinned for it.
  [[nodiscard]] std::unique_ptr<Layer> make_web_client(const std::string& host,
                                                       const NodeId& expected) const;
  /// Whether a node has to show one certain certificate.
  [[nodiscard]] bool is_pinned(const NodeId& node) const;
  /// With `asks`, the client has to prove which node it is.
  [[nodiscard]] std::unique_ptr<Layer> make_server(bool asks) const;

  /// Closes a connection when the other side would not be let in any more with what it has shown.
  void watch(const std::shared_ptr<Connection>& connection,
             std::shared_ptr<const PeerProof> proof) const;

 private:
  [[nodiscard]] std::unique_ptr<Layer> make_layer(TlsPeer peer) const;

  const bool has_certificate_;
  const std::unique_ptr<const TlsRules> rules_;
  const std::shared_ptr<TlsFiles> files_;
  const std::shared_ptr<PeerWatch> watch_;
};

/// The node that the certificate of the options is of. Throws rr::Error (invalid_configuration).
NodeId certified_id(const TlsOptions& options);

}  // namespace rr::channel
