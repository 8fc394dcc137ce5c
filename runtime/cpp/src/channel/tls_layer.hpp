// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <utility>

#include "runtime/cpp/src/channel/certificate.hpp"
#include "runtime/cpp/src/channel/layer.hpp"
#include "runtime/cpp/src/channel/peer_judge.hpp"

namespace rr::channel {

/// TLS around a stream.
class TlsLayer final : public Layer {
 public:
  /// The rules must live as long.
  TlsLayer(SSL_CTX& context, X509_STORE& authorities, const TlsRules& rules, TlsPeer peer);

  void receive(std::span<const std::byte> wire, Bytes& plain, Bytes& reply) override;
  void send(std::span<const std::byte> plain, Bytes& wire) override;
  void begin(Bytes& wire) override;
  [[nodiscard]] bool is_open() const override { return is_open_; }
  [[nodiscard]] bool has_ended() const override { return has_ended_; }
  [[nodiscard]] bool is_encrypted() const override { return true; }
  [[nodiscard]] NodeId certified_node() const override { return certified_node_; }

  std::shared_ptr<const PeerProof> take_proof() override { return std::move(proof_); }

  /// What a context of this has as its verify callback.
  static int verify(X509_STORE_CTX* chain, void* unused);

 private:
  bool shake_hands();
  void read(Bytes& plain);
  void take_wire(Bytes& wire);
  [[noreturn]] void fail();
  [[nodiscard]] std::string failure_text() const;
  void keep_proof();

  const TlsRules& rules_;
  const TlsPeer peer_;
  const std::unique_ptr<SSL, Releases<SSL_free>> ssl_;
  BIO* from_wire_ = nullptr;  // the connection's
  BIO* to_wire_ = nullptr;
  bool is_open_ = false;
  bool has_ended_ = false;
  NodeId certified_node_;
  std::shared_ptr<const PeerProof> proof_;  // once it is open
  std::string refusal_;
};

}  // namespace rr::channel
