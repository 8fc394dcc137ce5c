// SPDX-License-Identifier: Apache-2.0
#include "conformance/harness/runner.hpp"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <thread>

namespace rr::conformance {
namespace {

struct Pipe {
  Descriptor read;
  Descriptor write;

  Pipe() {
    int ends[2];
    if (::pipe2(ends, O_CLOEXEC) != 0) throw std::runtime_error("cannot make a pipe");
    read = Descriptor(ends[0]);
    write = Descriptor(ends[1]);
  }
};

bool has_ended(pid_t process, Milliseconds limit) {
  const auto end = std::chrono::steady_clock::now() + limit;
  while (::waitpid(process, nullptr, WNOHANG) == 0) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(Milliseconds(1));
  }
  return true;
}

}  // namespace

Runner::Runner(std::vector<std::string> command, const std::string& verb) : name_(command.at(0)) {
  command.push_back(verb);
  std::vector<char*> arguments;
  for (std::string& word : command) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  Pipe input;
  Pipe output;
  posix_spawn_file_actions_t actions;
  ::posix_spawn_file_actions_init(&actions);
  ::posix_spawn_file_actions_adddup2(&actions, input.read.get(), STDIN_FILENO);
  ::posix_spawn_file_actions_adddup2(&actions, output.write.get(), STDOUT_FILENO);
  const int error =
      ::posix_spawnp(&process_, arguments[0], &actions, nullptr, arguments.data(), environ);
  ::posix_spawn_file_actions_destroy(&actions);
  if (error != 0) throw std::runtime_error("cannot start " + name_ + ": " + std::strerror(error));
  input_ = std::move(input.write);
  output_ = std::move(output.read);
}

Runner::~Runner() {
  input_.close();
  if (has_ended(process_, Milliseconds(3000))) return;
  ::kill(process_, SIGKILL);
  ::waitpid(process_, nullptr, 0);
}

void Runner::tell(const Json& request) {
  std::string line = request.dump() + "\n";
  for (std::string_view left = line; !left.empty();) {
    const ssize_t count = ::write(input_.get(), left.data(), left.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) throw std::runtime_error(name_ + " has ended");
    left.remove_prefix(static_cast<std::size_t>(count));
  }
}

std::optional<Json> Runner::answer(Milliseconds limit) {
  std::size_t end = received_.find('\n');
  while (end == std::string::npos) {
    if (!wait_readable(output_.get(), limit)) return std::nullopt;
    char buffer[65536];
    const ssize_t count = ::read(output_.get(), buffer, sizeof buffer);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) throw std::runtime_error(name_ + " has ended");
    const std::size_t searched = received_.size();
    received_.append(buffer, static_cast<std::size_t>(count));
    end = received_.find('\n', searched);
  }
  const std::string line = received_.substr(0, end);
  received_.erase(0, end + 1);
  Json json = Json::parse(line, nullptr, false);
  if (json.is_discarded())
    throw std::runtime_error(name_ + " wrote no JSON: " + line.substr(0, 200));
  return json;
}

Json Runner::ask(const Json& request, Milliseconds limit) {
  tell(request);
  if (auto json = answer(limit)) return *json;
  throw std::runtime_error(name_ + " gave no answer to " + request.dump().substr(0, 200));
}

Json Runner::order(const Json& request) {
  Json json = ask(request);
  if (json.contains("error")) {
    throw std::runtime_error(name_ + ": " + json["error"].get<std::string>());
  }
  return json;
}

}  // namespace rr::conformance
