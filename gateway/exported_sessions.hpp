// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "gateway/exported_session.hpp"
#include "gateway/worker.hpp"

namespace rr::gateway {

/// Sessions at the robot of far clients that have one of their own, each of one user of the broker.
/// On the worker's thread.
class ExportedSessions {
 public:
  using Clock = std::chrono::steady_clock;
  /// What far clients may take of a robot's service, and for how long without a word.
  struct Limits {
    std::size_t sessions = 1'024;
    std::chrono::milliseconds silence{30'000};
  };
  /// Null when the session has begun.
  using Opened = Function<void(std::exception_ptr)>;

  /// Called when the robot has ended a session, with its name and where its gateway reads: after
  /// the answers of its requests.
  using Ended = Function<void(const std::string& name, const std::string& reply_topic)>;

  ExportedSessions(Worker& worker, const Limits& limits, Ended ended);
  /// Ends them.
  ~ExportedSessions();
  ExportedSessions(const ExportedSessions&) = delete;
  ExportedSessions& operator=(const ExportedSessions&) = delete;

  /// Begins a session by this name for a user of the broker, who is `login` at the robot, and whose
  /// gateway reads at `reply_topic`. For one that is there `opened` is called at once, unless it
  /// still begins. Throws rr::Error: invalid_argument for what is no name, out_of_system_resource
  /// when there are too many.
  void open(Node& node, const std::string& url, const MappedUser& login, const std::string& user,
            const std::string& name, const std::string& reply_topic, Opened opened);
  /// One that has begun, which is in use from now on; null when it has ended.
  std::shared_ptr<ExportedSession> find(const std::string& user, std::string_view name);
  /// A request in the session is executed: once it is answered, request_answered() with the same.
  void request_begun(const std::string& user, std::string_view name);
  void request_answered(const std::string& user, std::string_view name,
                        const std::shared_ptr<ExportedSession>& session);
  /// Ends one, if it is there.
  void end(const std::string& user, std::string_view name);
  /// Those of these names, with commas between them, are in use. Returns those that have ended.
  std::string still_used(const std::string& user, std::string_view names);
  /// A lock of a user of the broker at a path was released.
  void released(const std::string& user, const std::string& path);
  /// Ends those that nobody has used for too long, and answers for locks. To be called often.
  void tick(Clock::time_point now);

 private:
  struct Entry {
    std::shared_ptr<ExportedSession> session;
    Clock::time_point used;
    std::size_t requests = 0;                  // without an answer
    std::optional<Clock::time_point> ended{};  // by the robot, which is told after these answers
  };
  using Key = std::pair<std::string, std::string>;  // user, name
  using Entries = std::map<Key, Entry>;

  ExportedSession::Listener listener(const Key& key, Opened opened);
  void ended_by_robot(const Key& key);
  void tell_end(const Key& key);
  void finish(const Key& key, const std::exception_ptr& error, const Opened& opened);
  void close(std::shared_ptr<ExportedSession> session);

  Worker& worker_;
  const Limits limits_;
  const Ended ended_;
  Entries entries_;
  std::shared_ptr<ExportedSessions*> self_;  // for what is posted: it may come when this has gone
  Worker closing_;                           // a session that ends waits for the robot
};

}  // namespace rr::gateway
