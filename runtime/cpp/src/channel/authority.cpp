// SPDX-License-Identifier: Apache-2.0
#include "rr/authority.hpp"

#include <fcntl.h>
#include <openssl/ec.h>
#include <openssl/pem.h>
#include <openssl/rand.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <utility>

#include "rr/error.hpp"
#include "runtime/cpp/src/channel/certificate.hpp"

namespace rr {
namespace {

using namespace channel;  // NOLINT(google-build-using-namespace): the types of certificate.hpp

constexpr long second_a_day = 86400;
// Clocks differ.
constexpr long back_dated = 3600;
constexpr long list_validity = 3650 * second_a_day;

using TextPtr = std::unique_ptr<BIO, Releases<BIO_free>>;

void check(bool is_right) {
  if (!is_right) throw Error(ErrorCode::internal_error, "a certificate: " + library_error());
}

KeyPtr make_key() {
  KeyPtr key(EVP_EC_gen("P-256"));
  check(key != nullptr);
  return key;
}

void set_random_serial(X509& certificate) {
  std::array<unsigned char, 16> bytes{};
  check(RAND_bytes(bytes.data(), static_cast<int>(bytes.size())) == 1);
  bytes.front() &= 0x7fU;  // positive
  const std::unique_ptr<BIGNUM, Releases<BN_free>> number(
      BN_bin2bn(bytes.data(), static_cast<int>(bytes.size()), nullptr));
  check(BN_to_ASN1_INTEGER(number.get(), X509_get_serialNumber(&certificate)) != nullptr);
}

void set_subject(X509& certificate, const std::string& name) {
  check(X509_NAME_add_entry_by_NID(
            X509_get_subject_name(&certificate), NID_commonName, MBSTRING_UTF8,
            reinterpret_cast<const unsigned char*>(name.c_str()), -1, -1, 0) == 1);
}

void add_extension(X509& certificate, X509& issuer, int kind, const char* value) {
  X509V3_CTX context;
  X509V3_set_ctx_nodb(&context);
  X509V3_set_ctx(&context, &issuer, &certificate, nullptr, nullptr, 0);
  const std::unique_ptr<X509_EXTENSION, Releases<X509_EXTENSION_free>> extension(
      X509V3_EXT_conf_nid(nullptr, &context, kind, value));
  check(extension != nullptr && X509_add_ext(&certificate, extension.get(), -1) == 1);
}

// The critical extension that says what the certificate is for; its content is an empty value.
void add_mark(X509& certificate, Mark mark) {
  const std::unique_ptr<ASN1_OBJECT, Releases<ASN1_OBJECT_free>> identifier(
      OBJ_txt2obj(mark_identifier(mark).c_str(), 1));
  const std::unique_ptr<ASN1_OCTET_STRING, Releases<ASN1_OCTET_STRING_free>> content(
      ASN1_OCTET_STRING_new());
  constexpr std::array<unsigned char, 2> null = {5, 0};
  check(ASN1_OCTET_STRING_set(content.get(), null.data(), static_cast<int>(null.size())) == 1);
  const std::unique_ptr<X509_EXTENSION, Releases<X509_EXTENSION_free>> extension(
      X509_EXTENSION_create_by_OBJ(nullptr, identifier.get(), 1, content.get()));
  check(extension != nullptr && X509_add_ext(&certificate, extension.get(), -1) == 1);
}

CertificatePtr make_certificate(const std::string& subject, EVP_PKEY& key, Authority::Days days) {
  CertificatePtr certificate(X509_new());
  check(certificate != nullptr);
  X509_set_version(certificate.get(), X509_VERSION_3);
  set_random_serial(*certificate);
  const long validity = days.count() * second_a_day;
  X509_gmtime_adj(X509_getm_notBefore(certificate.get()),
                  validity < 0 ? 2 * validity : -back_dated);
  X509_gmtime_adj(X509_getm_notAfter(certificate.get()), validity);
  set_subject(*certificate, subject);
  check(X509_set_pubkey(certificate.get(), &key) == 1);
  return certificate;
}

// Writes what `print` prints, whole or not at all.
template <class Print>
void write_file(const std::string& path, mode_t mode, Print&& print) {
  const TextPtr text(BIO_new(BIO_s_mem()));
  check(text != nullptr && print(text.get()));
  char* bytes = nullptr;
  const long size = BIO_get_mem_data(text.get(), &bytes);
  const std::string part = path + ".new";
  unlink(part.c_str());
  const int file = open(part.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode);
  const bool is_written = file >= 0 && ::write(file, bytes, static_cast<std::size_t>(size)) == size;
  const bool is_closed = file >= 0 && ::close(file) == 0;
  if (!is_written || !is_closed || std::rename(part.c_str(), path.c_str()) != 0) {
    throw Error(ErrorCode::invalid_configuration, "`" + path + "` cannot be written");
  }
}

bool print_key(BIO* to, EVP_PKEY* key) {
  return PEM_write_bio_PKCS8PrivateKey(to, key, nullptr, nullptr, 0, nullptr, nullptr) == 1;
}

constexpr mode_t secret = 0600;
constexpr mode_t readable = 0644;

void write_revocations(const std::string& file, X509_CRL& list, const Identity& authority) {
  const std::unique_ptr<ASN1_TIME, Releases<ASN1_TIME_free>> now(
      X509_gmtime_adj(nullptr, -back_dated));
  const std::unique_ptr<ASN1_TIME, Releases<ASN1_TIME_free>> next(
      X509_gmtime_adj(nullptr, list_validity));
  X509_CRL_set_version(&list, X509_CRL_VERSION_2);
  X509_CRL_set_issuer_name(&list, X509_get_subject_name(authority.certificate.get()));
  X509_CRL_set1_lastUpdate(&list, now.get());
  X509_CRL_set1_nextUpdate(&list, next.get());
  X509_CRL_sort(&list);
  check(X509_CRL_sign(&list, authority.key.get(), EVP_sha256()) > 0);
  write_file(file, readable, [&](BIO* to) { return PEM_write_bio_X509_CRL(to, &list) == 1; });
}

Identity read_authority(const std::string& folder) {
  return read_identity(folder + "/ca.pem", folder + "/ca.key");
}

}  // namespace

Authority Authority::create(const std::string& folder, const std::string& name, Days validity) {
  std::error_code error;
  if (std::filesystem::exists(folder + "/ca.key", error)) {
    throw Error(ErrorCode::invalid_operation, "`" + folder + "` has an authority already");
  }
  std::filesystem::create_directories(folder + "/nodes", error);
  if (error) {
    throw Error(ErrorCode::invalid_configuration, "`" + folder + "`: " + error.message());
  }
  Identity made;
  made.key = make_key();
  made.certificate = make_certificate(name, *made.key, validity);
  X509& certificate = *made.certificate;
  X509_set_issuer_name(&certificate, X509_get_subject_name(&certificate));
  add_extension(certificate, certificate, NID_basic_constraints, "critical,CA:TRUE");
  add_extension(certificate, certificate, NID_key_usage, "critical,keyCertSign,cRLSign");
  add_extension(certificate, certificate, NID_subject_key_identifier, "hash");
  add_mark(certificate, Mark::root);
  check(X509_sign(&certificate, made.key.get(), EVP_sha256()) > 0);
  write_file(folder + "/ca.key", secret, [&](BIO* to) { return print_key(to, made.key.get()); });
  write_file(folder + "/ca.pem", readable,
             [&](BIO* to) { return PEM_write_bio_X509(to, &certificate) == 1; });
  const RevocationsPtr list(X509_CRL_new());
  write_revocations(folder + "/revoked.pem", *list, made);
  return Authority(folder);
}

Authority::Authority(std::string folder) : folder_(std::move(folder)) { read_authority(folder_); }

std::string Authority::issue(const NodeId& node, Days validity) {
  if (node.is_any()) throw Error(ErrorCode::invalid_argument, "a certificate needs a node id");
  const Identity authority = read_authority(folder_);
  const KeyPtr key = make_key();
  const CertificatePtr made = make_certificate(subject_of(node), *key, validity);
  X509_set_issuer_name(made.get(), X509_get_subject_name(authority.certificate.get()));
  add_extension(*made, *authority.certificate, NID_basic_constraints, "critical,CA:FALSE");
  add_extension(*made, *authority.certificate, NID_key_usage, "critical,digitalSignature");
  add_extension(*made, *authority.certificate, NID_subject_key_identifier, "hash");
  add_extension(*made, *authority.certificate, NID_authority_key_identifier, "keyid:always");
  add_mark(*made, Mark::node);
  check(X509_sign(made.get(), authority.key.get(), EVP_sha256()) > 0);
  const std::string stem = folder_ + "/nodes/" + node.text();
  write_file(stem + ".pem", secret, [&](BIO* to) {
    return PEM_write_bio_X509(to, made.get()) == 1 && print_key(to, key.get());
  });
  const std::string friendly = subject_of(node);
  STACK_OF(X509)* const above = sk_X509_new_null();
  sk_X509_push(above, authority.certificate.get());
  const std::unique_ptr<PKCS12, Releases<PKCS12_free>> bundle(
      PKCS12_create("", friendly.c_str(), key.get(), made.get(), above, 0, 0, 0, 0, 0));
  sk_X509_free(above);
  check(bundle != nullptr);
  write_file(stem + ".p12", secret, [&](BIO* to) { return i2d_PKCS12_bio(to, bundle.get()) == 1; });
  return stem + ".pem";
}

void Authority::revoke(const NodeId& node) {
  const Identity authority = read_authority(folder_);
  const std::string file = folder_ + "/nodes/" + node.text() + ".pem";
  const CertificatePtr certificate = std::move(read_certificates(file).front());
  std::vector<RevocationsPtr> lists = read_revocations(revocation_file());
  X509_CRL& list = *lists.front();
  X509_REVOKED* known = nullptr;
  if (X509_CRL_get0_by_serial(&list, &known, X509_get_serialNumber(certificate.get())) == 1) return;
  std::unique_ptr<X509_REVOKED, Releases<X509_REVOKED_free>> entry(X509_REVOKED_new());
  const std::unique_ptr<ASN1_TIME, Releases<ASN1_TIME_free>> now(X509_gmtime_adj(nullptr, 0));
  X509_REVOKED_set_serialNumber(entry.get(), X509_get_serialNumber(certificate.get()));
  X509_REVOKED_set_revocationDate(entry.get(), now.get());
  check(X509_CRL_add0_revoked(&list, entry.get()) == 1);
  static_cast<void>(entry.release());  // the list's now
  write_revocations(revocation_file(), list, authority);
}

}  // namespace rr
