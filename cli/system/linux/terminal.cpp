// SPDX-License-Identifier: Apache-2.0
#include "cli/system/terminal.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <filesystem>

namespace robdef::system {
namespace {

class SilentTerminal {
 public:
  SilentTerminal() : descriptor_(::open("/dev/tty", O_RDWR | O_CLOEXEC)) {
    if (descriptor_ < 0) return;
    is_there_ = ::tcgetattr(descriptor_, &before_) == 0;
    if (!is_there_) return;
    termios silent = before_;
    silent.c_lflag &= ~static_cast<tcflag_t>(ECHO);
    ::tcsetattr(descriptor_, TCSAFLUSH, &silent);
  }
  ~SilentTerminal() {
    if (is_there_) ::tcsetattr(descriptor_, TCSAFLUSH, &before_);
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  SilentTerminal(const SilentTerminal&) = delete;
  SilentTerminal& operator=(const SilentTerminal&) = delete;

  [[nodiscard]] bool is_there() const { return is_there_; }
  void print(const std::string& text) const {
    // A user who does not see the question can still answer it.
    if (::write(descriptor_, text.data(), text.size()) < 0) return;
  }
  [[nodiscard]] std::string read_line() const {
    std::string line;
    char letter = 0;
    while (::read(descriptor_, &letter, 1) == 1 && letter != '\n') line += letter;
    return line;
  }

 private:
  int descriptor_;
  bool is_there_ = false;
  termios before_{};
};

}  // namespace

bool writes_to_terminal() { return ::isatty(STDOUT_FILENO) == 1; }
bool reads_from_terminal() { return ::isatty(STDIN_FILENO) == 1; }

std::optional<std::string> ask_silently(const std::string& question) {
  const SilentTerminal terminal;
  if (!terminal.is_there()) return std::nullopt;
  terminal.print(question + ": ");
  std::string answer = terminal.read_line();
  terminal.print("\n");
  return answer;
}

std::optional<std::string> line_from_descriptor(int descriptor) {
  std::string line;
  for (char letter = 0;;) {
    const ssize_t size = ::read(descriptor, &letter, 1);
    if (size < 0) return std::nullopt;
    if (size == 0 || letter == '\n') return line;
    line += letter;
  }
}

void open_in_browser(const std::string& address) {
  const bool has_display =
      std::getenv("DISPLAY") != nullptr || std::getenv("WAYLAND_DISPLAY") != nullptr;
  if (!has_display) return;
  std::string program = "xdg-open";
  std::string copy = address;
  std::array<char*, 3> arguments{program.data(), copy.data(), nullptr};
  pid_t child = 0;
  if (posix_spawnp(&child, "xdg-open", nullptr, nullptr, arguments.data(), environ) == 0) {
    int status = 0;
    waitpid(child, &status, 0);  // it hands on to the browser, and ends
  }
}

std::string make_temporary_file() {
  std::string pattern = (std::filesystem::temp_directory_path() / "robdef-XXXXXX").string();
  const int file = ::mkstemp(pattern.data());
  if (file < 0) return "";
  ::close(file);
  return pattern;
}

}  // namespace robdef::system
