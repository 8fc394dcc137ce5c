// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <exception>
#include <string>
#include <string_view>

#include "rr/audit.hpp"
#include "rr/error.hpp"
#include "rr/mutex.hpp"
#include "rr/users.hpp"
#include "runtime/cpp/src/channel/time.hpp"

namespace rr::service {

class ServerEndpoint;
struct Question;

/// Tells the node's audit what one client does. None of it may be called under a lock.
class AuditTrail {
 public:
  explicit AuditTrail(ServerEndpoint& endpoint);

  void connected();
  void disconnected();
  void logged_in(std::string_view user);
  void refused_login(std::string_view user, const std::exception_ptr& why);
  void logged_out(const User& user, std::string_view why);
  void locked(const Question& question);
  void unlocked(const Question& question);
  void entered(std::string_view path, std::string_view operation);
  /// An entry was refused for who has sent it.
  void refused(const Question& question, const Error& why);
  /// An entry was not.
  void admitted(const Question& question) {
    if (options_ != nullptr && options_->requests) tell_request(question);
  }
  /// So many things that the session had opened were ended.
  void ended(std::size_t count);

 private:
  [[nodiscard]] AuditEvent make(AuditKind kind) const;
  [[nodiscard]] AuditEvent make(AuditKind kind, const Question& question) const;
  void count_login(bool is_allowed) const;
  void tell_request(const Question& question);
  bool may_tell_refusal(std::size_t& left_out);
  void tell(const AuditEvent& event) const;

  ServerEndpoint& endpoint_;
  const AuditOptions* options_;  // null when nobody is told
  std::string address_;          // known while the connection lives
  Mutex mutex_;
  channel::Time window_ RR_GUARDED_BY(mutex_){};  // when the refusals began that are counted
  std::size_t refusals_ RR_GUARDED_BY(mutex_) = 0;
  std::size_t left_out_ RR_GUARDED_BY(mutex_) = 0;
};

}  // namespace rr::service
