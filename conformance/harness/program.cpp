// SPDX-License-Identifier: Apache-2.0
#include "conformance/harness/program.hpp"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstring>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <thread>

namespace rr::conformance {
namespace {

constexpr std::chrono::seconds program_limit{20};
constexpr std::chrono::milliseconds program_pause{2};

}  // namespace

// A suite that is killed leaves nothing.
Program::Program(std::vector<std::string> words, std::filesystem::path log)
    : name_(words.at(0)), log_(std::move(log)) {
  words.insert(words.begin(), {"setpriv", "--pdeathsig", "KILL"});
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  ::posix_spawn_file_actions_init(&actions);
  ::posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  ::posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, log_.c_str(),
                                     O_WRONLY | O_CREAT | O_APPEND, 0600);
  ::posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
  const int error =
      ::posix_spawnp(&process_, arguments[0], &actions, nullptr, arguments.data(), environ);
  ::posix_spawn_file_actions_destroy(&actions);
  if (error != 0) throw std::runtime_error("cannot start " + name_ + ": " + std::strerror(error));
}

Program::~Program() {
  if (has_ended()) return;
  ::kill(process_, SIGKILL);
  ::waitpid(process_, nullptr, 0);
}

bool Program::has_ended() {
  if (process_ > 0 && ::waitpid(process_, &status_, WNOHANG) == process_) process_ = -1;
  return process_ <= 0;
}

std::string Program::written() const {
  std::ifstream stream(log_);
  return {std::istreambuf_iterator<char>(stream), {}};
}

void Program::fail(const std::string& what) const {
  throw std::runtime_error(name_ + " " + what + "; it has written: " + written());
}

std::string Program::wait_for(const std::string& text) {
  const auto deadline = std::chrono::steady_clock::now() + program_limit;
  for (;;) {
    const bool is_over = has_ended();  // before the last look at what it has written
    const std::string all = written();
    const std::size_t at = all.find(text);
    const std::size_t end = all.find('\n', at);
    if (at != std::string::npos && end != std::string::npos) {
      return all.substr(at + text.size(), end - at - text.size());
    }
    if (is_over) fail("has ended");
    if (std::chrono::steady_clock::now() > deadline) fail("does not say `" + text + "`");
    std::this_thread::sleep_for(program_pause);
  }
}

void Program::end() {
  if (has_ended()) fail("has ended by itself");
  ::kill(process_, SIGTERM);
  const auto deadline = std::chrono::steady_clock::now() + program_limit;
  while (!has_ended()) {
    if (std::chrono::steady_clock::now() > deadline) fail("does not end");
    std::this_thread::sleep_for(program_pause);
  }
  if (!WIFEXITED(status_) || WEXITSTATUS(status_) != 0) fail("did not end as it should");
}

}  // namespace rr::conformance
