// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>

#include "rr/definition.hpp"
#include "rr/mutex.hpp"
#include "rr/reader.hpp"
#include "runtime/cpp/src/channel/account.hpp"
#include "runtime/cpp/src/channel/time.hpp"

namespace rr::service {

class ResponseBatch;
struct AccessRow;
class ServerEndpoint;

/// How a question was admitted (SessionAccess), for what outlives it.
struct Admission {
  const AccessRow* row = nullptr;
  std::uint32_t standing = 0;
  std::uint32_t login = 0;
};

/// What a late answer must remember of its question.
struct LateAnswer {
  EntryType request_type;
  std::string path;
  std::string member_name;
  std::uint32_t request_id;
  const Member* member;
  std::shared_ptr<ResponseBatch> batch;
  std::size_t place;
  Admission admission{};
  channel::Time begun{};  ///< when the question was taken up
};

/// The answers that a session owes. A program may keep what it answers with for longer than the
/// session lasts: that is a number, and all that takes memory is here and ends with the session.
/// Any thread.
class OwedAnswers {
 public:
  explicit OwedAnswers(std::shared_ptr<channel::Account> account) : charge_(std::move(account)) {}

  /// Returns its number. Throws rr::Error (out_of_system_resource) when more than `limit` are owed,
  /// or when they take too much memory.
  std::uint64_t add(const std::shared_ptr<ServerEndpoint>& endpoint, LateAnswer answer,
                    std::size_t limit);

  struct Taken {
    std::shared_ptr<ServerEndpoint> endpoint;
    LateAnswer answer;
  };
  /// It is owed no longer. Nothing when the session has ended.
  std::optional<Taken> take(std::uint64_t number);
  /// Nobody waits for any of them.
  void end();

 private:
  Mutex mutex_;
  std::weak_ptr<ServerEndpoint> endpoint_ RR_GUARDED_BY(mutex_);
  std::unordered_map<std::uint64_t, LateAnswer> answers_ RR_GUARDED_BY(mutex_);
  channel::Charge charge_ RR_GUARDED_BY(mutex_);  // for them
  std::uint64_t next_ RR_GUARDED_BY(mutex_) = 0;
  bool has_ended_ RR_GUARDED_BY(mutex_) = false;
};

}  // namespace rr::service
