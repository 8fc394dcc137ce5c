// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "rr/channel.hpp"
#include "rr/intra.hpp"
#include "rr/mutex.hpp"
#include "rr/node.hpp"
#include "rr/serial.hpp"
#include "runtime/cpp/src/serial/bridged_board.hpp"

/// What the clients of this process that use `rr+serial` share.
namespace rr::serial {

using Deadline = std::chrono::steady_clock::time_point;

/// A board that is offered to this process, by a node of its own.
class Line {
 public:
  explicit Line(const BoardPlace& place);

  [[nodiscard]] const BoardPlace& place() const { return place_; }
  /// The name of the service, once the board has been met. Throws rr::Error (connection_error) when
  /// it cannot be or when the time is over before.
  std::string wait(Deadline deadline);
  /// A link to the node. After wait().
  std::unique_ptr<MessageLink> connect();

 private:
  friend class Lines;

  void on_met(const std::string& name);
  void on_failed(const Board::Failure& failure);

  const BoardPlace place_;
  const std::shared_ptr<IntraSpace> space_;
  Node node_;

  Mutex mutex_;
  Condition changed_;
  std::optional<std::string> name_ RR_GUARDED_BY(mutex_);  // empty: not met so far
  Board::Failure failure_ RR_GUARDED_BY(mutex_);           // the last one
  std::size_t failures_ RR_GUARDED_BY(mutex_) = 0;

  // For Lines, under its lock.
  std::size_t users_ = 0;
  Deadline kept_until_{};

  BridgedBoard board_;  // last: its thread uses all of the above
};

/// The lines that are in use. A thread of its own closes those that nobody uses any more: their
/// last user may be on a thread of the very node that goes.
class Lines {
  struct State;

 public:
  Lines();
  /// Waits until all are closed, after their users have gone. Not on a thread of their nodes.
  ~Lines();
  Lines(const Lines&) = delete;
  Lines& operator=(const Lines&) = delete;

  /// Those of the process, shared by all who ask while somebody has them.
  static std::shared_ptr<Lines> of_process();

  /// Keeps a line open.
  class User {
   public:
    User(std::shared_ptr<State> state, std::shared_ptr<Line> line);
    ~User();
    User(const User&) = delete;
    User& operator=(const User&) = delete;

    [[nodiscard]] Line& line() const { return *line_; }
    /// The line is kept until then, for somebody who comes after this one.
    void keep_until(Deadline deadline) { kept_until_ = deadline; }

   private:
    const std::shared_ptr<State> state_;
    std::shared_ptr<Line> line_;
    Deadline kept_until_{};
  };

  /// The line to this place, which is opened when there is none. Throws rr::Error: invalid_argument
  /// when it is in use at another rate, connection_error when one that is being closed is not in
  /// time.
  [[nodiscard]] std::unique_ptr<User> take(const BoardPlace& place, Deadline deadline) const;

 private:
  const std::shared_ptr<State> state_;
  std::thread thread_;
};

}  // namespace rr::serial
