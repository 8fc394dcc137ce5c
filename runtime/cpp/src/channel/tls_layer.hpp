// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <string>

#include "runtime/cpp/src/channel/certificate.hpp"
#include "runtime/cpp/src/channel/layer.hpp"

namespace rr::channel {

/// Whom a node trusts besides its authorities.
struct TlsRules {
  std::map<NodeId, std::string> pins;  ///< SHA-256 of certificates, hexadecimal, any case
};

/// What is expected of the other side.
struct TlsPeer {
  enum class Role : std::uint8_t {
    node,    ///< a server that is a node
    host,    ///< a server of the web
    client,  ///< a client
  };
  Role role = Role::node;
  NodeId expected{};      ///< of a node: which one; zero: any
  std::string host{};     ///< of a server of the web: its name
  bool is_asked = false;  ///< of a client: whether it has to prove who it is
};

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

  /// What a context of this has as its verify callback.
  static int verify(X509_STORE_CTX* chain, void* unused);

 private:
  bool shake_hands();
  void read(Bytes& plain);
  void take_wire(Bytes& wire);
  [[noreturn]] void fail();
  [[nodiscard]] std::string failure_text() const;
  bool judge(X509_STORE_CTX& chain);
  bool judge_node(X509_STORE_CTX& chain, const X509& certificate);
  bool judge_host(X509_STORE_CTX& chain, X509& certificate);
  bool judge_chain(X509_STORE_CTX& chain);
  bool judge_marks(X509_STORE_CTX& chain);
  bool judge_pinned(X509_STORE_CTX& chain, const X509& certificate, const std::string& pin);
  bool refuse(X509_STORE_CTX& chain, int code, std::string why);

  const TlsRules& rules_;
  const TlsPeer peer_;
  const std::unique_ptr<SSL, Releases<SSL_free>> ssl_;
  BIO* from_wire_ = nullptr;  // the connection's
  BIO* to_wire_ = nullptr;
  bool is_open_ = false;
  bool has_ended_ = false;
  NodeId certified_node_;
  std::string refusal_;
};

}  // namespace rr::channel
