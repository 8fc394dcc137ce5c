// SPDX-License-Identifier: Apache-2.0
#include "compiler/system/piped_program.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <system_error>

namespace robdef::system {
namespace {

[[noreturn]] void fail(int code) { throw std::system_error(code, std::generic_category()); }

/// One end of a pipe.
class End {
 public:
  End() = default;
  ~End() { close(); }
  End(const End&) = delete;
  End& operator=(const End&) = delete;

  void take(int number) { number_ = number; }
  void close() {
    if (number_ >= 0) ::close(number_);
    number_ = -1;
  }
  void stop_blocking() const { ::fcntl(number_, F_SETFL, ::fcntl(number_, F_GETFL) | O_NONBLOCK); }
  [[nodiscard]] bool is_open() const { return number_ >= 0; }
  [[nodiscard]] int number() const { return number_; }

 private:
  int number_ = -1;
};

struct Pipe {
  End reading;
  End writing;

  Pipe() {
    std::array<int, 2> ends{};
    if (::pipe2(ends.data(), O_CLOEXEC) != 0) fail(errno);
    reading.take(ends[0]);
    writing.take(ends[1]);
  }
};

/// Writing to a program that has closed its input is an error then, and no signal.
class NoBrokenPipe {
 public:
  NoBrokenPipe() {
    struct sigaction ignore {};
    ignore.sa_handler = SIG_IGN;
    ::sigaction(SIGPIPE, &ignore, &before_);
  }
  ~NoBrokenPipe() { ::sigaction(SIGPIPE, &before_, nullptr); }
  NoBrokenPipe(const NoBrokenPipe&) = delete;
  NoBrokenPipe& operator=(const NoBrokenPipe&) = delete;

 private:
  struct sigaction before_ {};
};

pid_t start(std::vector<std::string> words, const Pipe& in, const Pipe& out, const Pipe& errors) {
  posix_spawn_file_actions_t actions{};
  posix_spawnattr_t attributes{};
  ::posix_spawn_file_actions_init(&actions);
  ::posix_spawnattr_init(&attributes);
  ::posix_spawn_file_actions_adddup2(&actions, in.reading.number(), STDIN_FILENO);
  ::posix_spawn_file_actions_adddup2(&actions, out.writing.number(), STDOUT_FILENO);
  ::posix_spawn_file_actions_adddup2(&actions, errors.writing.number(), STDERR_FILENO);
  sigset_t defaults{};
  sigemptyset(&defaults);
  sigaddset(&defaults, SIGPIPE);
  ::posix_spawnattr_setsigdefault(&attributes, &defaults);
  ::posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF);
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  pid_t process = -1;
  const int code =
      ::posix_spawnp(&process, arguments[0], &actions, &attributes, arguments.data(), environ);
  ::posix_spawnattr_destroy(&attributes);
  ::posix_spawn_file_actions_destroy(&actions);
  if (code != 0) fail(code);
  return process;
}

using Buffer = std::array<char, 65536>;

std::string_view read_from(End& end, Buffer& buffer) {
  const ssize_t count = ::read(end.number(), buffer.data(), buffer.size());
  if (count > 0) return {buffer.data(), static_cast<std::size_t>(count)};
  if (count == 0 || (errno != EAGAIN && errno != EINTR)) end.close();
  return {};
}

}  // namespace

struct PipedProgram::State {
  explicit State(const std::vector<std::string>& words) : process(start(words, in, out, errors)) {
    in.reading.close();
    out.writing.close();
    errors.writing.close();
    in.writing.stop_blocking();
    out.reading.stop_blocking();
    errors.reading.stop_blocking();
  }

  void wait(int flags) {
    pid_t ended = 0;
    do {
      ended = ::waitpid(process, &status, flags);
    } while (ended < 0 && errno == EINTR);
    has_ended = ended != 0;
  }

  std::size_t write_some(std::string_view input) {
    const ssize_t count = ::write(in.writing.number(), input.data(), input.size());
    if (count >= 0) return static_cast<std::size_t>(count);
    if (errno != EAGAIN && errno != EINTR) in.writing.close();
    return 0;
  }

  Pipe in;
  Pipe out;
  Pipe errors;
  Buffer out_buffer;
  Buffer err_buffer;
  const NoBrokenPipe no_broken_pipe;
  const pid_t process;
  int status = 0;
  bool has_ended = false;
};

PipedProgram::PipedProgram(const std::vector<std::string>& words)
    : state_(std::make_unique<State>(words)) {}

PipedProgram::~PipedProgram() {
  if (state_->has_ended) return;
  end();
  state_->wait(0);
}

PipedProgram::Moved PipedProgram::move(std::string_view input, std::chrono::milliseconds most) {
  State& state = *state_;
  if (input.empty()) state.in.writing.close();
  // A closed end has a negative number, which poll() leaves out.
  std::array<pollfd, 3> ends{{{state.in.writing.number(), POLLOUT, 0},
                              {state.out.reading.number(), POLLIN, 0},
                              {state.errors.reading.number(), POLLIN, 0}}};
  Moved moved;
  if (::poll(ends.data(), ends.size(), static_cast<int>(most.count())) <= 0) return moved;
  if (ends[0].revents != 0) moved.written = state.write_some(input);
  if (ends[1].revents != 0) moved.out = read_from(state.out.reading, state.out_buffer);
  if (ends[2].revents != 0) moved.err = read_from(state.errors.reading, state.err_buffer);
  return moved;
}

bool PipedProgram::says_something() const {
  return state_->out.reading.is_open() || state_->errors.reading.is_open();
}

bool PipedProgram::has_ended() {
  if (!state_->has_ended) state_->wait(WNOHANG);
  return state_->has_ended;
}

void PipedProgram::end() {
  if (!state_->has_ended) ::kill(state_->process, SIGKILL);
}

int PipedProgram::status() {
  if (!state_->has_ended) state_->wait(0);
  return WIFEXITED(state_->status) ? WEXITSTATUS(state_->status) : -1;
}

std::string PipedProgram::failure() {
  const int code = status();
  if (code == 0) return "";
  if (code > 0) return "failed with exit status " + std::to_string(code);
  const int signal = WTERMSIG(state_->status);
  return "was ended by signal " + std::to_string(signal) + " (" + ::strsignal(signal) + ")";
}

}  // namespace robdef::system
