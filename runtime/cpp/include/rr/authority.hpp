// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "rr/node_id.hpp"
#include "rr/visibility.hpp"

namespace RR_VISIBLE rr {

/// A certificate that an authority has issued.
struct IssuedCertificate {
  /// A moment, UTC.
  using Time = std::chrono::system_clock::time_point;

  std::string serial;             ///< hexadecimal, lower case
  NodeId node;                    ///< whose certificate it is
  std::string name;               ///< what it was called when it was issued; may be empty
  Time not_before;                ///< valid from
  Time not_after;                 ///< valid until
  std::optional<Time> revoked{};  ///< when, if it was

  /// Whether all fields are equal.
  bool operator==(const IssuedCertificate&) const = default;
};

/// A certificate authority for nodes (04, section 6), kept in a folder of mode 0700:
///
///   ca.pem         its certificate, which nodes that trust it have as an authority file
///   ca.key         its key, mode 0600, perhaps with a passphrase: its holder can be any node
///   revoked.pem    what it has revoked, for TlsOptions::revocation_files; runs out
///   index          what it has issued, a line each
///   nodes/ID.pem   a node's certificate and key, mode 0600, and the same as ID.p12
///   nodes/ID.cert.pem  a node's certificate, where the key is the node's secret
///
/// Several programs may use one folder at once. One thread at a time uses an object. All of it
/// throws rr::Error: invalid_argument, invalid_configuration for files that cannot be used,
/// authentication_error for a wrong passphrase.
class Authority {
 public:
  /// A validity, in days of 24 hours.
  using Days = std::chrono::duration<int, std::ratio<86400>>;
  /// How long lists of revoked certificates are valid, unless another time was set.
  static constexpr Days list_validity{7};
  /// The key of a renewed certificate: `same`, that of the certificate before, or `another`.
  enum class RenewedKey { same, another };

  /// Makes a new one. Without a passphrase its key is stored in clear. Throws invalid_operation
  /// when the folder has one already.
  static Authority create(const std::string& folder, const std::string& name = "Robdef nodes",
                          Days validity = Days(3650), const std::string& passphrase = {});
  /// One that exists. The passphrase is needed by all that signs: everything but issued().
  explicit Authority(std::string folder, std::string passphrase = {});
  ~Authority();
  /// Another object for the same folder, with the same passphrase.
  Authority(const Authority&);
  Authority& operator=(const Authority&) = delete;

  /// Whether the key in a folder has a passphrase.
  static bool has_passphrase(const std::string& folder);
  /// Gives the key another passphrase; an empty one stores it in clear.
  void set_passphrase(const std::string& passphrase);

  /// Makes a node's certificate and key, in place of earlier ones, which stay valid until they are
  /// revoked. Returns the file, `ID.pem`. `name` stands in the index. The certificate ends with
  /// that of the authority at the latest. A validity of less than nothing makes one that has
  /// expired, for trying what happens.
  std::string issue(const NodeId& node, Days validity = Days(825), const std::string& name = {});
  /// The same for a node that has a certificate and key in the folder; the old certificate stays
  /// valid.
  std::string renew(const NodeId& node, RenewedKey key = RenewedKey::same,
                    Days validity = Days(825), const std::string& name = {});
  /// Issues a certificate for a request (request_certificate()). The request has to be signed with
  /// its own key, which must be of at least 112 bits of strength, and its subject must be a node;
  /// nothing else is taken from it. Returns the file, `ID.cert.pem`.
  std::string sign(const std::string& request_file, Days validity = Days(825),
                   const std::string& name = {});

  /// What was issued, in this order, revoked and expired ones included.
  [[nodiscard]] std::vector<IssuedCertificate> issued() const;

  /// Revokes every certificate of a node; how many there were that had not been. Throws
  /// invalid_argument when the authority has issued none for it.
  std::size_t revoke(const NodeId& node);
  /// Every certificate of a node but the one that was issued last.
  std::size_t revoke_earlier(const NodeId& node);
  /// One certificate by its serial, hexadecimal, colons between allowed.
  std::size_t revoke_serial(const std::string& serial);
  /// The first certificate of a PEM file, which must be of this authority.
  std::size_t revoke_file(const std::string& file);
  /// Signs the list of revoked certificates anew. Its validity becomes that of later ones too;
  /// without one it is that of the list before.
  void refresh(std::optional<Days> validity = std::nullopt);
  /// When the list of revoked certificates runs out.
  [[nodiscard]] IssuedCertificate::Time list_runs_out() const;

  /// The file of its certificate, for TlsOptions::authority_files.
  [[nodiscard]] std::string certificate_file() const { return folder_ + "/ca.pem"; }
  /// The file of its list of revoked certificates, for TlsOptions::revocation_files.
  [[nodiscard]] std::string revocation_file() const { return folder_ + "/revoked.pem"; }

 private:
  class Work;

  std::string folder_;
  std::string passphrase_;
};

/// A node's key and the request for its certificate.
struct CertificateRequest {
  std::string key_file;      ///< `ID.key`, mode 0600: stays on the node's machine
  std::string request_file;  ///< `ID.csr`, for Authority::sign()
  std::string fingerprint;  ///< SHA-256 of the public key, hexadecimal, to compare at the authority
};
/// Makes both in a folder, on the machine of the node. With `keeps_key` the request is for the key
/// that is there. Throws rr::Error: invalid_operation when there is a key already, or as above.
CertificateRequest request_certificate(const std::string& folder, const NodeId& node,
                                       bool keeps_key = false);
/// The node and the fingerprint (CertificateRequest::fingerprint) of a request. Throws as sign().
std::pair<NodeId, std::string> read_certificate_request(const std::string& request_file);

}  // namespace rr
