// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/node/testing/child.hpp"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <stdexcept>
#include <thread>
#include <utility>

namespace rr::testing {

Child::Child(const std::vector<std::string>& arguments, std::string program) {
  std::array<int, 2> input{};
  std::array<int, 2> output{};
  if (::pipe2(input.data(), O_CLOEXEC) != 0 || ::pipe2(output.data(), O_CLOEXEC) != 0) {
    throw std::runtime_error("no pipe");
  }
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, input[0], STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, output[1], STDOUT_FILENO);
  std::vector<std::string> words = arguments;
  std::vector<char*> pointers{program.data()};
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  const int error =
      ::posix_spawnp(&process_, program.c_str(), &actions, nullptr, pointers.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  ::close(input[0]);
  ::close(output[1]);
  input_ = input[1];
  output_ = output[0];
  ::fcntl(output_, F_SETFL, O_NONBLOCK);
  if (error != 0) throw std::runtime_error("no process");
}

Child::Child(Child&& other) noexcept
    : process_(std::exchange(other.process_, -1)),
      input_(std::exchange(other.input_, -1)),
      output_(std::exchange(other.output_, -1)),
      rest_(std::move(other.rest_)),
      waited_(std::move(other.waited_)) {}

Child::~Child() {
  if (process_ > 0) {
    ::kill(process_, SIGKILL);
    ::waitpid(process_, nullptr, 0);
  }
  if (input_ >= 0) ::close(input_);
  if (output_ >= 0) ::close(output_);
}

void Child::tell(const std::string& command) const {
  const std::string line = command + '\n';
  if (::write(input_, line.data(), line.size()) < 0) return;  // it has ended, as wait() will tell
}

std::deque<std::string> Child::take_lines() {
  std::array<char, 4096> bytes;
  for (ssize_t size = 0; (size = ::read(output_, bytes.data(), bytes.size())) > 0;) {
    rest_.append(bytes.data(), static_cast<std::size_t>(size));
  }
  std::deque<std::string> lines = std::exchange(waited_, {});
  for (std::size_t end = 0; (end = rest_.find('\n')) != std::string::npos;) {
    lines.push_back(rest_.substr(0, end));
    rest_.erase(0, end + 1);
  }
  return lines;
}

std::string Child::wait_for(const std::string& word) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (std::chrono::steady_clock::now() < deadline) {
    std::deque<std::string> lines = take_lines();
    while (!lines.empty()) {
      const std::string line = std::move(lines.front());
      lines.pop_front();
      if (!line.starts_with(word)) continue;
      waited_ = std::move(lines);
      return line.substr(std::min(line.size(), word.size() + 1));
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  throw std::runtime_error("a process does not say its " + word);
}

void Child::signal(int number) const {
  if (process_ > 0) ::kill(process_, number);
}

void Child::stop() const {
  signal(SIGSTOP);
  int status = 0;
  while (process_ > 0 && ::waitpid(process_, &status, WUNTRACED) < 0 && errno == EINTR) {
  }
}

bool Child::wait(std::chrono::seconds limit, int& status) {
  const auto deadline = std::chrono::steady_clock::now() + limit;
  while (process_ > 0) {
    const pid_t ended = ::waitpid(process_, &status, WNOHANG);
    if (ended == process_) {
      process_ = -1;
      return true;
    }
    if (ended < 0 && errno != EINTR) return false;
    if (std::chrono::steady_clock::now() > deadline) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return true;
}

}  // namespace rr::testing
