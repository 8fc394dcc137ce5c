// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "rr/node_id.hpp"
#include "rr/options.hpp"
#include "runtime/cpp/src/channel/layer.hpp"

namespace rr::channel {

/// A node's side of TLS: its certificate, whom it trusts, and connections with them (04, section
/// 6). Any thread may use it.
class Tls {
 public:
  /// Reads the files. Throws rr::Error (invalid_configuration) when one cannot be used, or when the
  /// certificate is of another node than `own`.
  Tls(const TlsOptions& options, const NodeId& own);
  ~Tls();
  Tls(const Tls&) = delete;
  Tls& operator=(const Tls&) = delete;

  [[nodiscard]] bool has_certificate() const;
  /// The other side has to prove that it is `expected`, or any node when that is zero.
  [[nodiscard]] std::unique_ptr<Layer> make_client(const NodeId& expected) const;
  /// The other side has to be the host by the rules of the web, or a node.
  [[nodiscard]] std::unique_ptr<Layer> make_web_client(const std::string& host) const;
  /// With `asks`, the client has to prove which node it is.
  [[nodiscard]] std::unique_ptr<Layer> make_server(bool asks) const;

 private:
  struct Files;
  const std::unique_ptr<const Files> files_;
};

/// The node that the certificate of the options is of. Throws rr::Error (invalid_configuration).
NodeId certified_id(const TlsOptions& options);

}  // namespace rr::channel
