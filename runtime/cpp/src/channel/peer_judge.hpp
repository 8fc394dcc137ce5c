// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <string>

#include "rr/node_id.hpp"
#include "runtime/cpp/src/channel/certificate.hpp"

/// Who the other side of a connection is by its certificate (04, section 6), when it connects and
/// while the connection lasts.
namespace rr::channel {

/// Certificates in a chain: the node's, an authority's, and some between.
inline constexpr int longest_chain = 6;

/// Whom a node trusts besides its authorities, and how strictly.
struct TlsRules {
  std::map<NodeId, std::string> pins;  ///< SHA-256 of certificates, hexadecimal, any case
  /// A list of revoked certificates that has run out is used all the same.
  bool accepts_outdated_lists = false;
};

/// What is expected of the other side.
struct TlsPeer {
  enum class Role : std::uint8_t {
    node,    ///< a server that is a node
    host,    ///< a server of the web
    client,  ///< a client
  };
  Role role = Role::node;
  NodeId expected{};      ///< of a server: which node; zero: any
  std::string host{};     ///< of a server of the web: its name
  bool is_asked = false;  ///< of a client: whether it has to prove who it is
};

/// What the other side has shown; does not change.
struct PeerProof {
  struct ReleasesAll {
    void operator()(STACK_OF(X509) * sent) const { sk_X509_pop_free(sent, X509_free); }
  };

  TlsPeer peer;
  CertificatePtr certificate;
  std::unique_ptr<STACK_OF(X509), ReleasesAll> chain;  ///< as it was sent
};

/// The result of judging a certificate.
struct Judgement {
  std::string refusal{};  ///< why it is refused; empty: it is not
  NodeId node{};          ///< which one it is; zero: a host of the web
  /// When one of the certificates expires.
  std::chrono::system_clock::time_point valid_until{std::chrono::system_clock::time_point::max()};
};

/// Judges a certificate that is in `chain`, which gets the error for the other side.
Judgement judge(X509_STORE_CTX& chain, const TlsRules& rules, const TlsPeer& peer);

/// Whether one who has been let in would still be, by the authorities and the lists of `trusted`. A
/// list that has run out is no reason: it says nothing new of a certificate that it was no reason
/// against when the connection began.
Judgement judge_again(const PeerProof& proof, const TlsRules& rules, X509_STORE& trusted);

}  // namespace rr::channel
