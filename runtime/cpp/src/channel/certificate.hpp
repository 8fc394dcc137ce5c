// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openssl/evp.h>
#include <openssl/pkcs12.h>
#include <openssl/ssl.h>
#include <openssl/x509v3.h>

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "rr/node_id.hpp"

/// Certificates of nodes and of their authorities (04, section 6).
namespace rr::channel {

template <auto release>
struct Releases {
  template <class T>
  void operator()(T* object) const {
    release(object);
  }
};
using CertificatePtr = std::unique_ptr<X509, Releases<X509_free>>;
using RevocationsPtr = std::unique_ptr<X509_CRL, Releases<X509_CRL_free>>;
using KeyPtr = std::unique_ptr<EVP_PKEY, Releases<EVP_PKEY_free>>;
using StorePtr = std::unique_ptr<X509_STORE, Releases<X509_STORE_free>>;
using ContextPtr = std::unique_ptr<SSL_CTX, Releases<SSL_CTX_free>>;

/// What a certificate is for, as its critical extension says.
enum class Mark : std::uint8_t { root = 1, intermediate = 2, node = 3 };
/// The identifier of that extension.
std::string mark_identifier(Mark mark);
/// Whether a certificate has the extension, and it is critical.
bool has_mark(const X509& certificate, Mark mark);
/// Whether all critical extensions are known ones.
bool has_only_known_criticals(const X509& certificate);

/// The name that a node's certificate is for.
std::string subject_of(const NodeId& node);
/// The node that a subject names; nothing when it is another one.
std::optional<NodeId> node_in(const X509_NAME& subject);
/// The node that a certificate is for; nothing when its subject is another one.
std::optional<NodeId> node_of(const X509& certificate);
/// Bytes as hexadecimal digits in lower case.
std::string hexadecimal(std::span<const unsigned char> bytes);
/// The SHA-256 of a certificate, as hexadecimal digits in lower case.
std::string fingerprint_of(const X509& certificate);
/// A time of a certificate, for people.
std::string text_of(const ASN1_TIME* time);

using FilePtr = std::unique_ptr<BIO, Releases<BIO_free>>;
/// A file of 1 MiB at most, to be read. Throws rr::Error (invalid_configuration).
FilePtr open_certificate_file(const std::string& name);

/// What a file of PEM or `.p12` has.
struct Identity {
  KeyPtr key;
  CertificatePtr certificate;
  std::vector<CertificatePtr> chain;  // above it
};
/// Throws rr::Error (invalid_configuration); so do the others.
Identity read_identity(const std::string& certificate_file, const std::string& key_file);
std::vector<CertificatePtr> read_certificates(const std::string& file);
std::vector<RevocationsPtr> read_revocations(const std::string& file);

/// The last error of the library, for people, which is forgotten with the others.
std::string library_error();

}  // namespace rr::channel
