// SPDX-License-Identifier: Apache-2.0
// Who the other side is by its certificate (04, section 6), and why it is refused.
#include "runtime/cpp/src/channel/peer_judge.hpp"

#include <openssl/x509_vfy.h>

#include <algorithm>
#include <cctype>
#include <utility>

#include "runtime/cpp/src/channel/issuing.hpp"
#include "runtime/cpp/src/channel/texts.hpp"

namespace rr::channel {
namespace {

std::string reason_of(X509_STORE_CTX& chain) {
  const X509* const at = X509_STORE_CTX_get_current_cert(&chain);
  const bool is_above = X509_STORE_CTX_get_error_depth(&chain) > 0;
  const std::string what =
      is_above ? "a certificate above the other side's" : "the other side's certificate";
  const int code = X509_STORE_CTX_get_error(&chain);
  switch (code) {
    case X509_V_ERR_CERT_HAS_EXPIRED:
      return what + " has expired, on " + text_of(at == nullptr ? nullptr : X509_get0_notAfter(at));
    case X509_V_ERR_CERT_NOT_YET_VALID:
      return what + " is not valid before " +
             text_of(at == nullptr ? nullptr : X509_get0_notBefore(at));
    case X509_V_ERR_CERT_REVOKED:
      return what + " has been revoked";
    case X509_V_ERR_CRL_HAS_EXPIRED:
      return "the list of revoked certificates has run out: this node needs a newer one";
    case X509_V_ERR_UNABLE_TO_GET_ISSUER_CERT:
    case X509_V_ERR_UNABLE_TO_GET_ISSUER_CERT_LOCALLY:
    case X509_V_ERR_DEPTH_ZERO_SELF_SIGNED_CERT:
    case X509_V_ERR_SELF_SIGNED_CERT_IN_CHAIN:
    case X509_V_ERR_UNABLE_TO_VERIFY_LEAF_SIGNATURE:
    case X509_V_ERR_CERT_SIGNATURE_FAILURE:
      return "the other side's certificate is of an authority that this node does not trust";
    default:
      return what + " cannot be trusted: " + X509_verify_cert_error_string(code);
  }
}

class PeerJudge {
 public:
  PeerJudge(const TlsRules& rules, const TlsPeer& peer, bool accepts_outdated_lists)
      : rules_(rules), peer_(peer), accepts_outdated_lists_(accepts_outdated_lists) {}

  Judgement judge(X509_STORE_CTX& chain) {
    X509_STORE_CTX_set_app_data(&chain, this);
    if (judge_certificate(chain)) note_end(chain);
    X509_STORE_CTX_set_app_data(&chain, nullptr);
    return std::move(judgement_);
  }

 private:
  static int pass_over_lists(int is_right, X509_STORE_CTX* chain);
  bool verify(X509_STORE_CTX& chain);
  bool judge_certificate(X509_STORE_CTX& chain);
  bool judge_node(X509_STORE_CTX& chain, const X509& certificate);
  bool judge_host(X509_STORE_CTX& chain, X509& certificate);
  [[nodiscard]] NodeId pinned_node(const X509& certificate) const;
  bool judge_identity(X509_STORE_CTX& chain, const NodeId& node);
  bool judge_chain(X509_STORE_CTX& chain);
  bool judge_marks(X509_STORE_CTX& chain);
  bool judge_pinned(X509_STORE_CTX& chain, const X509& certificate, const std::string& pin);
  bool refuse(X509_STORE_CTX& chain, int code, std::string why);
  void note_end(X509_STORE_CTX& chain);

  const TlsRules& rules_;
  const TlsPeer& peer_;
  const bool accepts_outdated_lists_;
  Judgement judgement_;
};

// Authorities of which there is no list have not revoked anything that could be known.
int PeerJudge::pass_over_lists(int is_right, X509_STORE_CTX* chain) {
  if (is_right != 0) return is_right;
  const auto& judge = *static_cast<const PeerJudge*>(X509_STORE_CTX_get_app_data(chain));
  const int code = X509_STORE_CTX_get_error(chain);
  if (code == X509_V_ERR_UNABLE_TO_GET_CRL) return 1;
  if (code == X509_V_ERR_CRL_HAS_EXPIRED && judge.accepts_outdated_lists_) return 1;
  return is_right;
}

bool PeerJudge::verify(X509_STORE_CTX& chain) {
  X509_STORE_CTX_set_verify_cb(&chain, &pass_over_lists);
  if (X509_verify_cert(&chain) == 1) return true;
  const int code = X509_STORE_CTX_get_error(&chain);
  return refuse(chain, code, reason_of(chain));
}

bool PeerJudge::refuse(X509_STORE_CTX& chain, int code, std::string why) {
  X509_STORE_CTX_set_error(&chain, code);
  judgement_.refusal = std::move(why);
  return false;
}

void PeerJudge::note_end(X509_STORE_CTX& chain) {
  const auto note = [&](const X509* certificate) {
    judgement_.valid_until =
        std::min(judgement_.valid_until, time_of(X509_get0_notAfter(certificate)));
  };
  note(X509_STORE_CTX_get0_cert(&chain));
  const STACK_OF(X509)* const verified = X509_STORE_CTX_get0_chain(&chain);
  const int count = verified == nullptr ? 0 : sk_X509_num(verified);
  for (int i = 0; i < count; ++i) note(sk_X509_value(verified, i));
}

bool PeerJudge::judge_certificate(X509_STORE_CTX& chain) {
  X509* const certificate = X509_STORE_CTX_get0_cert(&chain);
  if (certificate == nullptr) {
    return refuse(chain, X509_V_ERR_CERT_REJECTED, "the other side has no certificate");
  }
  if (peer_.role == TlsPeer::Role::host && !has_mark(*certificate, Mark::node)) {
    return judge_host(chain, *certificate);
  }
  return judge_node(chain, *certificate);
}

bool PeerJudge::judge_node(X509_STORE_CTX& chain, const X509& certificate) {
  const auto node = node_of(certificate);
  if (!node || !has_mark(certificate, Mark::node)) {
    return refuse(chain, X509_V_ERR_CERT_REJECTED, "the other side's certificate is of no node");
  }
  const auto pin = rules_.pins.find(*node);
  const bool is_right = pin != rules_.pins.end() ? judge_pinned(chain, certificate, pin->second)
                                                 : judge_chain(chain) && judge_marks(chain);
  return is_right && judge_identity(chain, *node);
}

bool PeerJudge::judge_identity(X509_STORE_CTX& chain, const NodeId& node) {
  if (!peer_.expected.is_any() && node != peer_.expected) {
    return refuse(chain, X509_V_ERR_CERT_REJECTED,
                  "the other side's certificate is of node " + node.text() + ", not of " +
                      peer_.expected.text());
  }
  judgement_.node = node;
  return true;
}

// The node that a certificate of the web is pinned for; zero: none.
NodeId PeerJudge::pinned_node(const X509& certificate) const {
  const std::string fingerprint = fingerprint_of(certificate);
  const auto expected = rules_.pins.find(peer_.expected);
  if (expected != rules_.pins.end() && in_lower_case(expected->second) == fingerprint) {
    return expected->first;
  }
  const auto found = std::find_if(rules_.pins.begin(), rules_.pins.end(), [&](const auto& pin) {
    return in_lower_case(pin.second) == fingerprint;
  });
  return found == rules_.pins.end() ? NodeId() : found->first;
}

bool PeerJudge::judge_chain(X509_STORE_CTX& chain) {
  // Which of them may be critical is looked at in judge_marks().
  X509_STORE_CTX_set_flags(&chain, X509_V_FLAG_IGNORE_CRITICAL);
  return verify(chain);
}

bool PeerJudge::judge_marks(X509_STORE_CTX& chain) {
  const STACK_OF(X509)* const certificates = X509_STORE_CTX_get0_chain(&chain);
  const int count = sk_X509_num(certificates);
  for (int i = 0; i < count; ++i) {
    const X509& certificate = *sk_X509_value(certificates, i);
    const Mark mark = i == 0 ? Mark::node : i == count - 1 ? Mark::root : Mark::intermediate;
    if (!has_mark(certificate, mark) || !has_only_known_criticals(certificate)) {
      return refuse(chain, X509_V_ERR_CERT_REJECTED,
                    i == 0 ? "the other side's certificate has a critical extension that is unknown"
                           : "a certificate above the other side's is of no authority for nodes");
    }
  }
  return true;
}

bool PeerJudge::judge_pinned(X509_STORE_CTX& chain, const X509& certificate,
                             const std::string& pin) {
  if (fingerprint_of(certificate) != in_lower_case(pin)) {
    return refuse(chain, X509_V_ERR_CERT_REJECTED,
                  "the other side's certificate is not the one that is pinned for its node");
  }
  if (X509_cmp_current_time(X509_get0_notAfter(&certificate)) <= 0) {
    return refuse(chain, X509_V_ERR_CERT_HAS_EXPIRED,
                  "the other side's certificate has expired, on " +
                      text_of(X509_get0_notAfter(&certificate)));
  }
  if (X509_cmp_current_time(X509_get0_notBefore(&certificate)) > 0) {
    return refuse(chain, X509_V_ERR_CERT_NOT_YET_VALID,
                  "the other side's certificate is not valid before " +
                      text_of(X509_get0_notBefore(&certificate)));
  }
  return true;
}

// A host's certificate says nothing of a node.
bool PeerJudge::judge_host(X509_STORE_CTX& chain, X509& certificate) {
  if (const NodeId node = pinned_node(certificate); !node.is_any()) {
    return judge_pinned(chain, certificate, rules_.pins.at(node)) && judge_identity(chain, node);
  }
  if (!peer_.expected.is_any()) {
    return refuse(chain, X509_V_ERR_CERT_REJECTED,
                  rules_.pins.contains(peer_.expected)
                      ? "the other side's certificate is not the one that is pinned for its node"
                      : "the other side's certificate is of a host, and does not prove that it is "
                        "node " +
                            peer_.expected.text() + ": pin it, or leave out `nodeid`");
  }
  if (!verify(chain)) return false;
  if (X509_check_host(&certificate, peer_.host.c_str(), peer_.host.size(), 0, nullptr) == 1 ||
      X509_check_ip_asc(&certificate, peer_.host.c_str(), 0) == 1) {
    return true;
  }
  return refuse(chain, X509_V_ERR_HOSTNAME_MISMATCH,
                "the other side's certificate is not of the host `" + peer_.host + "`");
}

}  // namespace

Judgement judge(X509_STORE_CTX& chain, const TlsRules& rules, const TlsPeer& peer) {
  return PeerJudge(rules, peer, rules.accepts_outdated_lists).judge(chain);
}

Judgement judge_again(const PeerProof& proof, const TlsRules& rules, X509_STORE& trusted) {
  using ChainPtr = std::unique_ptr<X509_STORE_CTX, Releases<X509_STORE_CTX_free>>;
  const ChainPtr chain(X509_STORE_CTX_new());
  if (!chain ||
      X509_STORE_CTX_init(chain.get(), &trusted, proof.certificate.get(), proof.chain.get()) != 1) {
    return {};  // out of memory says nothing of the other side
  }
  const bool is_client = proof.peer.role == TlsPeer::Role::client;
  X509_STORE_CTX_set_default(chain.get(), is_client ? "ssl_client" : "ssl_server");
  X509_STORE_CTX_set_depth(chain.get(), longest_chain);
  return PeerJudge(rules, proof.peer, true).judge(*chain);
}

}  // namespace rr::channel
