// SPDX-License-Identifier: Apache-2.0
#include "runtime/arduino/bench/tcp/board_process.hpp"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <stdexcept>
#include <utility>

namespace rr::serial::testing {

BoardProcess::BoardProcess(std::string program) : program_(std::move(program)) { start(); }

BoardProcess::~BoardProcess() { kill(); }

void BoardProcess::start() {
  int to_board[2];
  int from_board[2];
  if (::pipe2(to_board, O_CLOEXEC) != 0 || ::pipe2(from_board, O_CLOEXEC) != 0) {
    throw std::runtime_error("no pipe");
  }
  posix_spawn_file_actions_t actions;
  ::posix_spawn_file_actions_init(&actions);
  ::posix_spawn_file_actions_adddup2(&actions, to_board[0], STDIN_FILENO);
  ::posix_spawn_file_actions_adddup2(&actions, from_board[1], STDOUT_FILENO);
  std::string program = program_;
  std::string port = std::to_string(port_);
  char* const arguments[] = {program.data(), port.data(), nullptr};
  const int status =
      ::posix_spawn(&process_, program.c_str(), &actions, nullptr, arguments, environ);
  ::posix_spawn_file_actions_destroy(&actions);
  ::close(to_board[0]);
  ::close(from_board[1]);
  input_ = to_board[1];
  std::string line;
  char byte = 0;
  while (status == 0 && ::read(from_board[0], &byte, 1) == 1 && byte != '\n') line += byte;
  ::close(from_board[0]);
  port_ = static_cast<std::uint16_t>(std::strtoul(line.c_str(), nullptr, 10));
  if (port_ == 0) throw std::runtime_error("the board does not start: " + program_);
}

void BoardProcess::kill() {
  if (process_ < 0) return;
  ::kill(process_, SIGKILL);
  ::waitpid(process_, nullptr, 0);
  ::close(input_);
  process_ = -1;
}

void BoardProcess::freeze() const { ::kill(process_, SIGSTOP); }
void BoardProcess::thaw() const { ::kill(process_, SIGCONT); }

}  // namespace rr::serial::testing
