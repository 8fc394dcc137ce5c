// SPDX-License-Identifier: Apache-2.0
#include "gateway/broker_tls.hpp"

#include <openssl/err.h>
#include <openssl/ssl.h>
#include <openssl/x509_vfy.h>

#include <array>
#include <utility>

#include "rr/error.hpp"

namespace rr::gateway {
namespace {

[[noreturn]] void refuse_file(const std::string& file, const char* what) {
  std::array<char, 256> text{};
  ERR_error_string_n(ERR_peek_last_error(), text.data(), text.size());
  const char* const reason = ERR_reason_error_string(ERR_peek_last_error());
  const std::string why = reason != nullptr ? reason : text.data();
  ERR_clear_error();
  throw Error(ErrorCode::invalid_configuration, file + ": " + what + ": " + why);
}

/// A key with a passphrase is refused: nobody is there to be asked for it.
int no_passphrase(char*, int, int, void*) { return 0; }

/// The host that the certificate has to be for, as a name or as an address.
void expect_host(X509_STORE_CTX* store, const std::string& host) {
  X509_VERIFY_PARAM* const wanted = X509_STORE_CTX_get0_param(store);
  if (X509_VERIFY_PARAM_set1_ip_asc(wanted, host.c_str()) != 1) {
    X509_VERIFY_PARAM_set1_host(wanted, host.c_str(), host.size());
  }
}

}  // namespace

void BrokerTls::Freed::operator()(ssl_ctx_st* context) const { SSL_CTX_free(context); }

BrokerTls::BrokerTls(const BrokerOptions& broker, std::string host)
    : host_(std::move(host)),
      authority_(broker.authority),
      context_(SSL_CTX_new(TLS_client_method())) {
  if (!context_) throw Error(ErrorCode::internal_error, "TLS is not available");
  SSL_CTX_set_min_proto_version(context_.get(), TLS1_2_VERSION);
  SSL_CTX_set_default_passwd_cb(context_.get(), no_passphrase);
  SSL_CTX_set_verify(context_.get(), SSL_VERIFY_PEER, nullptr);
  read_authority(broker);
  read_certificate(broker);
  const auto verify = [](X509_STORE_CTX* store, void* user) {
    auto& self = *static_cast<BrokerTls*>(user);
    expect_host(store, self.host_);
    if (X509_verify_cert(store) == 1) return 1;
    const int error = X509_STORE_CTX_get_error(store);
    const bool is_host =
        error == X509_V_ERR_HOSTNAME_MISMATCH || error == X509_V_ERR_IP_ADDRESS_MISMATCH;
    self.trouble_ = is_host
                        ? "the broker's certificate is not for `" + self.host_ + "`"
                        : std::string("the broker's certificate is refused: ") +
                              X509_verify_cert_error_string(error) + " (authorities: " +
                              (self.authority_.empty() ? "of the system" : self.authority_) + ")";
    return 0;
  };
  SSL_CTX_set_cert_verify_callback(context_.get(), verify, this);
}

BrokerTls::~BrokerTls() = default;

void BrokerTls::read_authority(const BrokerOptions& broker) {
  if (broker.authority.empty()) {
    SSL_CTX_set_default_verify_paths(context_.get());
  } else if (SSL_CTX_load_verify_locations(context_.get(), broker.authority.c_str(), nullptr) !=
             1) {
    refuse_file(broker.authority, "no certificate authority");
  }
}

void BrokerTls::read_certificate(const BrokerOptions& broker) {
  if (broker.certificate.empty()) {
    if (broker.key.empty()) return;
    throw Error(ErrorCode::invalid_configuration, broker.key + ": a key without a `certificate`");
  }
  if (SSL_CTX_use_certificate_chain_file(context_.get(), broker.certificate.c_str()) != 1) {
    refuse_file(broker.certificate, "no certificate");
  }
  const std::string& key = broker.key.empty() ? broker.certificate : broker.key;
  if (SSL_CTX_use_PrivateKey_file(context_.get(), key.c_str(), SSL_FILETYPE_PEM) != 1) {
    refuse_file(key, "no key of the certificate");
  }
}

std::string tls_reason(const std::string& line) {
  if (line.find("wrong version number") != std::string::npos) return "the broker speaks no TLS";
  constexpr std::string_view alert = "alert ";
  const std::size_t at = line.find(alert);
  if (at == std::string::npos) return {};
  return "the broker has ended the connection: " + line.substr(at + alert.size());
}

}  // namespace rr::gateway
