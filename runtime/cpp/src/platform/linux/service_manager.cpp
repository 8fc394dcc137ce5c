// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/platform/service_manager.hpp"

#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <charconv>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <string>

namespace rr::platform {
namespace {

// The value of a variable as a number; `none` when it has none.
std::uint64_t number_of(const char* variable, std::uint64_t none) {
  const char* const text = std::getenv(variable);
  if (text == nullptr) return none;
  std::uint64_t number = 0;
  const char* const end = text + std::strlen(text);
  const auto [at, error] = std::from_chars(text, end, number);
  return error == std::errc() && at == end ? number : none;
}

}  // namespace

// The socket's name is a path, or `@` for one outside of the file system.
bool notify_service_manager(std::string_view lines) {
  const char* const name = std::getenv("NOTIFY_SOCKET");
  if (name == nullptr || (name[0] != '/' && name[0] != '@')) return false;
  sockaddr_un address{};
  const std::size_t size = std::strlen(name);
  if (size >= sizeof address.sun_path) return false;
  address.sun_family = AF_UNIX;
  std::memcpy(address.sun_path, name, size);
  if (name[0] == '@') address.sun_path[0] = '\0';
  const int socket = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (socket < 0) return false;
  const auto length = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + size);
  const ssize_t sent = ::sendto(socket, lines.data(), lines.size(), MSG_NOSIGNAL | MSG_DONTWAIT,
                                reinterpret_cast<const sockaddr*>(&address), length);
  ::close(socket);
  return sent == static_cast<ssize_t>(lines.size());
}

std::chrono::microseconds watchdog_period() {
  const auto own = static_cast<std::uint64_t>(::getpid());
  if (number_of("WATCHDOG_PID", own) != own) return {};
  constexpr std::uint64_t longest = 24ULL * 3600 * 1'000'000;  // more is no watchdog
  const std::uint64_t period = number_of("WATCHDOG_USEC", 0);
  return period <= longest ? std::chrono::microseconds(period) : std::chrono::microseconds();
}

// `device:inode` of the stream that systemd has made.
bool is_stderr_the_journal() {
  const char* const named = std::getenv("JOURNAL_STREAM");
  struct stat state {};
  if (named == nullptr || ::fstat(STDERR_FILENO, &state) != 0) return false;
  return named == std::to_string(state.st_dev) + ":" + std::to_string(state.st_ino);
}

}  // namespace rr::platform
