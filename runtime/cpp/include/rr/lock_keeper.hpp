// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <string>

#include "rr/service.hpp"
#include "rr/visibility.hpp"

/// Locks of a service's objects that are kept elsewhere: for a service that stands for another one,
/// as that of a gateway, whose own locks would not keep out the other one's clients.
namespace RR_VISIBLE rr {

struct Member;

/// What a client asks for (rr/locks.hpp).
struct LockRequest {
  /// Which of the operations of a session.
  enum class Operation : std::uint8_t {
    lock_for_user,     ///< LockOwner::user
    lock_for_session,  ///< LockOwner::session
    unlock,            ///< a lock of either kind
    enter_monitor,     ///< of the object; once for each session
    go_on_entering,    ///< after an answer that it is to wait on
    exit_monitor,      ///< the one that was entered
  };
  Operation operation = Operation::lock_for_user;  ///< which of them
  std::string path;                                ///< of the object, as Stub::rr_path()
  std::uint32_t client = 0;                        ///< number of its endpoint in this node
  /// Of enter_monitor: how long it waits for the monitor; negative: as long as it takes.
  std::chrono::milliseconds timeout{0};
};

/// A wire, or an endpoint of a pipe, that a client wants to connect.
struct ConnectAttempt {
  std::string path;                ///< of the object, as Stub::rr_path()
  const Member* member = nullptr;  ///< the pipe or wire; never null, and there during the call
  std::uint32_t client = 0;        ///< number of its endpoint in this node
};

/// Answers requests for locks and monitors in place of the service: ServiceOptions::lock_keeper.
class LockKeeper {
 public:
  /// What has become of a request: an exception, which the client gets, or null for success.
  /// `is_waiting` is for enter_monitor and go_on_entering: not yet, the client asks again. Exactly
  /// once, on any thread.
  using Answer = std::function<void(std::exception_ptr error, bool is_waiting)>;

  virtual ~LockKeeper() = default;
  /// Called on a thread of the node, which must not be blocked; what it throws is an answer, too.
  /// A client that waits for a monitor expects an answer within 5 s.
  virtual void keep(LockRequest request, Answer answer) = 0;
  /// A client has logged in as this user, or out, where it is empty: whose locks it asks for from
  /// its next request on. `client` is the number of its endpoint in this node. Called on a thread
  /// of the node, which must not be blocked.
  virtual void set_user(std::uint32_t client, const std::string& user) {
    static_cast<void>(client);
    static_cast<void>(user);
  }
  /// Throws what the client gets when a lock keeps it from connecting a pipe or wire, and does
  /// nothing otherwise, as it does by default. Called before anything is connected, on a thread of
  /// the node, and not for members with `nolock`, nor for a wire that is connected already. It may
  /// wait; other requests of the client wait with it.
  virtual void check_connect(const ConnectAttempt& request) { static_cast<void>(request); }
};

}  // namespace rr
