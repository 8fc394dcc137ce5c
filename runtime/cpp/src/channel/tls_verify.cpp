// SPDX-License-Identifier: Apache-2.0
// Who the other side is by its certificate (04, section 6), and why it is refused.
#include <openssl/x509_vfy.h>

#include <algorithm>
#include <cctype>
#include <utility>

#include "runtime/cpp/src/channel/tls_layer.hpp"

namespace rr::channel {
namespace {

// Authorities of which there is no list have not revoked anything that could be known.
int pass_without_list(int is_right, X509_STORE_CTX* chain) {
  if (is_right == 0 && X509_STORE_CTX_get_error(chain) == X509_V_ERR_UNABLE_TO_GET_CRL) return 1;
  return is_right;
}

std::string in_lower_case(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

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
      return "the list of revoked certificates is out of date";
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

}  // namespace

int TlsLayer::verify(X509_STORE_CTX* chain, void* /*unused*/) {
  const int index = SSL_get_ex_data_X509_STORE_CTX_idx();
  auto* const ssl = static_cast<SSL*>(X509_STORE_CTX_get_ex_data(chain, index));
  return static_cast<TlsLayer*>(SSL_get_app_data(ssl))->judge(*chain) ? 1 : 0;
}

bool TlsLayer::refuse(X509_STORE_CTX& chain, int code, std::string why) {
  X509_STORE_CTX_set_error(&chain, code);
  refusal_ = std::move(why);
  return false;
}

bool TlsLayer::judge(X509_STORE_CTX& chain) {
  X509* const certificate = X509_STORE_CTX_get0_cert(&chain);
  if (certificate == nullptr) {
    return refuse(chain, X509_V_ERR_CERT_REJECTED, "the other side has no certificate");
  }
  if (peer_.role == TlsPeer::Role::host && !has_mark(*certificate, Mark::node)) {
    return judge_host(chain, *certificate);
  }
  return judge_node(chain, *certificate);
}

bool TlsLayer::judge_node(X509_STORE_CTX& chain, const X509& certificate) {
  const auto node = node_of(certificate);
  if (!node || !has_mark(certificate, Mark::node)) {
    return refuse(chain, X509_V_ERR_CERT_REJECTED, "the other side's certificate is of no node");
  }
  const auto pin = rules_.pins.find(*node);
  const bool is_right = pin != rules_.pins.end() ? judge_pinned(chain, certificate, pin->second)
                                                 : judge_chain(chain) && judge_marks(chain);
  if (!is_right) return false;
  if (!peer_.expected.is_any() && *node != peer_.expected) {
    return refuse(chain, X509_V_ERR_CERT_REJECTED,
                  "the other side's certificate is of node " + node->text() + ", not of " +
                      peer_.expected.text());
  }
  certified_node_ = *node;
  return true;
}

bool TlsLayer::judge_chain(X509_STORE_CTX& chain) {
  // Which of them may be critical is looked at in judge_marks().
  X509_STORE_CTX_set_flags(&chain, X509_V_FLAG_IGNORE_CRITICAL);
  X509_STORE_CTX_set_verify_cb(&chain, &pass_without_list);
  if (X509_verify_cert(&chain) == 1) return true;
  const int code = X509_STORE_CTX_get_error(&chain);
  return refuse(chain, code, reason_of(chain));
}

bool TlsLayer::judge_marks(X509_STORE_CTX& chain) {
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

bool TlsLayer::judge_pinned(X509_STORE_CTX& chain, const X509& certificate,
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

bool TlsLayer::judge_host(X509_STORE_CTX& chain, X509& certificate) {
  X509_STORE_CTX_set_verify_cb(&chain, &pass_without_list);
  if (X509_verify_cert(&chain) != 1) {
    const int code = X509_STORE_CTX_get_error(&chain);
    return refuse(chain, code, reason_of(chain));
  }
  if (X509_check_host(&certificate, peer_.host.c_str(), peer_.host.size(), 0, nullptr) == 1 ||
      X509_check_ip_asc(&certificate, peer_.host.c_str(), 0) == 1) {
    return true;
  }
  return refuse(chain, X509_V_ERR_HOSTNAME_MISMATCH,
                "the other side's certificate is not of the host `" + peer_.host + "`");
}

}  // namespace rr::channel
