// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "rr/authority.hpp"
#include "runtime/cpp/src/channel/certificate.hpp"

/// Making keys, certificates, requests for them and lists of revoked ones.
namespace rr::channel {

using RequestPtr = std::unique_ptr<X509_REQ, Releases<X509_REQ_free>>;

/// Throws rr::Error (internal_error) with what the library says, unless something went right.
void check_made(bool is_right);

KeyPtr make_key();
/// The certificate of an authority, signed with its own key.
CertificatePtr make_root(const std::string& name, EVP_PKEY& key, Authority::Days validity);
/// The certificate of a node, signed by an authority, which it does not outlast.
CertificatePtr make_node_certificate(const NodeId& node, EVP_PKEY& key, const Identity& authority,
                                     Authority::Days validity);
RequestPtr make_request(const NodeId& node, EVP_PKEY& key);
/// A request of a file whose signature, key and subject are right. Throws rr::Error
/// (invalid_configuration).
RequestPtr read_request(const std::string& file);
/// The node that a request is for.
NodeId node_of(const X509_REQ& request);
/// The SHA-256 of a public key, hexadecimal.
std::string key_fingerprint(EVP_PKEY& key);

/// What a list of revoked certificates says.
struct Revocations {
  struct Entry {
    std::string serial;
    std::chrono::system_clock::time_point when;
  };
  std::vector<Entry> entries;
  Authority::Days validity = Authority::list_validity;
  std::chrono::system_clock::time_point runs_out{};
  long number = 0;  ///< of this list; grows
};
Revocations revocations_of(const X509_CRL& list);
/// The list that comes after this one, valid from now on.
RevocationsPtr make_list(const Revocations& revocations, const Identity& authority);

std::string serial_of(const X509& certificate);
std::chrono::system_clock::time_point time_of(const ASN1_TIME* time);

/// The bytes of what `print` prints.
std::string printed(const std::function<bool(BIO*)>& print);
/// A key as PEM, encrypted with a passphrase unless that is empty.
std::string key_text(EVP_PKEY& key, const std::string& passphrase);
/// The key of a PEM file. Throws rr::Error: authentication_error for a passphrase that is missing
/// or wrong.
KeyPtr read_key(const std::string& file, const std::string& passphrase);

}  // namespace rr::channel
