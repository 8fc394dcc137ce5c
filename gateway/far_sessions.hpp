// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gateway/far_calls.hpp"
#include "rr/function.hpp"
#include "rr/mutex.hpp"

namespace rr::gateway {

/// The sessions that clients of a service here have at the robot: of each client that needs one of
/// its own, because it locks objects, or because the robot may call it back. The other clients
/// share the session of their user. Any thread, unless it is said otherwise.
class FarSessions : public std::enable_shared_from_this<FarSessions> {
 public:
  using Clock = std::chrono::steady_clock;
  /// Called when the session of a client has ended at the robot, and with it its locks.
  using Lost = Function<void(std::uint32_t client, const std::string& reason)>;
  /// How much clients may make this keep.
  struct Limits {
    std::size_t sessions = 1'024;  ///< of all clients
    std::size_t waiting = 256;     ///< requests of one client while its session begins
    std::chrono::milliseconds alive{
        5'000};  ///< from one message that sessions are in use to the next
  };

  FarSessions(std::shared_ptr<FarCalls> calls, ServiceAddress address, const Limits& limits,
              Lost lost);

  /// From now on each client has a session of its own, from its first request on.
  void require();
  /// A client has connected; its number is that of its endpoint in this node.
  void begin(std::uint32_t client);
  /// It has logged in here as this user, for whom its session at the robot is from then on; empty
  /// for none. A session of another user ends.
  void set_user(std::uint32_t client, const std::string& user);
  /// Which login of the client is the last one: 1 until its user changes. 0 when it has gone. A
  /// request with another number is refused with ErrorCode::authentication_error.
  [[nodiscard]] std::uint64_t login_of(std::uint32_t client) const;
  /// It has gone: its session at the robot ends.
  void end(std::uint32_t client);
  /// All have gone.
  void end_all();

  /// A request of a client to the robot: in its session, if it has one. 0 is no client.
  void request(std::uint32_t client, FarRequest wanted, FarCalls::Done done);
  /// The same, in a session that begins now if need be.
  void request_in_session(std::uint32_t client, FarRequest wanted, FarCalls::Done done);
  /// As request() of the client whose request this thread handles, and waits as FarCalls::wait().
  Message wait(FarRequest wanted);
  /// The same for any client.
  Message wait(std::uint32_t client, FarRequest wanted);

  /// Says to the robot's gateway that sessions are in use. To be called often, on the worker's
  /// thread.
  void tick(Clock::time_point now);
  /// A message in which the robot's gateway names sessions that have ended. On the worker's thread.
  void take_ended(const Message& message);
  /// The client whose session has this name.
  [[nodiscard]] std::optional<std::uint32_t> client_of(std::string_view session) const;

 private:
  enum class State { none, opening, open };
  struct Waiting {
    FarRequest request;
    FarCalls::Done done;
  };
  struct Session {
    State state = State::none;
    std::string user{};       // of this gateway
    std::uint64_t login = 1;  // of the client
    std::string name{};
    std::vector<Waiting> waiting{};
  };

  void ask(std::uint32_t client, FarRequest wanted, FarCalls::Done done, bool needs_session);
  // Both say why not.
  bool begin_opening(Session& session, std::exception_ptr& refusal) RR_REQUIRES(mutex_);
  bool has_room(const Session& session, std::exception_ptr& refusal) const;
  void open(std::uint32_t client, const std::string& name, const std::string& user);
  void opened(std::uint32_t client, const std::string& name, const std::exception_ptr& error);
  void send(std::uint32_t client, const std::string& name, FarRequest wanted, FarCalls::Done done);
  void give_up(const Session& session, const std::exception_ptr& reason);
  void end_at_robot(const std::string& name);
  void lose(std::uint32_t client, const std::string& name);
  [[nodiscard]] FarRequest about_session(std::string_view operation, const std::string& name) const;

  const std::shared_ptr<FarCalls> calls_;
  const ServiceAddress address_;
  const Limits limits_;
  const Lost lost_;
  mutable Mutex mutex_;
  bool is_required_ RR_GUARDED_BY(mutex_) = false;
  std::map<std::uint32_t, Session> sessions_ RR_GUARDED_BY(mutex_);  // by client
  std::size_t begun_ RR_GUARDED_BY(mutex_) = 0;                      // that are not `none`
  Clock::time_point told_{};                                         // worker's thread
};

}  // namespace rr::gateway
