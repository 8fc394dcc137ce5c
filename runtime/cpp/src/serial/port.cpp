// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/serial/port.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "rr/error.hpp"

namespace rr::serial {
namespace {

constexpr std::pair<std::uint32_t, speed_t> rates[] = {
    {9600, B9600},     {19200, B19200},    {38400, B38400},   {57600, B57600},
    {115200, B115200}, {230400, B230400},  {460800, B460800}, {500000, B500000},
    {921600, B921600}, {1000000, B1000000}};

speed_t speed_of(std::uint32_t baud) {
  for (const auto& [rate, speed] : rates) {
    if (rate == baud) return speed;
  }
  throw Error(ErrorCode::invalid_argument,
              "serial ports have no rate of " + std::to_string(baud) + " baud");
}

std::string reason(int error) {
  switch (error) {
    case EBUSY:
    case EWOULDBLOCK:
      return "is in use, by another program or another part of this one";
    case ENOENT:
    case ENXIO:
    case ENODEV:
      return "does not exist";
    case ENOTTY:
      return "is no serial port";
    default:
      return std::string("cannot be opened: ") + std::strerror(error);
  }
}

}  // namespace

void Port::check_rate(std::uint32_t baud) { (void)speed_of(baud); }

Port::Port(std::string path, std::uint32_t baud)
    : path_(std::move(path)), baud_(baud), wake_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  if (wake_ < 0) throw Error(ErrorCode::system_resource_error, "no event descriptor is free");
}

Port::~Port() {
  close();
  ::close(wake_);
}

std::string Port::open() {
  close();
  port_ = ::open(path_.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (port_ < 0) return reason(errno);
  const auto give_up = [this] {
    const int error = errno;
    close();
    return reason(error);
  };
  // Two who read one line would each get half of the answers. The lock is for those who ask for it,
  // as we do; TIOCEXCL is for all others but those of root.
  if (::flock(port_, LOCK_EX | LOCK_NB) != 0) return give_up();
  termios settings{};
  if (::tcgetattr(port_, &settings) != 0) return give_up();
  (void)::ioctl(port_, TIOCEXCL);
  ::cfmakeraw(&settings);
  settings.c_cflag |= CLOCAL | CREAD;
  settings.c_cflag &= ~static_cast<tcflag_t>(CSTOPB | CRTSCTS);
  ::cfsetispeed(&settings, speed_of(baud_));
  ::cfsetospeed(&settings, speed_of(baud_));
  if (::tcsetattr(port_, TCSANOW, &settings) != 0) return give_up();
  ::tcflush(port_, TCIOFLUSH);
  return {};
}

void Port::close() {
  if (port_ < 0) return;
  // Whoever else has it open keeps it so.
  (void)::ioctl(port_, TIOCNXCL);
  ::close(port_);
  port_ = -1;
}

void Port::wake() const {
  const std::uint64_t one = 1;
  (void)!::write(wake_, &one, sizeof one);
}

std::optional<std::vector<std::uint8_t>> Port::read(std::chrono::microseconds limit) {
  pollfd waits[] = {{wake_, POLLIN, 0}, {port_, POLLIN, 0}};
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
  const ssize_t got = ::read(port_, bytes.data(), bytes.size());
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
    const ssize_t sent = ::write(port_, bytes.data(), bytes.size());
    if (sent > 0) {
      bytes = bytes.subspan(static_cast<std::size_t>(sent));
      continue;
    }
    if (sent < 0 && errno == EINTR) continue;
    if (sent < 0 && errno == EAGAIN) {
      // The line is slower than we are. What a port does not take for a second is lost, and sent
      // again like everything that is.
      pollfd waits{port_, POLLOUT, 0};
      if (::poll(&waits, 1, 1000) == 0) return true;
      continue;
    }
    close();
    return false;
  }
  return true;
}

}  // namespace rr::serial
