// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <exception>
#include <map>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "gateway/export_file.hpp"
#include "gateway/robot_session.hpp"
#include "rr/dynamic.hpp"
#include "rr/function.hpp"
#include "rr/lock_keeper.hpp"
#include "rr/mutex.hpp"

namespace rr::gateway {

/// The session with the robot's service that one far client has to itself. It is not made again
/// when it is lost: its locks are gone then. Used by one thread, which is not blocked, but for
/// find().
class ExportedSession : public std::enable_shared_from_this<ExportedSession> {
 public:
  using Clock = std::chrono::steady_clock;
  /// What becomes of a request for a lock; `is_waiting` as in LockKeeper::Answer.
  using Locked = Function<void(std::exception_ptr, bool is_waiting)>;
  /// Notified on threads of the node.
  struct Listener {
    Function<void(std::exception_ptr)> opened;  ///< once: null when the session has begun
    Function<void()> closed;                    ///< it has ended, whoever ended it
  };
  /// Runs a function on the thread that uses this, if it still runs.
  using Post = Function<void(Function<void()>)>;

  /// `reply_topic` is where the client's gateway reads.
  ExportedSession(Post post, Listener listener, std::string reply_topic)
      : post_(std::move(post)),
        listener_(std::move(listener)),
        reply_topic_(std::move(reply_topic)) {}
  /// As close().
  ~ExportedSession();
  ExportedSession(const ExportedSession&) = delete;
  ExportedSession& operator=(const ExportedSession&) = delete;

  /// Begins to connect. Once.
  void open(Node& node, const std::string& url, const MappedUser& user);
  /// Whether it has begun.
  [[nodiscard]] bool is_open() const;
  /// As RobotSession::find(). Any thread.
  void find(const std::string& path, const RobotSession::Found& done) const;
  [[nodiscard]] const std::string& reply_topic() const { return reply_topic_; }
  /// Keeps an object of the session, whose callbacks last as long. True for the first one at a
  /// path, unless there are too many. Any thread.
  bool is_new(const std::string& path, const dynamic::Object& object);
  /// Carries out an operation on the lock or the monitor of an object of this session. The answer
  /// comes on the thread that uses this. Throws rr::Error: invalid_operation for what does not fit
  /// the operations before, out_of_system_resource when too many run.
  void keep(const LockRequest& request, const dynamic::Object& object, Locked done);
  /// A lock of its user at this path was released in another session.
  void forget_lock(const std::string& path);
  /// Answers those that have waited long for a monitor. To be called often.
  void tick(Clock::time_point now);
  /// Ends it, and waits until that is done: for a thread that may be blocked.
  void close();

 private:
  /// A client that enters a monitor, which takes as long as others are in it.
  struct Attempt {
    Locked done;  // empty between an answer that it waits and the next request
    Clock::time_point answer_due;
    bool is_over = false;
    std::exception_ptr error;
  };
  struct Operation {
    std::thread thread;
    std::shared_ptr<std::atomic<bool>> is_over;
  };

  void enter(const LockRequest& request, const dynamic::Object& object, Locked done);
  void entered(const std::string& path, const std::exception_ptr& error);
  void go_on(const std::string& path, Locked done);
  void note(LockRequest::Operation operation, const std::string& path,
            const std::shared_ptr<Stub>& object);
  void run(Function<void()> operation, Function<void(std::exception_ptr)> done);
  void join_finished() RR_REQUIRES(mutex_);

  const Post post_;
  const Listener listener_;
  const std::string reply_topic_;
  std::map<std::string, Attempt> attempts_;  // by path
  mutable Mutex mutex_;
  std::vector<Operation> operations_ RR_GUARDED_BY(mutex_);
  dynamic::Client client_ RR_GUARDED_BY(mutex_);
  std::map<std::string, dynamic::Object> objects_ RR_GUARDED_BY(mutex_);  // by path
  // That were made here for the user, and not released: by path. The gateway's own session of the
  // same user would keep them.
  std::map<std::string, std::shared_ptr<Stub>> user_locks_ RR_GUARDED_BY(mutex_);
  bool is_closed_ RR_GUARDED_BY(mutex_) = false;
};

}  // namespace rr::gateway
