// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/channel/tls_files.hpp"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "rr/error.hpp"
#include "runtime/cpp/src/channel/issuing.hpp"
#include "runtime/cpp/src/channel/tls_layer.hpp"
#include "runtime/cpp/src/platform/environment.hpp"
#include "runtime/cpp/src/platform/files.hpp"

namespace rr::channel {
namespace {

using WallClock = std::chrono::system_clock;

[[noreturn]] void refuse(const std::string& why) {
  throw Error(ErrorCode::invalid_configuration, why);
}

std::shared_ptr<SSL_CTX> make_context() {
  std::shared_ptr<SSL_CTX> context(SSL_CTX_new(TLS_method()), SSL_CTX_free);
  if (!context) refuse("TLS cannot be used: " + library_error());
  SSL_CTX_set_min_proto_version(context.get(), TLS1_2_VERSION);
  SSL_CTX_set_options(context.get(), SSL_OP_NO_COMPRESSION | SSL_OP_NO_RENEGOTIATION |
                                         SSL_OP_NO_TICKET | SSL_OP_CIPHER_SERVER_PREFERENCE);
  // Each connection is judged anew, by what is revoked by then.
  SSL_CTX_set_session_cache_mode(context.get(), SSL_SESS_CACHE_OFF);
  SSL_CTX_set_num_tickets(context.get(), 0);
  SSL_CTX_set_mode(context.get(), SSL_MODE_RELEASE_BUFFERS);
  SSL_CTX_set_cert_verify_callback(context.get(), &TlsLayer::verify, nullptr);
  return context;
}

std::vector<std::string> authority_files_of(const TlsOptions& options) {
  std::vector<std::string> files = options.authority_files;
  const std::string file = platform::environment("ROBOTRACONTEUR_SSL_CERT_FILE");
  if (!file.empty()) files.push_back(file);
  const std::string folder = platform::environment("ROBOTRACONTEUR_SSL_CERT_DIR");
  std::error_code error;
  std::vector<std::string> of_folder;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    if (entry.is_regular_file(error)) of_folder.push_back(entry.path().string());
  }
  std::sort(of_folder.begin(), of_folder.end());
  files.insert(files.end(), of_folder.begin(), of_folder.end());
  return files;
}

std::vector<std::string> certificate_files_of(const TlsOptions& options) {
  std::vector<std::string> files;
  if (!options.certificate_file.empty()) files.push_back(options.certificate_file);
  if (!files.empty() && !options.key_file.empty()) files.push_back(options.key_file);
  return files;
}

std::string day_of(WallClock::time_point time) {
  const std::unique_ptr<ASN1_TIME, Releases<ASN1_TIME_free>> made(
      ASN1_TIME_set(nullptr, WallClock::to_time_t(time)));
  return text_of(made.get());
}

}  // namespace

WatchedFiles::Mark WatchedFiles::mark_of(const std::string& name) {
  const platform::FileState found = platform::state_of(name);
  return {found.device, found.number, found.size, found.written, found.changed};
}

bool WatchedFiles::have_changed(const std::vector<std::string>& names, bool thoroughly) {
  // A file that is written twice within a step of its time looks the same after the second.
  constexpr std::chrono::nanoseconds longest_step = std::chrono::seconds(2);
  std::vector<Mark> marks;
  for (const std::string& name : names) marks.push_back(mark_of(name));
  const bool is_same = names == names_ && marks == marks_;
  if (is_same && (is_settled_ || !thoroughly)) return false;
  const auto settled_by =
      std::chrono::duration_cast<std::chrono::nanoseconds>(WallClock::now().time_since_epoch()) -
      longest_step;
  is_settled_ = std::all_of(marks.begin(), marks.end(),
                            [&](const Mark& mark) { return mark.changed < settled_by.count(); });
  names_ = names;
  marks_ = std::move(marks);
  return true;
}

TlsFiles::TlsFiles(const TlsOptions& options, const NodeId& own) : options_(options), own_(own) {
  // What is marked first is read again when it changes while it is read.
  certificate_files_.have_changed(certificate_files_of(options_), true);
  const std::vector<std::string> authorities = authority_files_of(options_);
  authority_files_.have_changed(authorities, true);
  revocation_files_.have_changed(options_.revocation_files, true);
  // To start the library takes milliseconds, which a node without files may never need.
  const bool has_files = !options_.certificate_file.empty() || !authorities.empty() ||
                         !options_.revocation_files.empty();
  if (!has_files) return;
  read_certificate();
  read_authorities(authorities);
  read_lists();
  make_trust();
}

void TlsFiles::look_again(bool thoroughly) {
  const MutexLock lock(mutex_);
  const std::vector<std::string> authorities = authority_files_of(options_);
  bool is_new = read_again(certificate_files_, certificate_files_of(options_), thoroughly,
                           [&]() RR_REQUIRES(mutex_) { read_certificate(); });
  is_new |= read_again(authority_files_, authorities, thoroughly,
                       [&]() RR_REQUIRES(mutex_) { read_authorities(authorities); });
  is_new |= read_again(revocation_files_, options_.revocation_files, thoroughly,
                       [&]() RR_REQUIRES(mutex_) { read_lists(); });
  if (is_new) make_trust();
  look_at_ends();
}

// True when something was read.
bool TlsFiles::read_again(WatchedFiles& files, const std::vector<std::string>& names,
                          bool thoroughly, const std::function<void()>& read) {
  const bool is_first_look = files.have_changed(names, false);
  if (!is_first_look && !(thoroughly && files.have_changed(names, true))) return false;
  try {
    read();
    return true;
  } catch (const Error& error) {
    // The second look at a file that is new says nothing new.
    if (is_first_look) {
      reports_.push_back(
          {LogLevel::error, error.message() + "; what was read before stays in use"});
    }
    return false;
  }
}

void TlsFiles::read_certificate() {
  std::shared_ptr<SSL_CTX> context = make_context();
  Lifetime life;
  if (!options_.certificate_file.empty()) {
    const Identity identity = read_identity(options_.certificate_file, options_.key_file);
    const auto node = node_of(*identity.certificate);
    if (!node) refuse("`" + options_.certificate_file + "`: the certificate is of no node");
    if (*node != own_) {
      refuse("`" + options_.certificate_file + "`: the certificate is of node " + node->text() +
             ", and this is " + own_.text());
    }
    if (SSL_CTX_use_certificate(context.get(), identity.certificate.get()) != 1 ||
        SSL_CTX_use_PrivateKey(context.get(), identity.key.get()) != 1) {
      refuse("`" + options_.certificate_file + "`: " + library_error());
    }
    for (const CertificatePtr& above : identity.chain) {
      SSL_CTX_add1_chain_cert(context.get(), above.get());
    }
    life.begin = time_of(X509_get0_notBefore(identity.certificate.get()));
    life.end = time_of(X509_get0_notAfter(identity.certificate.get()));
  }
  context_ = std::move(context);
  set_life(certificate_life_, life);
}

void TlsFiles::read_authorities(const std::vector<std::string>& names) {
  std::vector<CertificatePtr> read;
  for (const std::string& file : names) {
    for (CertificatePtr& each : read_certificates(file)) read.push_back(std::move(each));
  }
  authorities_ = std::move(read);
}

void TlsFiles::read_lists() {
  std::vector<RevocationsPtr> read;
  Lifetime life;
  for (const std::string& file : options_.revocation_files) {
    for (RevocationsPtr& list : read_revocations(file)) {
      const auto end = time_of(X509_CRL_get0_nextUpdate(list.get()));
      if (X509_CRL_get0_nextUpdate(list.get()) != nullptr && end < life.end) {
        life.begin = time_of(X509_CRL_get0_lastUpdate(list.get()));
        life.end = end;
      }
      read.push_back(std::move(list));
    }
  }
  lists_ = std::move(read);
  set_life(list_life_, life);
}

// What is read again and ends when it did before is not reported again.
void TlsFiles::set_life(Lifetime& known, const Lifetime& read) {
  if (known.begin != read.begin || known.end != read.end) known = read;
}

StorePtr TlsFiles::make_store() const {
  StorePtr made(X509_STORE_new());
  if (!made) throw Error(ErrorCode::out_of_system_resource, "there is no memory for TLS");
  for (const CertificatePtr& authority : authorities_) {
    X509_STORE_add_cert(made.get(), authority.get());
  }
  for (const RevocationsPtr& list : lists_) X509_STORE_add_crl(made.get(), list.get());
  if (!options_.revocation_files.empty()) {
    X509_STORE_set_flags(made.get(), X509_V_FLAG_CRL_CHECK | X509_V_FLAG_CRL_CHECK_ALL);
  }
  return made;
}

void TlsFiles::make_trust() {
  if (!context_) read_certificate();
  trust_ = std::make_shared<const Trust>(
      Trust{context_, {make_store().release(), X509_STORE_free}, ++generation_});
}

std::shared_ptr<const Trust> TlsFiles::trust() {
  const MutexLock lock(mutex_);
  if (!trust_) make_trust();
  return trust_;
}

bool TlsFiles::is_in_use() const {
  const MutexLock lock(mutex_);
  return trust_ != nullptr;
}

StorePtr TlsFiles::web_store() const {
  const MutexLock lock(mutex_);
  StorePtr web = make_store();
  if (options_.trust_system_authorities.value_or(authority_files_of(options_).empty())) {
    X509_STORE_set_default_paths(web.get());
  }
  return web;
}

void TlsFiles::look_at_ends() {
  look_at_end(certificate_life_, "this node's certificate",
              "others refuse this node then; `robdef ca issue --renew` makes another");
  look_at_end(list_life_, "the list of revoked certificates",
              options_.accepts_outdated_lists
                  ? "it is used all the same"
                  : "this node refuses certificates then; `robdef ca refresh` makes another");
}

// What runs out is reported when a quarter of its time is left, at most 30 days, and once more at
// the end.
void TlsFiles::look_at_end(Lifetime& lifetime, const std::string& what, const std::string& then) {
  constexpr auto longest_notice = std::chrono::hours(30 * 24);
  if (lifetime.end == Time::max()) return;
  const auto now = WallClock::now();
  const auto notice =
      std::min<WallClock::duration>((lifetime.end - lifetime.begin) / 4, longest_notice);
  if (now >= lifetime.end && !std::exchange(lifetime.is_end_reported, true)) {
    lifetime.is_end_announced = true;
    reports_.push_back(
        {LogLevel::error, what + " has run out, on " + day_of(lifetime.end) + ": " + then});
  } else if (now >= lifetime.end - notice && !std::exchange(lifetime.is_end_announced, true)) {
    reports_.push_back(
        {LogLevel::warning, what + " runs out on " + day_of(lifetime.end) + ": " + then});
  }
}

Reports TlsFiles::take_reports() {
  const MutexLock lock(mutex_);
  return std::exchange(reports_, {});
}

}  // namespace rr::channel
