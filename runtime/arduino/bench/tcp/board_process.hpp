// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <string>

/// For tests: a program that is a board with a network, at a port of the loopback interface.
namespace rr::serial::testing {

class BoardProcess {
 public:
  /// Throws std::runtime_error when the program does not start.
  explicit BoardProcess(std::string program);
  /// Ends the program.
  ~BoardProcess();
  BoardProcess(const BoardProcess&) = delete;
  BoardProcess& operator=(const BoardProcess&) = delete;

  [[nodiscard]] std::uint16_t port() const { return port_; }
  /// Takes its power away.
  void kill();
  /// Begins anew, at the same port.
  void start();
  /// Neither goes on nor closes its connections.
  void freeze() const;
  void thaw() const;

 private:
  const std::string program_;
  std::uint16_t port_ = 0;
  pid_t process_ = -1;
  int input_ = -1;
};

}  // namespace rr::serial::testing
