// SPDX-License-Identifier: Apache-2.0
#include "compiler/driver/live/connection.hpp"

#include <fcntl.h>
#include <termios.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <rr/error.hpp>
#include <rr/serial.hpp>
#include <utility>

namespace robdef::live {
namespace {

std::string first_line(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::string line;
  if (!file || (!std::getline(file, line) && !file.eof())) {
    throw rr::Error(rr::ErrorCode::io_error, "the password cannot be read from `" + path + "`");
  }
  if (line.ends_with('\r')) line.pop_back();
  return line;
}

// The terminal of the program, whatever its standard streams are; it shows nothing of what is
// typed.
class SilentTerminal {
 public:
  SilentTerminal() : descriptor_(::open("/dev/tty", O_RDWR | O_CLOEXEC)) {
    if (descriptor_ < 0 || ::tcgetattr(descriptor_, &before_) != 0) {
      if (descriptor_ >= 0) ::close(descriptor_);
      throw rr::Error(
          rr::ErrorCode::authentication_error,
          "no password: give `--password-file`, or set " + std::string(password_variable));
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

std::string ask_password(const std::string& user) {
  const SilentTerminal terminal;
  terminal.print("password of " + user + ": ");
  std::string password = terminal.read_line();
  terminal.print("\n");
  return password;
}

std::string password_of(const LiveOptions& options) {
  if (!options.password_file.empty()) return first_line(options.password_file);
  if (const char* const value = std::getenv(password_variable)) return value;
  return ask_password(options.user);
}

}  // namespace

rr::NodeOptions node_options(const LiveOptions& options) {
  rr::NodeOptions result;
  result.channels.emplace("rr+serial", rr::serial_channel());
  if (options.timeout) result.request_timeout = result.connect_timeout = *options.timeout;
  return result;
}

std::map<std::string, rr::VarValue> credentials_of(const LiveOptions& options) {
  if (options.user.empty()) return {};
  return {{"password", rr::VarValue(password_of(options))}};
}

Connection::Connection(const LiveOptions& options, std::string url,
                       std::function<void(const rr::Error&)> on_closed)
    : url_(std::move(url)), node_(node_options(options)) {
  options_.username = options.user;
  options_.credentials = credentials_of(options);
  options_.on_closed = std::move(on_closed);
  connect();
}

void Connection::connect() { client_ = rr::dynamic::connect(node_, url_, options_); }

}  // namespace robdef::live
