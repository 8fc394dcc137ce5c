// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/serial/port.hpp"

#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <cerrno>
#include <utility>

#include "rr/error.hpp"
#include "runtime/cpp/src/serial/serial_port.hpp"
#include "runtime/cpp/src/serial/tcp_port.hpp"

namespace rr::serial {

std::unique_ptr<Port> Port::to(const std::string& path, std::uint32_t baud) {
  if (is_tcp_place(path)) return std::make_unique<TcpPort>(path);
  return std::make_unique<SerialPort>(path, baud);
}

Port::Port(std::string path)
    : wake_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)), path_(std::move(path)) {
  if (wake_ < 0) throw Error(ErrorCode::system_resource_error, "no event descriptor is free");
}

Port::~Port() {
  if (file_ >= 0) ::close(file_);
  ::close(wake_);
}

std::string Port::open(const std::function<bool()>& is_over) {
  close();
  std::string why = open_file(is_over);
  if (!why.empty()) close();
  return why;
}

void Port::close() {
  if (file_ < 0) return;
  ::close(file_);
  file_ = -1;
}

void Port::wake() const {
  const std::uint64_t one = 1;
  (void)!::write(wake_, &one, sizeof one);
}

std::optional<std::vector<std::uint8_t>> Port::read(std::chrono::microseconds limit) {
  pollfd waits[] = {{wake_, POLLIN, 0}, {file_, POLLIN, 0}};
  const auto milliseconds = std::chrono::ceil<std::chrono::milliseconds>(limit);
  const int count = ::poll(waits, is_open() ? 2 : 1, static_cast<int>(milliseconds.count()));
  std::vector<std::uint8_t> bytes;
  if (count <= 0) return bytes;
  if (waits[0].revents != 0) {
    std::uint64_t times = 0;
    (void)!::read(wake_, &times, sizeof times);
  }
  if (!is_open() || waits[1].revents == 0) return bytes;
  bytes.resize(512);
  const ssize_t got = ::read(file_, bytes.data(), bytes.size());
  if (got > 0) {
    bytes.resize(static_cast<std::size_t>(got));
    return bytes;
  }
  if (got < 0 && (errno == EAGAIN || errno == EINTR)) return std::vector<std::uint8_t>();
  close();
  return std::nullopt;
}

bool Port::write(std::span<const std::uint8_t> bytes) {
  while (!bytes.empty()) {
    const std::ptrdiff_t sent = put(bytes);
    if (sent > 0) {
      bytes = bytes.subspan(static_cast<std::size_t>(sent));
      continue;
    }
    if (sent < 0 && errno == EINTR) continue;
    if (sent < 0 && errno == EAGAIN) {
      // The line is slower than we are. What a port does not take for a second is lost, and sent
      // again like everything that is.
      pollfd waits{file_, POLLOUT, 0};
      if (::poll(&waits, 1, 1000) == 0) return true;
      continue;
    }
    close();
    return false;
  }
  return true;
}

}  // namespace rr::serial
