// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <string>

#include "rr/node_id.hpp"

namespace rr {

/// An authority of one's own for the certificates of nodes (04, section 6), kept in a folder:
///
///   ca.pem         its certificate, which nodes that trust it have as an authority file
///   ca.key         its key, mode 0600: whoever has it can be any node
///   revoked.pem    what it has revoked, for TlsOptions::revocation_files
///   nodes/ID.pem   a node's certificate and key, mode 0600, and the same as ID.p12
///
/// One thread at a time. All of it throws rr::Error: invalid_argument, or invalid_configuration for
/// files that cannot be used.
class Authority {
 public:
  using Days = std::chrono::duration<int, std::ratio<86400>>;

  /// Makes a new one. Throws invalid_operation when the folder has one already.
  static Authority create(const std::string& folder, const std::string& name = "Robdef nodes",
                          Days validity = Days(3650));
  /// One that exists.
  explicit Authority(std::string folder);

  /// Makes a node's certificate and key, in place of earlier ones, which stay valid until they are
  /// revoked. Returns the file, `ID.pem`. A validity of less than nothing makes one that has
  /// expired, for trying what happens.
  std::string issue(const NodeId& node, Days validity = Days(825));
  /// Revokes the certificate that the folder has for a node.
  void revoke(const NodeId& node);

  [[nodiscard]] std::string certificate_file() const { return folder_ + "/ca.pem"; }
  [[nodiscard]] std::string revocation_file() const { return folder_ + "/revoked.pem"; }

 private:
  std::string folder_;
};

}  // namespace rr
