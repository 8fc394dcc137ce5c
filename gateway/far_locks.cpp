// SPDX-License-Identifier: Apache-2.0
#include "gateway/far_locks.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include "rr/definition.hpp"
#include "rr/error.hpp"

namespace rr::gateway {
namespace {

constexpr std::size_t most_unanswered = 1'024;
// So long a robot that has not answered is not asked about pipes and wires.
constexpr std::chrono::seconds silence{10};

using Operation = LockRequest::Operation;
constexpr std::array<std::pair<Operation, std::string_view>, 6> operations{
    {{Operation::lock_for_user, "lock"},
     {Operation::lock_for_session, "lock-session"},
     {Operation::unlock, "unlock"},
     {Operation::enter_monitor, "enter"},
     {Operation::go_on_entering, "go-on"},
     {Operation::exit_monitor, "exit"}}};

/// Below the root, as topics have it: `tools[left%20hand]` for `bench.tools[left%20hand]`.
std::string path_below_root(const std::string& path) {
  const std::size_t dot = path.find('.');
  std::string result;
  if (dot == std::string::npos) return result;
  for (const PathStep& step : path_steps(std::string_view(path).substr(dot + 1))) {
    result = path_below(result, step);
  }
  return result;
}

}  // namespace

std::string_view lock_operation_name(Operation operation) {
  return std::ranges::find(operations, operation, [](const auto& row) { return row.first; })
      ->second;
}

Operation lock_operation(std::string_view name) {
  const auto* const found =
      std::ranges::find(operations, name, [](const auto& row) { return row.second; });
  if (found != operations.end()) return found->first;
  throw Error(ErrorCode::invalid_argument, "`" + std::string(name) + "` is no operation on a lock");
}

void FarLocks::keep(LockRequest request, Answer answer) {
  FarRequest wanted{address_, Verb::lock, path_below_root(request.path), ""};
  wanted.properties = {{"op", std::string(lock_operation_name(request.operation))}};
  if (request.operation == Operation::enter_monitor) {
    wanted.properties.emplace_back("timeout", std::to_string(request.timeout.count()));
  }
  if (unanswered_.fetch_add(1) >= most_unanswered) {
    unanswered_.fetch_sub(1);
    throw Error(ErrorCode::out_of_system_resource, "too many requests for locks have no answer");
  }
  sessions_->request_in_session(request.client, std::move(wanted),
                                [self = shared_from_this(), answer = std::move(answer)](
                                    const std::exception_ptr& error, const Message& message) {
                                  self->unanswered_.fetch_sub(1);
                                  answer(error, message.find("waiting").has_value());
                                });
}

void FarLocks::check_connect(const ConnectAttempt& attempt) {
  using Clock = FarSessions::Clock;
  if (!*is_robot_there_) return;
  if (Clock::now() < silent_until_.load()) return;
  try {
    sessions_->wait(attempt.client, {address_, Verb::connect, path_below_root(attempt.path),
                                     std::string(attempt.member->name)});
  } catch (const Error& error) {
    if (error.code() == ErrorCode::object_locked_error) throw;
    if (error.code() == ErrorCode::request_timeout) silent_until_ = Clock::now() + silence;
  }
}

}  // namespace rr::gateway
