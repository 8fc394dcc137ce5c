// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/channel/issuing.hpp"

#include <openssl/ec.h>
#include <openssl/err.h>
#include <openssl/pem.h>
#include <openssl/rand.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

#include "rr/error.hpp"
#include "runtime/cpp/src/channel/authority_index.hpp"
#include "runtime/cpp/src/platform/clock.hpp"

namespace rr::channel {
namespace {

using WallClock = std::chrono::system_clock;

constexpr long second_a_day = 86400;
// Clocks differ.
constexpr long back_dated = 3600;
constexpr int least_strength = 112;  // of a key, in bits
constexpr int longest_rsa_key = 8192;

using TextPtr = std::unique_ptr<BIO, Releases<BIO_free>>;
using NumberPtr = std::unique_ptr<BIGNUM, Releases<BN_free>>;
using TimePtr = std::unique_ptr<ASN1_TIME, Releases<ASN1_TIME_free>>;
using IntegerPtr = std::unique_ptr<ASN1_INTEGER, Releases<ASN1_INTEGER_free>>;

void set_random_serial(X509& certificate) {
  std::array<unsigned char, 16> bytes{};
  check_made(RAND_bytes(bytes.data(), static_cast<int>(bytes.size())) == 1);
  bytes.front() &= 0x7fU;  // positive
  const NumberPtr number(BN_bin2bn(bytes.data(), static_cast<int>(bytes.size()), nullptr));
  check_made(BN_to_ASN1_INTEGER(number.get(), X509_get_serialNumber(&certificate)) != nullptr);
}

void set_name(X509_NAME& subject, const std::string& name) {
  check_made(X509_NAME_add_entry_by_NID(&subject, NID_commonName, MBSTRING_UTF8,
                                        reinterpret_cast<const unsigned char*>(name.c_str()), -1,
                                        -1, 0) == 1);
}

void add_extension(X509& certificate, X509& issuer, int kind, const char* value) {
  X509V3_CTX context;
  X509V3_set_ctx_nodb(&context);
  X509V3_set_ctx(&context, &issuer, &certificate, nullptr, nullptr, 0);
  const std::unique_ptr<X509_EXTENSION, Releases<X509_EXTENSION_free>> extension(
      X509V3_EXT_conf_nid(nullptr, &context, kind, value));
  check_made(extension != nullptr && X509_add_ext(&certificate, extension.get(), -1) == 1);
}

// The critical extension that says what the certificate is for; its content is an empty value.
void add_mark(X509& certificate, Mark mark) {
  const std::unique_ptr<ASN1_OBJECT, Releases<ASN1_OBJECT_free>> identifier(
      OBJ_txt2obj(mark_identifier(mark).c_str(), 1));
  const std::unique_ptr<ASN1_OCTET_STRING, Releases<ASN1_OCTET_STRING_free>> content(
      ASN1_OCTET_STRING_new());
  constexpr std::array<unsigned char, 2> null = {5, 0};
  check_made(ASN1_OCTET_STRING_set(content.get(), null.data(), static_cast<int>(null.size())) == 1);
  const std::unique_ptr<X509_EXTENSION, Releases<X509_EXTENSION_free>> extension(
      X509_EXTENSION_create_by_OBJ(nullptr, identifier.get(), 1, content.get()));
  check_made(extension != nullptr && X509_add_ext(&certificate, extension.get(), -1) == 1);
}

CertificatePtr make_certificate(const std::string& subject, EVP_PKEY& key,
                                Authority::Days validity) {
  CertificatePtr certificate(X509_new());
  check_made(certificate != nullptr);
  X509_set_version(certificate.get(), X509_VERSION_3);
  set_random_serial(*certificate);
  const long seconds = validity.count() * second_a_day;
  X509_gmtime_adj(X509_getm_notBefore(certificate.get()), seconds < 0 ? 2 * seconds : -back_dated);
  X509_gmtime_adj(X509_getm_notAfter(certificate.get()), seconds);
  set_name(*X509_get_subject_name(certificate.get()), subject);
  check_made(X509_set_pubkey(certificate.get(), &key) == 1);
  return certificate;
}

[[noreturn]] void refuse(const std::string& file, const std::string& why) {
  ERR_clear_error();
  throw Error(ErrorCode::invalid_configuration, "`" + file + "`: " + why);
}

bool is_strong(EVP_PKEY& key) {
  const int kind = EVP_PKEY_get_base_id(&key);
  const bool is_known =
      kind == EVP_PKEY_EC || (kind == EVP_PKEY_RSA && EVP_PKEY_get_bits(&key) <= longest_rsa_key);
  return is_known && EVP_PKEY_get_security_bits(&key) >= least_strength;
}

std::string hexadecimal(const ASN1_INTEGER* integer) {
  const NumberPtr number(ASN1_INTEGER_to_BN(integer, nullptr));
  check_made(number != nullptr);
  char* const digits = BN_bn2hex(number.get());
  check_made(digits != nullptr);
  std::string text = serial_in(digits);
  OPENSSL_free(digits);
  return text;
}

void add_revoked(X509_CRL& list, const Revocations::Entry& entry) {
  BIGNUM* read = nullptr;
  check_made(BN_hex2bn(&read, entry.serial.c_str()) > 0);
  const NumberPtr number(read);
  const IntegerPtr serial(BN_to_ASN1_INTEGER(number.get(), nullptr));
  const TimePtr when(ASN1_TIME_set(nullptr, WallClock::to_time_t(entry.when)));
  std::unique_ptr<X509_REVOKED, Releases<X509_REVOKED_free>> revoked(X509_REVOKED_new());
  check_made(serial && when && revoked);
  X509_REVOKED_set_serialNumber(revoked.get(), serial.get());
  X509_REVOKED_set_revocationDate(revoked.get(), when.get());
  check_made(X509_CRL_add0_revoked(&list, revoked.get()) == 1);
  static_cast<void>(revoked.release());  // the list's now
}

int give_passphrase(char* to, int size, int /*is_writing*/, void* passphrase) {
  const auto& text = *static_cast<const std::string*>(passphrase);
  if (text.empty() || text.size() > static_cast<std::size_t>(size)) return -1;
  std::memcpy(to, text.data(), text.size());
  return static_cast<int>(text.size());
}

}  // namespace

void check_made(bool is_right) {
  if (!is_right) throw Error(ErrorCode::internal_error, "a certificate: " + library_error());
}

KeyPtr make_key() {
  KeyPtr key(EVP_EC_gen("P-256"));
  check_made(key != nullptr);
  return key;
}

CertificatePtr make_root(const std::string& name, EVP_PKEY& key, Authority::Days validity) {
  CertificatePtr made = make_certificate(name, key, validity);
  X509& certificate = *made;
  X509_set_issuer_name(&certificate, X509_get_subject_name(&certificate));
  add_extension(certificate, certificate, NID_basic_constraints, "critical,CA:TRUE");
  add_extension(certificate, certificate, NID_key_usage, "critical,keyCertSign,cRLSign");
  add_extension(certificate, certificate, NID_subject_key_identifier, "hash");
  add_mark(certificate, Mark::root);
  check_made(X509_sign(&certificate, &key, EVP_sha256()) > 0);
  return made;
}

CertificatePtr make_node_certificate(const NodeId& node, EVP_PKEY& key, const Identity& authority,
                                     Authority::Days validity) {
  if (node.is_any()) throw Error(ErrorCode::invalid_argument, "a certificate needs a node id");
  CertificatePtr made = make_certificate(subject_of(node), key, validity);
  X509& issuer = *authority.certificate;
  if (ASN1_TIME_compare(X509_get0_notAfter(made.get()), X509_get0_notAfter(&issuer)) > 0) {
    check_made(X509_set1_notAfter(made.get(), X509_get0_notAfter(&issuer)) == 1);
  }
  X509_set_issuer_name(made.get(), X509_get_subject_name(&issuer));
  add_extension(*made, issuer, NID_basic_constraints, "critical,CA:FALSE");
  add_extension(*made, issuer, NID_key_usage, "critical,digitalSignature");
  add_extension(*made, issuer, NID_subject_key_identifier, "hash");
  add_extension(*made, issuer, NID_authority_key_identifier, "keyid:always");
  add_mark(*made, Mark::node);
  check_made(X509_sign(made.get(), authority.key.get(), EVP_sha256()) > 0);
  return made;
}

RequestPtr make_request(const NodeId& node, EVP_PKEY& key) {
  if (node.is_any()) throw Error(ErrorCode::invalid_argument, "a request needs a node id");
  RequestPtr request(X509_REQ_new());
  check_made(request != nullptr);
  X509_REQ_set_version(request.get(), X509_REQ_VERSION_1);
  set_name(*X509_REQ_get_subject_name(request.get()), subject_of(node));
  check_made(X509_REQ_set_pubkey(request.get(), &key) == 1 &&
             X509_REQ_sign(request.get(), &key, EVP_sha256()) > 0);
  return request;
}

RequestPtr read_request(const std::string& file) {
  const FilePtr from = open_certificate_file(file);
  RequestPtr request(PEM_read_bio_X509_REQ(from.get(), nullptr, nullptr, nullptr));
  if (!request) refuse(file, "it has no request for a certificate");
  EVP_PKEY* const key = X509_REQ_get0_pubkey(request.get());
  if (key == nullptr || !is_strong(*key)) {
    refuse(file, "its key must be of elliptic curves, or RSA from 2048 to 8192 bits");
  }
  if (X509_REQ_verify(request.get(), key) != 1) {
    refuse(file, "it is not signed with the key that it is for");
  }
  if (!node_in(*X509_REQ_get_subject_name(request.get()))) {
    refuse(file, "its subject is not that of a node");
  }
  return request;
}

NodeId node_of(const X509_REQ& request) {
  return node_in(*X509_REQ_get_subject_name(&request)).value_or(NodeId());
}

std::string key_fingerprint(EVP_PKEY& key) {
  unsigned char* bytes = nullptr;
  const int size = i2d_PUBKEY(&key, &bytes);
  check_made(size > 0);
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned digest_size = 0;
  const int is_done = EVP_Digest(bytes, static_cast<std::size_t>(size), digest.data(), &digest_size,
                                 EVP_sha256(), nullptr);
  OPENSSL_free(bytes);
  check_made(is_done == 1);
  return hexadecimal(std::span(digest).first(digest_size));
}

Revocations revocations_of(const X509_CRL& list) {
  Revocations found;
  auto& known = const_cast<X509_CRL&>(list);  // the library asks for it, and changes nothing
  const STACK_OF(X509_REVOKED)* const entries = X509_CRL_get_REVOKED(&known);
  const int count = entries == nullptr ? 0 : sk_X509_REVOKED_num(entries);
  for (int i = 0; i < count; ++i) {
    const X509_REVOKED* const entry = sk_X509_REVOKED_value(entries, i);
    found.entries.push_back({hexadecimal(X509_REVOKED_get0_serialNumber(entry)),
                             time_of(X509_REVOKED_get0_revocationDate(entry))});
  }
  const auto begin = time_of(X509_CRL_get0_lastUpdate(&list));
  found.runs_out = time_of(X509_CRL_get0_nextUpdate(&list));
  const auto validity = found.runs_out - begin - std::chrono::seconds(back_dated);
  found.validity = std::max(std::chrono::round<Authority::Days>(validity), Authority::Days(1));
  const std::unique_ptr<ASN1_INTEGER, Releases<ASN1_INTEGER_free>> number(
      static_cast<ASN1_INTEGER*>(X509_CRL_get_ext_d2i(&list, NID_crl_number, nullptr, nullptr)));
  if (number) found.number = ASN1_INTEGER_get(number.get());
  return found;
}

RevocationsPtr make_list(const Revocations& revocations, const Identity& authority) {
  RevocationsPtr list(X509_CRL_new());
  check_made(list != nullptr);
  const TimePtr now(X509_gmtime_adj(nullptr, -back_dated));
  const TimePtr next(X509_gmtime_adj(nullptr, revocations.validity.count() * second_a_day));
  X509_CRL_set_version(list.get(), X509_CRL_VERSION_2);
  X509_CRL_set_issuer_name(list.get(), X509_get_subject_name(authority.certificate.get()));
  X509_CRL_set1_lastUpdate(list.get(), now.get());
  X509_CRL_set1_nextUpdate(list.get(), next.get());
  for (const Revocations::Entry& entry : revocations.entries) add_revoked(*list, entry);
  const IntegerPtr number(ASN1_INTEGER_new());
  check_made(number && ASN1_INTEGER_set(number.get(), revocations.number + 1) == 1 &&
             X509_CRL_add1_ext_i2d(list.get(), NID_crl_number, number.get(), 0, 0) == 1);
  X509_CRL_sort(list.get());
  check_made(X509_CRL_sign(list.get(), authority.key.get(), EVP_sha256()) > 0);
  return list;
}

std::string serial_of(const X509& certificate) {
  return hexadecimal(X509_get0_serialNumber(&certificate));
}

WallClock::time_point time_of(const ASN1_TIME* time) {
  std::tm parts{};
  if (time == nullptr || ASN1_TIME_to_tm(time, &parts) != 1) return {};
  return platform::time_of_utc(parts);
}

std::string printed(const std::function<bool(BIO*)>& print) {
  const TextPtr text(BIO_new(BIO_s_secmem()));
  check_made(text != nullptr && print(text.get()));
  char* bytes = nullptr;
  const long size = BIO_get_mem_data(text.get(), &bytes);
  return {bytes, static_cast<std::size_t>(size)};
}

std::string key_text(EVP_PKEY& key, const std::string& passphrase) {
  if (passphrase.empty()) {
    return printed([&](BIO* to) {
      return PEM_write_bio_PKCS8PrivateKey(to, &key, nullptr, nullptr, 0, nullptr, nullptr) == 1;
    });
  }
  // scrypt with 16 MiB, five times: the most that the library reads again without being asked.
  constexpr std::uint64_t cost = 1U << 14U;
  constexpr std::uint64_t block = 8;
  constexpr std::uint64_t repeats = 5;
  const std::unique_ptr<PKCS8_PRIV_KEY_INFO, Releases<PKCS8_PRIV_KEY_INFO_free>> plain(
      EVP_PKEY2PKCS8(&key));
  X509_ALGOR* const how =
      PKCS5_pbe2_set_scrypt(EVP_aes_256_cbc(), nullptr, 0, nullptr, cost, block, repeats);
  check_made(plain && how != nullptr);
  const std::unique_ptr<X509_SIG, Releases<X509_SIG_free>> encrypted(
      PKCS8_set0_pbe(passphrase.data(), static_cast<int>(passphrase.size()), plain.get(), how));
  if (!encrypted) X509_ALGOR_free(how);
  check_made(encrypted != nullptr);
  return printed([&](BIO* to) { return PEM_write_bio_PKCS8(to, encrypted.get()) == 1; });
}

KeyPtr read_key(const std::string& file, const std::string& passphrase) {
  const FilePtr from = open_certificate_file(file);
  bool has_asked = false;
  struct Asked {
    const std::string& text;
    bool& has_asked;
  } asked{passphrase, has_asked};
  KeyPtr key(PEM_read_bio_PrivateKey(
      from.get(), nullptr,
      [](char* to, int size, int is_writing, void* context) {
        auto& given = *static_cast<Asked*>(context);
        given.has_asked = true;
        return give_passphrase(to, size, is_writing, const_cast<std::string*>(&given.text));
      },
      &asked));
  ERR_clear_error();
  if (key) return key;
  if (has_asked) {
    throw Error(ErrorCode::authentication_error,
                "`" + file + "`: " +
                    (passphrase.empty() ? "the key needs its passphrase" : "wrong passphrase"));
  }
  refuse(file, "it has no private key");
}

}  // namespace rr::channel
