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
#include "runtime/cpp/src/channel/tls.hpp"

namespace rr::channel {

class PeerWatch;
class Reactor;
class TlsFiles;
struct TlsPeer;
struct TlsRules;

/// TLS by OpenSSL. Files that change are read again.
class OpenSslTls final : public Tls {
 public:
  /// Reads the files. Throws rr::Error (invalid_configuration) when one cannot be used, or when the
  /// certificate is of another node than `own`. Without a reactor nothing is done by itself.
  OpenSslTls(const TlsOptions& options, const NodeId& own,
             std::shared_ptr<Reactor> reactor = nullptr,
             const std::function<void(LogLevel, std::string_view)>& log = {});
  ~OpenSslTls() override;
  OpenSslTls(const OpenSslTls&) = delete;
  OpenSslTls& operator=(const OpenSslTls&) = delete;

  [[nodiscard]] bool has_certificate() const override { return has_certificate_; }
  [[nodiscard]] std::unique_ptr<Layer> make_client(const NodeId& expected) const override;
  [[nodiscard]] std::unique_ptr<Layer> make_web_client(const std::string& host,
                                                       const NodeId& expected) const override;
  [[nodiscard]] bool is_pinned(const NodeId& node) const override;
  [[nodiscard]] std::unique_ptr<Layer> make_server(bool asks) const override;
  void watch(const std::shared_ptr<Connection>& connection,
             std::shared_ptr<const PeerProof> proof) const override;

 private:
  [[nodiscard]] std::unique_ptr<Layer> make_layer(TlsPeer peer) const;

  const bool has_certificate_;
  const std::unique_ptr<const TlsRules> rules_;
  const std::shared_ptr<TlsFiles> files_;
  const std::shared_ptr<PeerWatch> watch_;
};

}  // namespace rr::channel
