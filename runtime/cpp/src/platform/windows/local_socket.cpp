// SPDX-License-Identifier: Apache-2.0
// Windows has local sockets since version 10 (1803). A socket's file is of nobody else than who may
// write to its folder.
#include "runtime/cpp/src/platform/local_socket.hpp"

#include "system_sockets.hpp"
// After it:
#include <windows.h>

#include <utility>

#include "errors.hpp"
#include "opened_socket.hpp"
#include "runtime/cpp/src/platform/files.hpp"

namespace rr::platform {
namespace {

constexpr int backlog = 1024;

bool bind_to(const Descriptor& socket, const Address& address) {
  return ::bind(static_cast<SOCKET>(socket.get()),
                reinterpret_cast<const sockaddr*>(address.bytes.data()),
                static_cast<int>(address.size)) == 0;
}

// A socket of this user that nobody listens at any more. Connecting to one is refused at once.
bool is_dead(const std::string& path, const Address& address) {
  const DWORD found = GetFileAttributesW(wide(path).c_str());
  if (found == INVALID_FILE_ATTRIBUTES || (found & FILE_ATTRIBUTE_REPARSE_POINT) == 0) return false;
  if (owner_of(path) != current_user()) return false;
  Descriptor socket;
  std::error_code error;
  return begin_connect(address, socket, error) == Connecting::failed &&
         error == std::errc::connection_refused;
}

}  // namespace

PlacedSocket::PlacedSocket(std::string path, bool may_replace, std::error_code& error)
    : path_(std::move(path)) {
  const auto address = local_socket_address(path_);
  if (!address) {
    error = std::make_error_code(std::errc::filename_too_long);
    return;
  }
  Descriptor socket = open_socket(AF_UNIX, SOCK_STREAM);
  bool is_bound = socket && bind_to(socket, *address);
  if (!is_bound && socket && may_replace && is_dead(path_, *address)) {
    remove_file(path_);
    is_bound = bind_to(socket, *address);
  }
  if (!is_bound || ::listen(static_cast<SOCKET>(socket.get()), backlog) != 0) {
    error = last_socket_error();
    return;
  }
  place_ = place_at(path_);
  socket_ = std::move(socket);
}

std::optional<PlacedSocket::Place> PlacedSocket::place_at(const std::string& path) {
  const FileState found = state_of(path);
  if (found.size < 0) return std::nullopt;
  return Place{found.device, found.number, found.changed};
}

void PlacedSocket::remove() const {
  const auto found = place_at(path_);
  if (found && found == place_) remove_file(path_);
}

}  // namespace rr::platform
