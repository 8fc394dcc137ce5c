// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/channel/openssl_tls.hpp"

#include <utility>

#include "rr/error.hpp"
#include "runtime/cpp/src/channel/components.hpp"
#include "runtime/cpp/src/channel/peer_watch.hpp"
#include "runtime/cpp/src/channel/tls_files.hpp"
#include "runtime/cpp/src/channel/tls_layer.hpp"

namespace rr::channel {

OpenSslTls::OpenSslTls(const TlsOptions& options, const NodeId& own,
                       std::shared_ptr<Reactor> reactor,
                       const std::function<void(LogLevel, std::string_view)>& log)
    : has_certificate_(!options.certificate_file.empty()),
      rules_(
          std::make_unique<const TlsRules>(TlsRules{options.pins, options.accepts_outdated_lists})),
      files_(std::make_shared<TlsFiles>(options, own)),
      watch_(std::make_shared<PeerWatch>(files_, *rules_, std::move(reactor),
                                         options.look_again_period, log)) {}

OpenSslTls::~OpenSslTls() = default;

std::unique_ptr<Layer> OpenSslTls::make_layer(TlsPeer peer) const {
  watch_->start();
  files_->look_again(false);
  const auto trust = files_->trust();
  if (peer.role == TlsPeer::Role::host) {
    const StorePtr web = files_->web_store();
    return std::make_unique<TlsLayer>(*trust->context, *web, *rules_, std::move(peer));
  }
  return std::make_unique<TlsLayer>(*trust->context, *trust->nodes, *rules_, std::move(peer));
}

std::unique_ptr<Layer> OpenSslTls::make_client(const NodeId& expected) const {
  return make_layer({.role = TlsPeer::Role::node, .expected = expected});
}

std::unique_ptr<Layer> OpenSslTls::make_web_client(const std::string& host,
                                                   const NodeId& expected) const {
  return make_layer({.role = TlsPeer::Role::host, .expected = expected, .host = host});
}

bool OpenSslTls::is_pinned(const NodeId& node) const { return rules_->pins.contains(node); }

std::unique_ptr<Layer> OpenSslTls::make_server(bool asks) const {
  return make_layer({.role = TlsPeer::Role::client, .is_asked = asks});
}

void OpenSslTls::watch(const std::shared_ptr<Connection>& connection,
                       std::shared_ptr<const PeerProof> proof) const {
  watch_->add(connection, std::move(proof));
}

namespace {

std::shared_ptr<const Tls> make(const TlsOptions& options, const NodeId& own,
                                std::shared_ptr<Reactor> reactor,
                                const std::function<void(LogLevel, std::string_view)>& log) {
  return std::make_shared<const OpenSslTls>(options, own, std::move(reactor), log);
}

NodeId certificate_node(const TlsOptions& options) {
  const Identity identity = read_identity(options.certificate_file, options.key_file);
  const auto node = node_of(*identity.certificate);
  if (!node) {
    throw Error(ErrorCode::invalid_configuration,
                "`" + options.certificate_file + "`: the certificate is of no node");
  }
  return *node;
}

}  // namespace

}  // namespace rr::channel

const rr::channel::TlsComponent rr_component_tls = {&rr::channel::make,
                                                    &rr::channel::certificate_node};
