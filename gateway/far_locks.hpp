// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <memory>
#include <string_view>

#include "gateway/far_sessions.hpp"
#include "rr/lock_keeper.hpp"

namespace rr::gateway {

/// Locks and monitors of a far robot's objects: each request of a client goes to the robot, in the
/// client's own session there.
class FarLocks final : public LockKeeper, public std::enable_shared_from_this<FarLocks> {
 public:
  /// `is_robot_there` is set by the owner, on any thread.
  FarLocks(std::shared_ptr<FarSessions> sessions, ServiceAddress address,
           std::shared_ptr<const std::atomic<bool>> is_robot_there)
      : sessions_(std::move(sessions)),
        address_(std::move(address)),
        is_robot_there_(std::move(is_robot_there)) {}

  /// Throws rr::Error: out_of_system_resource when too many requests have no answer yet.
  void keep(LockRequest request, Answer answer) override;
  void set_user(std::uint32_t client, const std::string& user) override {
    sessions_->set_user(client, user);
  }
  /// Asks the robot about a pipe or wire. One that does not answer has no locks, and is not asked
  /// for some seconds: each question takes a thread of the node for as long as it waits.
  void check_connect(const ConnectAttempt& attempt) override;

 private:
  const std::shared_ptr<FarSessions> sessions_;
  const ServiceAddress address_;
  const std::shared_ptr<const std::atomic<bool>> is_robot_there_;
  std::atomic<std::size_t> unanswered_{0};
  std::atomic<FarSessions::Clock::time_point> silent_until_{};
};

/// `lock` for LockRequest::Operation::lock_for_user: the property `op` of requests.
std::string_view lock_operation_name(LockRequest::Operation operation);
/// The reverse. Throws rr::Error (invalid_argument).
LockRequest::Operation lock_operation(std::string_view name);

}  // namespace rr::gateway
