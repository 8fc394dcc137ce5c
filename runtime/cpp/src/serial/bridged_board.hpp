// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "rr/node.hpp"
#include "rr/serial.hpp"
#include "runtime/cpp/src/serial/board.hpp"
#include "runtime/cpp/src/serial/served_board.hpp"

namespace rr::serial {

/// A board and the service of a node that is made of it, from the first time that it is met.
class BridgedBoard {
 public:
  /// All called on the board's thread, under no lock.
  struct Functions {
    /// What happens, for people: `light: connected`.
    BoardBridge::Log log{};
    /// The board is there, and offered under this name.
    std::function<void(const std::string&)> met{};
    /// An attempt to reach it has failed.
    std::function<void(const Board::Failure&)> failed{};
  };

  BridgedBoard(Node& node, const BoardPlace& place, Functions functions);
  /// Closes the service. Not on the board's thread.
  ~BridgedBoard();
  BridgedBoard(const BridgedBoard&) = delete;
  BridgedBoard& operator=(const BridgedBoard&) = delete;

 private:
  void say(const std::string& what) const;
  void on_connected(const BoardTexts& texts, bool is_new);
  void on_failed(const Board::Failure& failure);
  void offer(const BoardTexts& texts);
  void withdraw();

  Node& node_;
  const BoardPlace place_;
  const Functions functions_;
  std::string name_;
  std::string last_failure_;
  Service offered_;
  std::shared_ptr<BoardService> service_;
  const std::shared_ptr<Board> board_;  // its thread alone uses the above, until it has ended
};

}  // namespace rr::serial
