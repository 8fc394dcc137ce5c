// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "gateway/nats_message.hpp"
#include "rr/mutex.hpp"

namespace rr::gateway {

/// What the threads of the library hear, for one thread that takes it in order.
class NatsMailbox {
 public:
  /// All that has come since.
  struct Mail {
    std::vector<NatsMessage> messages;
    std::vector<std::string> refusals;  ///< what the broker does not permit, as it says it
    std::optional<std::string> closed;  ///< why the connection has ended
  };

  /// A message of a subscription. While too many wait it is dropped, unless it is for an inbox.
  void add(NatsMessage message) {
    const bool is_inbox = message.heard_at.starts_with("_INBOX.");
    const MutexLock lock(mutex_);
    const bool is_full = mail_.messages.size() >= most_messages || bytes_ >= most_bytes;
    if (is_full && !is_inbox) return;
    bytes_ += size_of(message);
    mail_.messages.push_back(std::move(message));
    wake_locked();
  }
  /// The broker does not permit something.
  void refuse(std::string text) {
    const MutexLock lock(mutex_);
    if (mail_.refusals.size() < most_messages) mail_.refusals.push_back(std::move(text));
    wake_locked();
  }
  /// The connection has ended.
  void close(std::string reason) {
    const MutexLock lock(mutex_);
    mail_.closed = std::move(reason);
    wake_locked();
  }
  /// Ends wait() without mail.
  void wake() {
    const MutexLock lock(mutex_);
    wake_locked();
  }
  /// Waits for mail or wake(), until `end` at most, and takes what has come.
  Mail wait(std::chrono::steady_clock::time_point end) {
    const MutexLock lock(mutex_);
    changed_.wait_until(mutex_, end, [this]() RR_REQUIRES(mutex_) { return is_awake_; });
    is_awake_ = false;
    bytes_ = 0;
    return std::exchange(mail_, Mail());
  }

 private:
  static constexpr std::size_t most_messages = 100'000;
  static constexpr std::size_t most_bytes = std::size_t{64} * 1024 * 1024;

  void wake_locked() RR_REQUIRES(mutex_) {
    is_awake_ = true;
    changed_.notify_all();
  }

  Mutex mutex_;
  Condition changed_;
  Mail mail_ RR_GUARDED_BY(mutex_);
  std::size_t bytes_ RR_GUARDED_BY(mutex_) = 0;
  bool is_awake_ RR_GUARDED_BY(mutex_) = false;
};

}  // namespace rr::gateway
