// SPDX-License-Identifier: Apache-2.0
#include "rr/authority.hpp"

#include <openssl/pem.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <utility>

#include "rr/error.hpp"
#include "runtime/cpp/src/channel/authority_index.hpp"
#include "runtime/cpp/src/channel/certificate.hpp"
#include "runtime/cpp/src/channel/issuing.hpp"
#include "runtime/cpp/src/channel/private_files.hpp"

namespace rr {
namespace {

using namespace channel;  // NOLINT(google-build-using-namespace): the types of certificate.hpp

using WallClock = std::chrono::system_clock;

std::string certificate_text(X509& certificate) {
  return printed([&](BIO* to) { return PEM_write_bio_X509(to, &certificate) == 1; });
}

// Names stand in a line of the index.
void check_name(const std::string& name) {
  const bool is_line = std::none_of(name.begin(), name.end(), [](unsigned char letter) {
    return letter < 0x20 || letter == 0x7f;
  });
  if (!is_line || name.size() > 256) {
    throw Error(ErrorCode::invalid_argument,
                "a name has 256 bytes at most, and no control characters");
  }
}

IssuedCertificate described(const X509& certificate, const NodeId& node, const std::string& name) {
  return {serial_of(certificate), node, name, time_of(X509_get0_notBefore(&certificate)),
          time_of(X509_get0_notAfter(&certificate))};
}

// The same with a key, without a passphrase, for programs that read no PEM.
std::string bundle_text(X509& certificate, EVP_PKEY& key, X509& authority, const NodeId& node) {
  STACK_OF(X509)* const above = sk_X509_new_null();
  sk_X509_push(above, &authority);
  const std::unique_ptr<PKCS12, Releases<PKCS12_free>> bundle(
      PKCS12_create("", subject_of(node).c_str(), &key, &certificate, above, 0, 0, 0, 0, 0));
  sk_X509_free(above);
  check_made(bundle != nullptr);
  return printed([&](BIO* to) { return i2d_PKCS12_bio(to, bundle.get()) == 1; });
}

void wipe(std::string& secret) { OPENSSL_cleanse(secret.data(), secret.size()); }

}  // namespace

// What one call does in the folder, with everybody else kept out.
class Authority::Work {
 public:
  explicit Work(const Authority& authority)
      : folder_(authority.folder_), lock_(folder_), index_(read_or_collect()) {}

  // The one who signs, with the key. Throws.
  static Identity signer(const Authority& authority) {
    Identity identity;
    identity.certificate = std::move(read_certificates(authority.certificate_file()).front());
    identity.key = read_key(authority.folder_ + "/ca.key", authority.passphrase_);
    if (X509_check_private_key(identity.certificate.get(), identity.key.get()) != 1) {
      throw Error(ErrorCode::invalid_configuration,
                  "`" + authority.folder_ + "/ca.key`: the key is not that of ca.pem");
    }
    return identity;
  }

  [[nodiscard]] const std::vector<IssuedCertificate>& index() const { return index_; }

  // Before the certificate is in anybody's hands: none is valid that the index does not know.
  void add(IssuedCertificate issued) {
    index_.push_back(std::move(issued));
    write_index(index_file(), index_);
  }

  // How many of those that `is_meant` were valid until now.
  template <class Meant>
  std::size_t revoke(const Identity& signer, Meant&& is_meant) {
    std::size_t count = 0;
    const auto now = std::chrono::floor<std::chrono::seconds>(WallClock::now());
    for (IssuedCertificate& each : index_) {
      if (each.revoked || !is_meant(each)) continue;
      each.revoked = now;
      ++count;
    }
    // The index first: the list is made of it, so that the next one mends an interrupted run.
    if (count != 0) write_index(index_file(), index_);
    write_list(signer, std::nullopt);
    return count;
  }

  void write_list(const Identity& signer, std::optional<Days> validity) const {
    Revocations known;
    if (std::filesystem::exists(list_file())) {
      known = revocations_of(*read_revocations(list_file()).front());
    }
    if (validity) known.validity = *validity;
    for (const IssuedCertificate& each : index_) {
      const auto is_same = [&](const Revocations::Entry& entry) {
        return entry.serial == each.serial;
      };
      if (!each.revoked || std::any_of(known.entries.begin(), known.entries.end(), is_same)) {
        continue;
      }
      known.entries.push_back({each.serial, *each.revoked});
    }
    const RevocationsPtr list = make_list(known, signer);
    replace_file(list_file(),
                 printed([&](BIO* to) { return PEM_write_bio_X509_CRL(to, list.get()) == 1; }),
                 public_file);
  }

 private:
  [[nodiscard]] std::string index_file() const { return folder_ + "/index"; }
  [[nodiscard]] std::string list_file() const { return folder_ + "/revoked.pem"; }

  // Folders that an older version has made have no index: then what is there counts.
  [[nodiscard]] std::vector<IssuedCertificate> read_or_collect() const {
    if (std::filesystem::exists(index_file())) return read_index(index_file());
    std::vector<IssuedCertificate> found;
    std::error_code error;
    for (const auto& file : std::filesystem::directory_iterator(folder_ + "/nodes", error)) {
      if (file.path().extension() != ".pem") continue;
      const CertificatePtr certificate = std::move(read_certificates(file.path().string()).front());
      const auto node = channel::node_of(*certificate);
      if (node) found.push_back(described(*certificate, *node, {}));
    }
    if (std::filesystem::exists(list_file())) {
      for (const auto& entry : revocations_of(*read_revocations(list_file()).front()).entries) {
        for (IssuedCertificate& each : found) {
          if (each.serial == entry.serial) each.revoked = entry.when;
        }
      }
    }
    return found;
  }

  const std::string folder_;
  const FolderLock lock_;
  std::vector<IssuedCertificate> index_;
};

Authority Authority::create(const std::string& folder, const std::string& name, Days validity,
                            const std::string& passphrase) {
  check_name(name);
  make_private_folder(folder);
  std::error_code error;
  const auto refuse_second = [&] {
    throw Error(ErrorCode::invalid_operation, "`" + folder + "` has an authority already");
  };
  const FolderLock lock(folder);
  if (std::filesystem::exists(folder + "/ca.key", error)) refuse_second();
  make_private_folder(folder + "/nodes");
  Identity made;
  made.key = make_key();
  made.certificate = make_root(name, *made.key, validity);
  std::string key = key_text(*made.key, passphrase);
  replace_file(folder + "/ca.pem", certificate_text(*made.certificate), public_file);
  write_index(folder + "/index", {});
  const RevocationsPtr list = make_list({}, made);
  replace_file(folder + "/revoked.pem",
               printed([&](BIO* to) { return PEM_write_bio_X509_CRL(to, list.get()) == 1; }),
               public_file);
  // The last: with it the authority is there.
  create_file(folder + "/ca.key", key, secret_file);
  wipe(key);
  return Authority(folder, passphrase);
}

Authority::Authority(std::string folder, std::string passphrase)
    : folder_(std::move(folder)), passphrase_(std::move(passphrase)) {
  read_certificates(certificate_file());
}

Authority::~Authority() { wipe(passphrase_); }
Authority::Authority(const Authority&) = default;

bool Authority::has_passphrase(const std::string& folder) {
  std::ifstream file(folder + "/ca.key", std::ios::binary);
  std::string line;
  while (std::getline(file, line)) {
    if (line.find("ENCRYPTED") != std::string::npos) return true;
  }
  return false;
}

void Authority::set_passphrase(const std::string& passphrase) {
  const Identity signer = Work::signer(*this);
  const Work work(*this);
  std::string key = key_text(*signer.key, passphrase);
  replace_file(folder_ + "/ca.key", key, secret_file);
  wipe(key);
  wipe(passphrase_);
  passphrase_ = passphrase;
}

namespace {

void write_identity(const std::string& stem, X509& certificate, EVP_PKEY& key, X509& authority,
                    const NodeId& node) {
  std::string both = certificate_text(certificate) + key_text(key, {});
  replace_file(stem + ".pem", both, secret_file);
  wipe(both);
  std::string bundle = bundle_text(certificate, key, authority, node);
  replace_file(stem + ".p12", bundle, secret_file);
  wipe(bundle);
}

}  // namespace

std::string Authority::issue(const NodeId& node, Days validity, const std::string& name) {
  check_name(name);
  const Identity signer = Work::signer(*this);
  const KeyPtr key = make_key();
  const CertificatePtr made = make_node_certificate(node, *key, signer, validity);
  Work work(*this);
  work.add(described(*made, node, name));
  const std::string stem = folder_ + "/nodes/" + node.text();
  write_identity(stem, *made, *key, *signer.certificate, node);
  return stem + ".pem";
}

std::string Authority::renew(const NodeId& node, RenewedKey key, Days validity,
                             const std::string& name) {
  check_name(name);
  const std::string stem = folder_ + "/nodes/" + node.text();
  const Identity before = read_identity(stem + ".pem", "");
  if (key == RenewedKey::another) return issue(node, validity, name);
  const Identity signer = Work::signer(*this);
  const CertificatePtr made = make_node_certificate(node, *before.key, signer, validity);
  Work work(*this);
  work.add(described(*made, node, name));
  write_identity(stem, *made, *before.key, *signer.certificate, node);
  return stem + ".pem";
}

std::string Authority::sign(const std::string& request_file, Days validity,
                            const std::string& name) {
  check_name(name);
  const RequestPtr request = read_request(request_file);
  const NodeId node = channel::node_of(*request);
  const Identity signer = Work::signer(*this);
  const CertificatePtr made =
      make_node_certificate(node, *X509_REQ_get0_pubkey(request.get()), signer, validity);
  Work work(*this);
  work.add(described(*made, node, name));
  const std::string file = folder_ + "/nodes/" + node.text() + ".cert.pem";
  replace_file(file, certificate_text(*made), public_file);
  return file;
}

std::vector<IssuedCertificate> Authority::issued() const { return Work(*this).index(); }

std::size_t Authority::revoke(const NodeId& node) {
  const Identity signer = Work::signer(*this);
  Work work(*this);
  const auto is_meant = [&](const IssuedCertificate& each) { return each.node == node; };
  if (std::none_of(work.index().begin(), work.index().end(), is_meant)) {
    throw Error(ErrorCode::invalid_argument,
                "`" + folder_ + "` has issued no certificate for node " + node.text());
  }
  return work.revoke(signer, is_meant);
}

std::size_t Authority::revoke_earlier(const NodeId& node) {
  const Identity signer = Work::signer(*this);
  Work work(*this);
  std::string newest;
  for (const IssuedCertificate& each : work.index()) {
    if (each.node == node) newest = each.serial;
  }
  return work.revoke(signer, [&](const IssuedCertificate& each) {
    return each.node == node && each.serial != newest;
  });
}

std::size_t Authority::revoke_serial(const std::string& serial) {
  const std::string wanted = serial_in(serial);
  const Identity signer = Work::signer(*this);
  Work work(*this);
  const auto is_meant = [&](const IssuedCertificate& each) { return each.serial == wanted; };
  if (wanted.empty() || std::none_of(work.index().begin(), work.index().end(), is_meant)) {
    throw Error(ErrorCode::invalid_argument,
                "`" + folder_ + "` has issued no certificate with the serial `" + serial + "`");
  }
  return work.revoke(signer, is_meant);
}

std::size_t Authority::revoke_file(const std::string& file) {
  const CertificatePtr certificate = std::move(read_certificates(file).front());
  const Identity signer = Work::signer(*this);
  const auto node = channel::node_of(*certificate);
  if (!node || X509_verify(certificate.get(), signer.key.get()) != 1) {
    throw Error(ErrorCode::invalid_argument,
                "`" + file + "`: the certificate is not one of this authority for a node");
  }
  Work work(*this);
  const std::string serial = serial_of(*certificate);
  const auto is_meant = [&](const IssuedCertificate& each) { return each.serial == serial; };
  // An index may have got lost; what was signed with the key can be revoked all the same.
  if (std::none_of(work.index().begin(), work.index().end(), is_meant)) {
    work.add(described(*certificate, *node, {}));
  }
  return work.revoke(signer, is_meant);
}

void Authority::refresh(std::optional<Days> validity) {
  const Identity signer = Work::signer(*this);
  Work(*this).write_list(signer, validity);
}

IssuedCertificate::Time Authority::list_runs_out() const {
  return revocations_of(*read_revocations(revocation_file()).front()).runs_out;
}

CertificateRequest request_certificate(const std::string& folder, const NodeId& node,
                                       bool keeps_key) {
  if (!std::filesystem::exists(folder)) make_private_folder(folder);
  const std::string stem = folder + "/" + node.text();
  CertificateRequest made{stem + ".key", stem + ".csr", {}};
  KeyPtr key;
  if (keeps_key) {
    key = read_key(made.key_file, {});
  } else {
    key = make_key();
  }
  made.fingerprint = key_fingerprint(*key);
  const RequestPtr request = make_request(node, *key);
  if (!keeps_key) {
    std::string text = key_text(*key, {});
    create_file(made.key_file, text, secret_file);
    wipe(text);
  }
  replace_file(made.request_file,
               printed([&](BIO* to) { return PEM_write_bio_X509_REQ(to, request.get()) == 1; }),
               public_file);
  return made;
}

std::pair<NodeId, std::string> read_certificate_request(const std::string& request_file) {
  const RequestPtr request = read_request(request_file);
  return {channel::node_of(*request), key_fingerprint(*X509_REQ_get0_pubkey(request.get()))};
}

}  // namespace rr
