// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/service/owed_answers.hpp"

#include <utility>

#include "rr/error.hpp"
#include "runtime/cpp/src/service/server_endpoint.hpp"

namespace rr::service {
namespace {

// With its place in the table, about.
std::size_t cost(const LateAnswer& answer) {
  constexpr std::size_t place = 64;
  return sizeof(LateAnswer) + place + answer.path.size() + answer.member_name.size();
}

}  // namespace

std::uint64_t OwedAnswers::add(const std::shared_ptr<ServerEndpoint>& endpoint, LateAnswer answer,
                               std::size_t limit) {
  const MutexLock lock(mutex_);
  const std::uint64_t number = next_++;
  if (has_ended_) return number;
  if (answers_.size() >= limit) {
    throw Error(ErrorCode::out_of_system_resource,
                "more than " + std::to_string(limit) + " requests of the session wait for answers");
  }
  const std::size_t bytes = cost(answer);
  if (!charge_.add(bytes)) {
    throw Error(ErrorCode::out_of_system_resource,
                "the requests of this client that wait for answers take too much memory");
  }
  endpoint_ = endpoint;
  answers_.emplace(number, std::move(answer));
  return number;
}

std::optional<OwedAnswers::Taken> OwedAnswers::take(std::uint64_t number) {
  const MutexLock lock(mutex_);
  const auto found = answers_.find(number);
  if (found == answers_.end()) return std::nullopt;
  charge_.reduce(cost(found->second));
  std::optional<Taken> taken;
  if (auto endpoint = endpoint_.lock()) {
    taken = Taken{std::move(endpoint), std::move(found->second)};
  }
  answers_.erase(found);
  return taken;
}

void OwedAnswers::end() {
  std::unordered_map<std::uint64_t, LateAnswer> dropped;  // without the lock
  const MutexLock lock(mutex_);
  has_ended_ = true;
  endpoint_.reset();
  answers_.swap(dropped);
  charge_ = {};
}

}  // namespace rr::service
