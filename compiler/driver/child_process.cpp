// SPDX-License-Identifier: Apache-2.0
#include "compiler/driver/child_process.hpp"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <memory>
#include <system_error>

extern char** environ;

namespace robdef {
namespace {

[[noreturn]] void fail(int code, const std::string& what) {
  throw std::system_error(code, std::generic_category(), what);
}

class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() { close(); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  void close() {
    if (number_ >= 0) ::close(number_);
    number_ = -1;
  }
  [[nodiscard]] int number() const { return number_; }

 private:
  int number_;
};

// What the child has instead of our streams.
class Streams {
 public:
  Streams() { ::posix_spawn_file_actions_init(&actions_); }
  ~Streams() { ::posix_spawn_file_actions_destroy(&actions_); }
  Streams(const Streams&) = delete;
  Streams& operator=(const Streams&) = delete;

  void replace(int stream, int descriptor) {
    ::posix_spawn_file_actions_adddup2(&actions_, descriptor, stream);
  }
  void close_input() {
    ::posix_spawn_file_actions_addopen(&actions_, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  }
  [[nodiscard]] const posix_spawn_file_actions_t* actions() const { return &actions_; }

 private:
  posix_spawn_file_actions_t actions_{};
};

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, CloseFile>;

// Errors go into a file, so that only one stream has to be read while the child runs.
std::string beginning_of(std::FILE* file) {
  std::array<char, 4096> buffer{};
  std::rewind(file);
  return {buffer.data(), std::fread(buffer.data(), 1, buffer.size(), file)};
}

// False when there was more.
bool read_all(int descriptor, std::string& text, std::size_t limit) {
  std::array<char, 65536> buffer{};
  while (true) {
    const ssize_t count = ::read(descriptor, buffer.data(), buffer.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) fail(errno, "cannot read what a program prints");
    if (count == 0) return true;
    text.append(buffer.data(), static_cast<std::size_t>(count));
    if (text.size() > limit) return false;
  }
}

int end_of(pid_t process) {
  int status = 0;
  while (::waitpid(process, &status, 0) < 0) {
    if (errno != EINTR) fail(errno, "cannot wait for a program");
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

}  // namespace

ChildOutput run_child(const std::vector<std::string>& words, std::size_t limit) {
  std::vector<std::string> copies = words;
  std::vector<char*> arguments;
  for (std::string& word : copies) arguments.push_back(word.data());
  arguments.push_back(nullptr);

  const File errors(std::tmpfile());
  std::array<int, 2> ends{};
  if (!errors || ::pipe2(ends.data(), O_CLOEXEC) != 0) fail(errno, "cannot start " + words[0]);
  Descriptor reading(ends[0]);
  Descriptor writing(ends[1]);
  Streams streams;
  streams.close_input();
  streams.replace(STDOUT_FILENO, writing.number());
  streams.replace(STDERR_FILENO, ::fileno(errors.get()));
  pid_t process = -1;
  const int code =
      ::posix_spawnp(&process, arguments[0], streams.actions(), nullptr, arguments.data(), environ);
  if (code != 0) fail(code, "cannot start " + words[0]);
  writing.close();

  ChildOutput output;
  output.is_cut = !read_all(reading.number(), output.out, limit);
  if (output.is_cut) ::kill(process, SIGKILL);
  output.status = end_of(process);
  output.err = beginning_of(errors.get());
  return output;
}

}  // namespace robdef
