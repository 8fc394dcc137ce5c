// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/channel/tls.hpp"

#include <filesystem>
#include <mutex>
#include <utility>

#include "rr/error.hpp"
#include "runtime/cpp/src/channel/certificate.hpp"
#include "runtime/cpp/src/channel/environment.hpp"
#include "runtime/cpp/src/channel/tls_layer.hpp"

namespace rr::channel {
namespace {

using FileTime = std::filesystem::file_time_type;

[[noreturn]] void refuse(const std::string& why) {
  throw Error(ErrorCode::invalid_configuration, why);
}

ContextPtr make_context() {
  ContextPtr context(SSL_CTX_new(TLS_method()));
  if (!context) refuse("TLS cannot be used: " + library_error());
  SSL_CTX_set_min_proto_version(context.get(), TLS1_2_VERSION);
  SSL_CTX_set_options(context.get(), SSL_OP_NO_COMPRESSION | SSL_OP_NO_RENEGOTIATION |
                                         SSL_OP_NO_TICKET | SSL_OP_CIPHER_SERVER_PREFERENCE);
  // Each connection is judged anew, by what is revoked by then.
  SSL_CTX_set_session_cache_mode(context.get(), SSL_SESS_CACHE_OFF);
  SSL_CTX_set_num_tickets(context.get(), 0);
  SSL_CTX_set_mode(context.get(), SSL_MODE_RELEASE_BUFFERS);
  SSL_CTX_set_cert_verify_callback(context.get(), &TlsLayer::verify, nullptr);
  return context;
}

std::vector<std::string> authority_files(const TlsOptions& options) {
  std::vector<std::string> files = options.authority_files;
  const std::string file = environment("ROBOTRACONTEUR_SSL_CERT_FILE");
  if (!file.empty()) files.push_back(file);
  const std::string folder = environment("ROBOTRACONTEUR_SSL_CERT_DIR");
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    if (entry.is_regular_file(error)) files.push_back(entry.path().string());
  }
  return files;
}

std::vector<FileTime> times_of(const std::vector<std::string>& files) {
  std::vector<FileTime> times;
  for (const std::string& file : files) {
    std::error_code error;
    times.push_back(std::filesystem::last_write_time(file, error));
  }
  return times;
}

}  // namespace

struct Tls::Files {
  ContextPtr context;
  bool has_certificate = false;
  std::vector<CertificatePtr> authorities;
  std::vector<std::string> revocation_files;
  TlsRules rules;

  mutable std::mutex mutex;  // guards what follows
  mutable StorePtr store;
  mutable std::vector<FileTime> revocation_times;

  void load_certificate(const TlsOptions& options, const NodeId& own);
  StorePtr make_store() const;
  std::unique_ptr<TlsLayer> make_layer(TlsPeer peer) const;
};

void Tls::Files::load_certificate(const TlsOptions& options, const NodeId& own) {
  const Identity identity = read_identity(options.certificate_file, options.key_file);
  const auto node = node_of(*identity.certificate);
  if (!node) refuse("`" + options.certificate_file + "`: the certificate is of no node");
  if (*node != own) {
    refuse("`" + options.certificate_file + "`: the certificate is of node " + node->text() +
           ", and this is " + own.text());
  }
  SSL_CTX* const to = context.get();
  if (SSL_CTX_use_certificate(to, identity.certificate.get()) != 1 ||
      SSL_CTX_use_PrivateKey(to, identity.key.get()) != 1) {
    refuse("`" + options.certificate_file + "`: " + library_error());
  }
  for (const CertificatePtr& above : identity.chain) {
    SSL_CTX_add1_chain_cert(to, above.get());
  }
  has_certificate = true;
}

StorePtr Tls::Files::make_store() const {
  StorePtr made(X509_STORE_new());
  for (const CertificatePtr& authority : authorities) {
    X509_STORE_add_cert(made.get(), authority.get());
  }
  for (const std::string& file : revocation_files) {
    for (const RevocationsPtr& list : read_revocations(file)) {
      X509_STORE_add_crl(made.get(), list.get());
    }
  }
  if (!revocation_files.empty()) {
    X509_STORE_set_flags(made.get(), X509_V_FLAG_CRL_CHECK | X509_V_FLAG_CRL_CHECK_ALL);
  }
  return made;
}

std::unique_ptr<TlsLayer> Tls::Files::make_layer(TlsPeer peer) const {
  if (peer.role == TlsPeer::Role::host) {
    const StorePtr web = make_store();
    X509_STORE_set_default_paths(web.get());  // the authorities of the web
    return std::make_unique<TlsLayer>(*context, *web, rules, std::move(peer));
  }
  const std::lock_guard lock(mutex);
  std::vector<FileTime> times = times_of(revocation_files);
  if (times != revocation_times) {
    store = make_store();  // a list that cannot be read lets nobody in
    revocation_times = std::move(times);
  }
  return std::make_unique<TlsLayer>(*context, *store, rules, std::move(peer));
}

Tls::Tls(const TlsOptions& options, const NodeId& own)
    : files_([&] {
        auto files = std::make_unique<Files>();
        files->context = make_context();
        if (!options.certificate_file.empty()) files->load_certificate(options, own);
        for (const std::string& file : authority_files(options)) {
          for (CertificatePtr& each : read_certificates(file)) {
            files->authorities.push_back(std::move(each));
          }
        }
        files->revocation_files = options.revocation_files;
        files->rules.pins = options.pins;
        files->revocation_times = times_of(files->revocation_files);
        files->store = files->make_store();
        return files;
      }()) {}

Tls::~Tls() = default;

bool Tls::has_certificate() const { return files_->has_certificate; }

std::unique_ptr<Layer> Tls::make_client(const NodeId& expected) const {
  return files_->make_layer({.role = TlsPeer::Role::node, .expected = expected});
}

std::unique_ptr<Layer> Tls::make_web_client(const std::string& host) const {
  return files_->make_layer({.role = TlsPeer::Role::host, .host = host});
}

std::unique_ptr<Layer> Tls::make_server(bool asks) const {
  return files_->make_layer({.role = TlsPeer::Role::client, .is_asked = asks});
}

NodeId certified_id(const TlsOptions& options) {
  const Identity identity = read_identity(options.certificate_file, options.key_file);
  const auto node = node_of(*identity.certificate);
  if (!node) refuse("`" + options.certificate_file + "`: the certificate is of no node");
  return *node;
}

}  // namespace rr::channel
