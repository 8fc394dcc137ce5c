// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/platform/local_socket.hpp"

#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <optional>
#include <utility>

#include "runtime/cpp/src/platform/linux/system_calls.hpp"

namespace rr::platform {
namespace {

constexpr int backlog = 1024;
// The user's group too, as far as the folder lets it in: who may connect is asked again.
constexpr mode_t mode = 0770;

Descriptor open_socket() {
  return Descriptor(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
}

// A socket that a node of this user has left behind: nobody answers there. Anything else is not
// ours to remove.
bool is_dead(const std::string& path, const Address& address) {
  struct stat found {};
  if (lstat(path.c_str(), &found) != 0 || !S_ISSOCK(found.st_mode) || found.st_uid != geteuid()) {
    return false;
  }
  const Descriptor socket = open_socket();
  return ::connect(socket.get(), system(address), address.size) != 0 && errno == ECONNREFUSED;
}

}  // namespace

PlacedSocket::PlacedSocket(std::string path, bool may_replace, std::error_code& error)
    : path_(std::move(path)) {
  const auto address = local_socket_address(path_);
  if (!address) {
    error = std::make_error_code(std::errc::filename_too_long);
    return;
  }
  Descriptor socket = open_socket();
  int result = socket ? ::bind(socket.get(), system(*address), address->size) : -1;
  if (result != 0 && errno == EADDRINUSE && may_replace) {
    if (is_dead(path_, *address)) {
      ::unlink(path_.c_str());
      result = ::bind(socket.get(), system(*address), address->size);
    } else {
      errno = EADDRINUSE;
    }
  }
  if (result != 0) {
    error = last_error();
    return;
  }
  // Before it listens, so that nobody comes in whom the mask would have let.
  const bool is_open_to_group = ::chmod(path_.c_str(), mode) == 0;
  place_ = place_at(path_);
  if (!is_open_to_group || ::listen(socket.get(), backlog) != 0) {
    error = last_error();
    remove();
    return;
  }
  socket_ = std::move(socket);
}

std::optional<PlacedSocket::Place> PlacedSocket::place_at(const std::string& path) {
  struct stat found {};
  if (::lstat(path.c_str(), &found) != 0) return std::nullopt;
  return Place{found.st_dev, found.st_ino,
               std::int64_t{found.st_ctim.tv_sec} * 1'000'000'000 + found.st_ctim.tv_nsec};
}

void PlacedSocket::remove() const {
  const auto found = place_at(path_);
  if (found && found == place_) ::unlink(path_.c_str());
}

}  // namespace rr::platform
