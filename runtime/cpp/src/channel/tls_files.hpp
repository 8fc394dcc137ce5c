// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "rr/mutex.hpp"
#include "rr/node_id.hpp"
#include "rr/options.hpp"
#include "runtime/cpp/src/channel/certificate.hpp"
#include "runtime/cpp/src/channel/peer_judge.hpp"

namespace rr::channel {

/// Something to be logged.
struct Report {
  LogLevel level;
  std::string text;
};
using Reports = std::vector<Report>;

/// Files that belong together, and whether they are others than those that were read.
class WatchedFiles {
 public:
  /// True when they have changed since the last time, or are so new that a change might not show;
  /// the latter only when asked with `thoroughly`.
  bool have_changed(const std::vector<std::string>& names, bool thoroughly);

 private:
  struct Mark {
    std::uint64_t device = 0;
    std::uint64_t number = 0;
    std::int64_t size = -1;  // -1: it cannot be looked at
    std::int64_t written = 0;
    std::int64_t changed = 0;
    bool operator==(const Mark&) const = default;
  };
  static Mark mark_of(const std::string& name);

  std::vector<std::string> names_;
  std::vector<Mark> marks_;
  bool is_settled_ = false;
};

/// What a node has and trusts by its files; does not change.
struct Trust {
  std::shared_ptr<SSL_CTX> context;   ///< with the node's certificate
  std::shared_ptr<X509_STORE> nodes;  ///< authorities of nodes, and what they have revoked
  std::uint64_t generation = 0;       ///< another one when `nodes` is
};

/// The files of TlsOptions. Any thread may use it.
class TlsFiles {
 public:
  /// Reads them. Throws rr::Error (invalid_configuration) when one cannot be used, or when the
  /// certificate is of another node than `own`.
  TlsFiles(const TlsOptions& options, const NodeId& own);

  /// Reads again what has changed. A file that cannot be used leaves in use what was read before,
  /// which is reported once.
  void look_again(bool thoroughly);
  [[nodiscard]] std::shared_ptr<const Trust> trust();
  /// False while there are no files and trust() was not asked for: the library has not been
  /// started.
  [[nodiscard]] bool is_in_use() const;
  /// The authorities of the web besides those of nodes.
  [[nodiscard]] StorePtr web_store() const;
  /// What is to be logged, which is forgotten.
  Reports take_reports();

 private:
  using Time = std::chrono::system_clock::time_point;
  // Something that runs out, and what was said of that.
  struct Lifetime {
    Time begin{};
    Time end = Time::max();
    bool is_end_announced = false;
    bool is_end_reported = false;
  };

  bool read_again(WatchedFiles& files, const std::vector<std::string>& names, bool thoroughly,
                  const std::function<void()>& read) RR_REQUIRES(mutex_);
  void read_certificate() RR_REQUIRES(mutex_);
  void read_authorities(const std::vector<std::string>& names) RR_REQUIRES(mutex_);
  void read_lists() RR_REQUIRES(mutex_);
  void make_trust() RR_REQUIRES(mutex_);
  [[nodiscard]] StorePtr make_store() const RR_REQUIRES(mutex_);
  static void set_life(Lifetime& known, const Lifetime& read);
  void look_at_ends() RR_REQUIRES(mutex_);
  void look_at_end(Lifetime& lifetime, const std::string& what, const std::string& then)
      RR_REQUIRES(mutex_);

  const TlsOptions options_;
  const NodeId own_;

  mutable Mutex mutex_;
  WatchedFiles certificate_files_ RR_GUARDED_BY(mutex_);
  WatchedFiles authority_files_ RR_GUARDED_BY(mutex_);
  WatchedFiles revocation_files_ RR_GUARDED_BY(mutex_);
  std::shared_ptr<SSL_CTX> context_ RR_GUARDED_BY(mutex_);  // null until it is used, without files
  std::vector<CertificatePtr> authorities_ RR_GUARDED_BY(mutex_);
  std::vector<RevocationsPtr> lists_ RR_GUARDED_BY(mutex_);
  Lifetime certificate_life_ RR_GUARDED_BY(mutex_);
  Lifetime list_life_ RR_GUARDED_BY(mutex_);
  std::uint64_t generation_ RR_GUARDED_BY(mutex_) = 0;
  std::shared_ptr<const Trust> trust_ RR_GUARDED_BY(mutex_);
  Reports reports_ RR_GUARDED_BY(mutex_);
};

}  // namespace rr::channel
