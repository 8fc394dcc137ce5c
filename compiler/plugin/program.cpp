// SPDX-License-Identifier: Apache-2.0
#include "compiler/plugin/program.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>

#include "compiler/diagnostics/excerpt.hpp"
#include "compiler/plugin/plugin.hpp"

extern char** environ;

namespace robdef::plugin {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t longest_line = 4096;
constexpr std::size_t most_lines = 10'000;
// How often to look for its end, in ms: while its output would tell, and after that.
constexpr int look_each = 50;
constexpr int look_soon = 2;

[[noreturn]] void give_up(const std::string& what) { throw PluginError(what); }

std::string reason_of(int code) { return std::generic_category().message(code); }

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
    if (::pipe2(ends.data(), O_CLOEXEC) != 0) give_up("cannot be started: " + reason_of(errno));
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

/// What a program says to people, line by line.
class Lines {
 public:
  explicit Lines(std::ostream& err) : err_(err) {}

  void take(std::string_view text) {
    for (const char c : text) {
      if (c == '\n') {
        end_line();
      } else if (line_.size() < longest_line) {
        line_ += c;
      }
    }
  }
  void end() {
    if (!line_.empty()) end_line();
  }

 private:
  void end_line() {
    if (count_++ < most_lines) {
      err_ << printable(std::exchange(line_, {})) << '\n' << std::flush;
    } else {
      line_.clear();
      if (count_ == most_lines + 1) err_ << "robdef: further lines are left out\n" << std::flush;
    }
  }

  std::ostream& err_;
  std::string line_;
  std::size_t count_ = 0;
};

pid_t start(const std::string& program, const Pipe& in, const Pipe& out, const Pipe& errors) {
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
  std::string word = program;
  std::array<char*, 2> arguments{word.data(), nullptr};
  pid_t process = -1;
  const int code =
      ::posix_spawnp(&process, word.c_str(), &actions, &attributes, arguments.data(), environ);
  ::posix_spawnattr_destroy(&attributes);
  ::posix_spawn_file_actions_destroy(&actions);
  if (code != 0) give_up("cannot be started: " + reason_of(code));
  return process;
}

/// A running program, which does not outlive this.
class Child {
 public:
  explicit Child(pid_t process) : process_(process) {}
  ~Child() {
    if (has_ended_) return;
    ::kill(process_, SIGKILL);
    wait(0);
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  [[nodiscard]] bool has_ended() {
    if (!has_ended_) wait(WNOHANG);
    return has_ended_;
  }
  /// Why it has not ended well; empty when it has.
  [[nodiscard]] std::string failure() {
    if (!has_ended_) wait(0);
    if (WIFSIGNALED(status_)) {
      return "was ended by signal " + std::to_string(WTERMSIG(status_)) + " (" +
             ::strsignal(WTERMSIG(status_)) + ")";
    }
    const int status = WEXITSTATUS(status_);
    return status == 0 ? "" : "failed with exit status " + std::to_string(status);
  }

 private:
  void wait(int flags) {
    pid_t ended = 0;
    do {
      ended = ::waitpid(process_, &status_, flags);
    } while (ended < 0 && errno == EINTR);
    has_ended_ = ended != 0;
  }

  const pid_t process_;
  int status_ = 0;
  bool has_ended_ = false;
};

/// Moves bytes in three directions until there is nothing left to move.
class Conversation {
 public:
  Conversation(Pipe& in, Pipe& out, Pipe& errors, std::string_view input, const Limits& limits,
               std::ostream& err)
      : in_(in.writing),
        out_(out.reading),
        errors_(errors.reading),
        input_(input),
        limits_(limits),
        lines_(err) {
    in_.stop_blocking();
    out_.stop_blocking();
    errors_.stop_blocking();
  }

  Printed run(Child& child) {
    Clock::time_point moved = Clock::now();
    while (says_something() || !child.has_ended()) {
      if (move_some()) moved = Clock::now();
      const auto silence = Clock::now() - moved;
      if (child.has_ended() ? silence > limits_.after_end : silence > limits_.silence) {
        if (child.has_ended()) break;
        give_up("did nothing for " +
                std::to_string(std::chrono::ceil<std::chrono::seconds>(limits_.silence).count()) +
                " s, and was ended");
      }
    }
    in_.close();
    lines_.end();
    return std::move(printed_);
  }

 private:
  [[nodiscard]] bool says_something() const { return out_.is_open() || errors_.is_open(); }

  // A closed end has a negative number, which poll() leaves out.
  bool move_some() {
    std::array<pollfd, 3> ends{
        {{in_.number(), POLLOUT, 0}, {out_.number(), POLLIN, 0}, {errors_.number(), POLLIN, 0}}};
    if (::poll(ends.data(), ends.size(), says_something() ? look_each : look_soon) <= 0)
      return false;
    bool has_moved = false;
    if (ends[0].revents != 0) has_moved = write_some();
    if (ends[1].revents != 0) has_moved = read_output() || has_moved;
    if (ends[2].revents != 0) has_moved = read_errors() || has_moved;
    return has_moved;
  }

  bool write_some() {
    const ssize_t count = ::write(in_.number(), input_.data(), input_.size());
    if (count < 0) {
      if (errno != EAGAIN && errno != EINTR) in_.close();
      return false;
    }
    printed_.read += static_cast<std::size_t>(count);
    input_.remove_prefix(static_cast<std::size_t>(count));
    if (input_.empty()) in_.close();
    return true;
  }

  std::string_view read_from(End& end) {
    const ssize_t count = ::read(end.number(), buffer_.data(), buffer_.size());
    if (count > 0) return {buffer_.data(), static_cast<std::size_t>(count)};
    if (count == 0 || (errno != EAGAIN && errno != EINTR)) end.close();
    return {};
  }

  bool read_output() {
    const std::string_view piece = read_from(out_);
    if (piece.size() > limits_.output - printed_.text.size()) {
      give_up("printed more than " + std::to_string(limits_.output) + " bytes, and was ended");
    }
    printed_.text += piece;
    return !piece.empty();
  }

  bool read_errors() {
    const std::string_view piece = read_from(errors_);
    lines_.take(piece);
    return !piece.empty();
  }

  End& in_;
  End& out_;
  End& errors_;
  std::string_view input_;
  const Limits& limits_;
  Lines lines_;
  Printed printed_;
  std::array<char, 65536> buffer_{};
};

}  // namespace

Printed run_program(const std::string& program, std::string_view input, const Limits& limits,
                    std::ostream& err) {
  Pipe in;
  Pipe out;
  Pipe errors;
  const NoBrokenPipe no_broken_pipe;
  Child child(start(program, in, out, errors));
  in.reading.close();
  out.writing.close();
  errors.writing.close();
  Printed printed = Conversation(in, out, errors, input, limits, err).run(child);
  if (const std::string failure = child.failure(); !failure.empty()) give_up(failure);
  return printed;
}

}  // namespace robdef::plugin
