// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/stress/socket_cutter.hpp"

#include <sys/socket.h>

#include <filesystem>
#include <mutex>

namespace rr::stress {
namespace {

// Calls `function(descriptor, name)` for each socket of this process.
template <class Function>
void for_each_socket(const Function& function) {
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd", error)) {
    const std::string name = std::filesystem::read_symlink(entry.path(), error).string();
    if (!error && name.starts_with("socket:")) {
      function(std::stoi(entry.path().filename().string()), name);
    }
  }
}

}  // namespace

void SocketCutter::connect(const std::function<void()>& connecting) {
  const std::shared_lock lock(mutex_);
  connecting();
}

SocketCutter::Socket SocketCutter::connect_and_find(const std::function<void()>& connecting) {
  const std::unique_lock lock(mutex_);
  const std::set<Socket> before = sockets();
  connecting();
  for (const Socket& one : sockets()) {
    if (!before.contains(one)) return one;
  }
  return {};
}

void SocketCutter::cut(const Socket& socket, bool resets) {
  const std::unique_lock lock(mutex_);
  for_each_socket([&](int descriptor, const std::string& name) {
    if (name != socket) return;
    const linger at_once{1, 0};
    if (resets) ::setsockopt(descriptor, SOL_SOCKET, SO_LINGER, &at_once, sizeof at_once);
    ::shutdown(descriptor, SHUT_RDWR);
  });
}

std::set<SocketCutter::Socket> SocketCutter::sockets() {
  std::set<Socket> found;
  for_each_socket([&](int, const std::string& name) { found.insert(name); });
  return found;
}

}  // namespace rr::stress
