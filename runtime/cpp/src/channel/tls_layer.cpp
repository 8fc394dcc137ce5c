// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/channel/tls_layer.hpp"

#include <openssl/err.h>

#include <array>
#include <utility>

#include "rr/error.hpp"

namespace rr::channel {
namespace {

constexpr std::size_t record = 16 * 1024;

}  // namespace

TlsLayer::TlsLayer(SSL_CTX& context, X509_STORE& authorities, const TlsRules& rules, TlsPeer peer)
    : rules_(rules), peer_(std::move(peer)), ssl_(SSL_new(&context)) {
  from_wire_ = BIO_new(BIO_s_mem());
  to_wire_ = BIO_new(BIO_s_mem());
  if (!ssl_ || from_wire_ == nullptr || to_wire_ == nullptr) {
    throw Error(ErrorCode::out_of_system_resource, "there is no memory for TLS");
  }
  BIO_set_mem_eof_return(from_wire_, -1);
  BIO_set_mem_eof_return(to_wire_, -1);
  SSL_set_bio(ssl_.get(), from_wire_, to_wire_);
  SSL_set_app_data(ssl_.get(), this);
  SSL_set1_verify_cert_store(ssl_.get(), &authorities);
  SSL_set_verify_depth(ssl_.get(), longest_chain);
  if (peer_.role == TlsPeer::Role::client) {
    SSL_set_accept_state(ssl_.get());
    const int must = SSL_VERIFY_PEER | SSL_VERIFY_FAIL_IF_NO_PEER_CERT;
    SSL_set_verify(ssl_.get(), peer_.is_asked ? must : SSL_VERIFY_NONE, nullptr);
  } else {
    SSL_set_connect_state(ssl_.get());
    SSL_set_verify(ssl_.get(), SSL_VERIFY_PEER, nullptr);
    if (peer_.role == TlsPeer::Role::host) SSL_set_tlsext_host_name(ssl_.get(), peer_.host.c_str());
  }
}

void TlsLayer::begin(Bytes& wire) {
  if (!shake_hands() && !refusal_.empty()) fail();
  take_wire(wire);
}

// False when the other side has to say more, or it has failed, which refusal_ says.
bool TlsLayer::shake_hands() {
  ERR_clear_error();
  const int result = SSL_do_handshake(ssl_.get());
  if (result == 1) {
    is_open_ = true;
    keep_proof();
    return true;
  }
  if (SSL_get_error(ssl_.get(), result) != SSL_ERROR_WANT_READ && refusal_.empty()) {
    refusal_ = failure_text();
  }
  return false;
}

int TlsLayer::verify(X509_STORE_CTX* chain, void* /*unused*/) {
  const int index = SSL_get_ex_data_X509_STORE_CTX_idx();
  auto* const ssl = static_cast<SSL*>(X509_STORE_CTX_get_ex_data(chain, index));
  auto& layer = *static_cast<TlsLayer*>(SSL_get_app_data(ssl));
  Judgement judgement = judge(*chain, layer.rules_, layer.peer_);
  layer.certified_node_ = judgement.node;
  layer.refusal_ = std::move(judgement.refusal);
  return layer.refusal_.empty() ? 1 : 0;
}

// What the connection is looked at again by; nothing when the other side has shown nothing.
void TlsLayer::keep_proof() {
  X509* const certificate = SSL_get0_peer_certificate(ssl_.get());
  if (certificate == nullptr) return;
  X509_up_ref(certificate);
  auto proof = std::make_shared<PeerProof>();
  proof->peer = peer_;
  proof->certificate.reset(certificate);
  STACK_OF(X509)* const sent = SSL_get_peer_cert_chain(ssl_.get());
  if (sent != nullptr) proof->chain.reset(X509_chain_up_ref(sent));
  proof_ = std::move(proof);
}

void TlsLayer::receive(std::span<const std::byte> wire, Bytes& plain, Bytes& reply) {
  BIO_write(from_wire_, wire.data(), static_cast<int>(wire.size()));
  if (is_open_ || shake_hands()) read(plain);
  take_wire(reply);
  if (!refusal_.empty()) fail();
}

void TlsLayer::read(Bytes& plain) {
  while (true) {
    std::array<std::byte, record> bytes;
    ERR_clear_error();
    const int size = SSL_read(ssl_.get(), bytes.data(), static_cast<int>(bytes.size()));
    if (size > 0) {
      append(plain, std::span(bytes).first(static_cast<std::size_t>(size)));
      continue;
    }
    switch (SSL_get_error(ssl_.get(), size)) {
      case SSL_ERROR_WANT_READ:
        break;
      case SSL_ERROR_ZERO_RETURN:
        has_ended_ = true;
        break;
      default:
        refusal_ = failure_text();
    }
    return;
  }
}

void TlsLayer::send(std::span<const std::byte> plain, Bytes& wire) {
  while (!plain.empty()) {
    ERR_clear_error();
    const std::size_t size = std::min(plain.size(), record);
    const int sent = SSL_write(ssl_.get(), plain.data(), static_cast<int>(size));
    if (sent <= 0) break;  // the reading side finds out why
    plain = plain.subspan(static_cast<std::size_t>(sent));
  }
  take_wire(wire);
}

void TlsLayer::take_wire(Bytes& wire) {
  char* bytes = nullptr;
  const long size = BIO_get_mem_data(to_wire_, &bytes);
  if (size > 0) {
    append(wire, {reinterpret_cast<const std::byte*>(bytes), static_cast<std::size_t>(size)});
  }
  BIO_reset(to_wire_);
}

void TlsLayer::fail() { throw Error(ErrorCode::connection_error, refusal_); }

std::string TlsLayer::failure_text() const {
  const unsigned long code = ERR_peek_error();
  switch (ERR_GET_REASON(code)) {
    case SSL_R_TLSV1_ALERT_UNKNOWN_CA:
      return "the other side does not trust the authority of this node's certificate";
    case SSL_R_SSLV3_ALERT_CERTIFICATE_EXPIRED:
      return "the other side says that this node's certificate has expired";
    case SSL_R_SSLV3_ALERT_CERTIFICATE_REVOKED:
      return "the other side says that this node's certificate has been revoked";
    case SSL_R_SSLV3_ALERT_BAD_CERTIFICATE:
    case SSL_R_SSLV3_ALERT_CERTIFICATE_UNKNOWN:
    case SSL_R_SSLV3_ALERT_UNSUPPORTED_CERTIFICATE:
    case SSL_R_TLSV1_ALERT_ACCESS_DENIED:
      return "the other side refuses this node's certificate";
    case SSL_R_TLSV13_ALERT_CERTIFICATE_REQUIRED:
      return "the other side wants a certificate of this node, which has none";
    case SSL_R_PEER_DID_NOT_RETURN_A_CERTIFICATE:
      return "the other side has no certificate, which this node wants";
    case SSL_R_UNSUPPORTED_PROTOCOL:
    case SSL_R_TLSV1_ALERT_PROTOCOL_VERSION:
    case SSL_R_VERSION_TOO_LOW:
      return "the two sides have no version of TLS in common; at least 1.2 is needed";
    case SSL_R_INAPPROPRIATE_FALLBACK:
    case SSL_R_TLSV1_ALERT_INAPPROPRIATE_FALLBACK:
      return "somebody between the two sides has lowered the version of TLS";
    case SSL_R_WRONG_VERSION_NUMBER:
    case SSL_R_HTTP_REQUEST:
      return "the other side does not speak TLS";
    default:
      return "TLS has failed: " + library_error();
  }
}

}  // namespace rr::channel
