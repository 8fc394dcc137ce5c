// SPDX-License-Identifier: Apache-2.0
#include "cli/secret_words.hpp"

#include <fcntl.h>
#include <termios.h>
#include <unistd.h>

#include <charconv>
#include <fstream>
#include <optional>
#include <rr/error.hpp>
#include <string_view>
#include <utility>

namespace robdef {
namespace {

class SilentTerminal {
 public:
  explicit SilentTerminal(const std::string& otherwise)
      : descriptor_(::open("/dev/tty", O_RDWR | O_CLOEXEC)) {
    if (descriptor_ < 0 || ::tcgetattr(descriptor_, &before_) != 0) {
      if (descriptor_ >= 0) ::close(descriptor_);
      throw rr::Error(rr::ErrorCode::authentication_error, otherwise);
    }
    termios silent = before_;
    silent.c_lflag &= ~static_cast<tcflag_t>(ECHO);
    ::tcsetattr(descriptor_, TCSAFLUSH, &silent);
  }
  ~SilentTerminal() {
    ::tcsetattr(descriptor_, TCSAFLUSH, &before_);
    ::close(descriptor_);
  }
  SilentTerminal(const SilentTerminal&) = delete;
  SilentTerminal& operator=(const SilentTerminal&) = delete;

  void print(const std::string& text) const {
    // Whoever does not see the question can still answer it.
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
  termios before_{};
};

}  // namespace

namespace {

// Of `/dev/fd/N`: opening that name would ask for the right to read the file, which whoever has
// opened it for this program had, and the program need not have.
std::optional<int> descriptor_in(std::string_view path) {
  constexpr std::string_view folder = "/dev/fd/";
  if (!path.starts_with(folder)) return std::nullopt;
  path.remove_prefix(folder.size());
  int number = -1;
  const auto read = std::from_chars(path.data(), path.data() + path.size(), number);
  if (read.ec != std::errc() || read.ptr != path.data() + path.size()) return std::nullopt;
  return number;
}

// Up to the end of a line, or of what is there. Nothing when it cannot be read.
std::optional<std::string> line_from(int descriptor) {
  std::string line;
  for (char letter = 0;;) {
    const ssize_t size = ::read(descriptor, &letter, 1);
    if (size < 0) return std::nullopt;
    if (size == 0 || letter == '\n') return line;
    line += letter;
  }
}

std::optional<std::string> line_of_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::string line;
  if (!file || (!std::getline(file, line) && !file.eof())) return std::nullopt;
  return line;
}

}  // namespace

std::string first_line(const std::string& path) {
  const auto descriptor = descriptor_in(path);
  auto line = descriptor ? line_from(*descriptor) : line_of_file(path);
  if (!line) {
    throw rr::Error(rr::ErrorCode::io_error, "the password cannot be read from `" + path + "`");
  }
  if (line->ends_with('\r')) line->pop_back();
  return std::move(*line);
}

std::string ask_silently(const std::string& question, const std::string& otherwise) {
  const SilentTerminal terminal(otherwise);
  terminal.print(question + ": ");
  std::string answer = terminal.read_line();
  terminal.print("\n");
  return answer;
}

}  // namespace robdef
