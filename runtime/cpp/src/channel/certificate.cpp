// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/channel/certificate.hpp"

#include <openssl/err.h>
#include <openssl/pem.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <ctime>
#include <string_view>
#include <utility>

#include "rr/error.hpp"

namespace rr::channel {
namespace {

constexpr std::string_view subject_prefix = "Robot Raconteur Node ";
// More is no certificate of a node.
constexpr long largest_file = 1024 * 1024;

[[noreturn]] void refuse(const std::string& file, const std::string& why) {
  throw Error(ErrorCode::invalid_configuration, "`" + file + "`: " + why);
}

// Nobody is asked for a password.
int no_password(char* /*to*/, int /*size*/, int /*is_writing*/, void* /*context*/) { return -1; }

std::string identifier_of(const ASN1_OBJECT* object) {
  std::array<char, 128> text{};
  OBJ_obj2txt(text.data(), text.size(), object, 1);
  return text.data();
}

}  // namespace

FilePtr open_certificate_file(const std::string& name) {
  FilePtr file(BIO_new_file(name.c_str(), "rb"));
  if (!file) refuse(name, "it cannot be read");
  if (BIO_seek(file.get(), 0) == 0) {
    std::FILE* stream = nullptr;
    BIO_get_fp(file.get(), &stream);
    if (stream != nullptr && std::fseek(stream, 0, SEEK_END) == 0) {
      const bool is_too_large = std::ftell(stream) > largest_file;
      std::rewind(stream);  // NOLINT(bugprone-unsafe-functions): seeking has just worked
      if (is_too_large) refuse(name, "it is larger than 1 MiB");
    }
  }
  return file;
}

std::string library_error() {
  const unsigned long code = ERR_peek_last_error();
  const char* const reason = ERR_reason_error_string(code);
  ERR_clear_error();
  return reason == nullptr ? "unknown reason" : reason;
}

std::string mark_identifier(Mark mark) {
  return "1.3.6.1.4.1.45455.1.1.3." + std::to_string(static_cast<int>(mark));
}

bool has_mark(const X509& certificate, Mark mark) {
  const std::string wanted = mark_identifier(mark);
  const int count = X509_get_ext_count(&certificate);
  for (int i = 0; i < count; ++i) {
    X509_EXTENSION* const extension = X509_get_ext(&certificate, i);
    if (X509_EXTENSION_get_critical(extension) != 0 &&
        identifier_of(X509_EXTENSION_get_object(extension)) == wanted) {
      return true;
    }
  }
  return false;
}

bool has_only_known_criticals(const X509& certificate) {
  static constexpr std::array<std::string_view, 5> known = {"2.5.29.14", "2.5.29.15", "2.5.29.19",
                                                            "2.5.29.32", "2.5.29.35"};
  const int count = X509_get_ext_count(&certificate);
  for (int i = 0; i < count; ++i) {
    X509_EXTENSION* const extension = X509_get_ext(&certificate, i);
    if (X509_EXTENSION_get_critical(extension) == 0) continue;
    const std::string identifier = identifier_of(X509_EXTENSION_get_object(extension));
    const bool is_mark = identifier == mark_identifier(Mark::root) ||
                         identifier == mark_identifier(Mark::intermediate) ||
                         identifier == mark_identifier(Mark::node);
    if (!is_mark && std::find(known.begin(), known.end(), identifier) == known.end()) return false;
  }
  return true;
}

std::string subject_of(const NodeId& node) {
  return std::string(subject_prefix) + node.text_with_braces();
}

std::optional<NodeId> node_in(const X509_NAME& subject) {
  if (X509_NAME_entry_count(&subject) != 1) return std::nullopt;
  X509_NAME_ENTRY* const entry = X509_NAME_get_entry(&subject, 0);
  if (OBJ_obj2nid(X509_NAME_ENTRY_get_object(entry)) != NID_commonName) return std::nullopt;
  const ASN1_STRING* const name = X509_NAME_ENTRY_get_data(entry);
  const std::string_view text(reinterpret_cast<const char*>(ASN1_STRING_get0_data(name)),
                              static_cast<std::size_t>(ASN1_STRING_length(name)));
  if (!text.starts_with(subject_prefix)) return std::nullopt;
  const auto node = NodeId::parse(text.substr(subject_prefix.size()));
  // One way to write it only.
  if (!node || subject_of(*node) != text) return std::nullopt;
  return node;
}

std::optional<NodeId> node_of(const X509& certificate) {
  return node_in(*X509_get_subject_name(&certificate));
}

std::string hexadecimal(std::span<const unsigned char> bytes) {
  constexpr std::string_view digits = "0123456789abcdef";
  std::string text;
  for (const unsigned char each : bytes) {
    text += digits[each >> 4U];
    text += digits[each & 0x0FU];
  }
  return text;
}

std::string fingerprint_of(const X509& certificate) {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned size = 0;
  if (X509_digest(&certificate, EVP_sha256(), digest.data(), &size) == 0) return {};
  return hexadecimal(std::span(digest).first(size));
}

std::string text_of(const ASN1_TIME* time) {
  std::tm parts{};
  if (time == nullptr || ASN1_TIME_to_tm(time, &parts) != 1) return "an unknown time";
  std::array<char, 32> text{};
  const std::size_t size = std::strftime(text.data(), text.size(), "%Y-%m-%d %H:%M UTC", &parts);
  return {text.data(), size};
}

namespace {

Identity read_pkcs12(const std::string& name) {
  const FilePtr file = open_certificate_file(name);
  const std::unique_ptr<PKCS12, Releases<PKCS12_free>> bundle(d2i_PKCS12_bio(file.get(), nullptr));
  if (!bundle) refuse(name, "it is no PKCS #12 file");
  EVP_PKEY* key = nullptr;
  X509* certificate = nullptr;
  STACK_OF(X509)* others = nullptr;
  if (PKCS12_parse(bundle.get(), "", &key, &certificate, &others) != 1) {
    refuse(name, "it needs a password, or is damaged: " + library_error());
  }
  Identity identity{KeyPtr(key), CertificatePtr(certificate), {}};
  while (others != nullptr && sk_X509_num(others) > 0) {
    identity.chain.emplace_back(sk_X509_shift(others));
  }
  sk_X509_free(others);
  return identity;
}

}  // namespace

std::vector<CertificatePtr> read_certificates(const std::string& name) {
  const FilePtr file = open_certificate_file(name);
  std::vector<CertificatePtr> certificates;
  while (X509* const next = PEM_read_bio_X509(file.get(), nullptr, no_password, nullptr)) {
    certificates.emplace_back(next);
  }
  ERR_clear_error();
  if (certificates.empty()) refuse(name, "it has no certificate");
  return certificates;
}

std::vector<RevocationsPtr> read_revocations(const std::string& name) {
  const FilePtr file = open_certificate_file(name);
  std::vector<RevocationsPtr> lists;
  while (X509_CRL* const next = PEM_read_bio_X509_CRL(file.get(), nullptr, no_password, nullptr)) {
    lists.emplace_back(next);
  }
  ERR_clear_error();
  if (lists.empty()) refuse(name, "it has no list of revoked certificates");
  return lists;
}

Identity read_identity(const std::string& certificate_file, const std::string& key_file) {
  Identity identity;
  if (certificate_file.ends_with(".p12")) {
    identity = read_pkcs12(certificate_file);
  } else {
    std::vector<CertificatePtr> certificates = read_certificates(certificate_file);
    identity.certificate = std::move(certificates.front());
    certificates.erase(certificates.begin());
    identity.chain = std::move(certificates);
    const std::string& name = key_file.empty() ? certificate_file : key_file;
    const FilePtr file = open_certificate_file(name);
    identity.key.reset(PEM_read_bio_PrivateKey(file.get(), nullptr, no_password, nullptr));
    if (!identity.key) refuse(name, "it has no private key without a password");
  }
  if (!identity.key || !identity.certificate) {
    refuse(certificate_file, "it has not both a certificate and a key");
  }
  if (X509_check_private_key(identity.certificate.get(), identity.key.get()) != 1) {
    refuse(certificate_file, "the key is not the certificate's");
  }
  ERR_clear_error();
  return identity;
}

}  // namespace rr::channel
