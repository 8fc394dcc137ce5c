// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/platform/serial_port.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <iterator>

#include "rr/error.hpp"
#include "runtime/cpp/src/platform/sockets.hpp"

namespace rr::platform {
namespace {

constexpr std::array<speed_t, std::size(serial_rates)> speeds = {
    B9600, B19200, B38400, B57600, B115200, B230400, B460800, B500000, B921600, B1000000};

speed_t speed_of(std::uint32_t baud) {
  const auto* const found = std::find(std::begin(serial_rates), std::end(serial_rates), baud);
  if (found == std::end(serial_rates)) return B0;
  return speeds[static_cast<std::size_t>(std::distance(serial_rates, found))];
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

/// Empty when it is done.
std::string set_up(int file, std::uint32_t baud) {
  // Two who read one line would each get half of the answers. The lock is for those who ask for it,
  // as we do; TIOCEXCL, at the end, is for all others but those of root.
  if (::flock(file, LOCK_EX | LOCK_NB) != 0) return reason(errno);
  termios settings{};
  if (::tcgetattr(file, &settings) != 0) return reason(errno);
  ::cfmakeraw(&settings);
  settings.c_cflag |= CLOCAL | CREAD;
  settings.c_cflag &= ~static_cast<tcflag_t>(CSTOPB | CRTSCTS);
  ::cfsetispeed(&settings, speed_of(baud));
  ::cfsetospeed(&settings, speed_of(baud));
  if (::tcsetattr(file, TCSANOW, &settings) != 0) return reason(errno);
  ::tcflush(file, TCIOFLUSH);
  (void)::ioctl(file, TIOCEXCL);
  return {};
}

}  // namespace

std::optional<std::string> serial_port_name(const std::string& path) {
  if (path.empty()) return std::nullopt;
  return path;
}

const char* serial_port_example() { return "/dev/ttyUSB0"; }

struct SerialPort::System {
  int file = -1;
  int wake = -1;
};

SerialPort::SerialPort() : system_(new System) {
  system_->wake = ::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
  if (system_->wake < 0) {
    throw Error(ErrorCode::system_resource_error, "no event descriptor is free");
  }
}

SerialPort::~SerialPort() {
  close();
  ::close(system_->wake);
}

bool SerialPort::is_open() const { return system_->file >= 0; }

std::string SerialPort::open(const std::string& name, std::uint32_t baud) {
  close();
  system_->file = ::open(name.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (!is_open()) return reason(errno);
  std::string why = set_up(system_->file, baud);
  if (!why.empty()) {
    // Another program may have it: it keeps what it has set.
    ::close(system_->file);
    system_->file = -1;
  }
  return why;
}

void SerialPort::close() {
  if (!is_open()) return;
  // Whoever else has it open keeps it so.
  (void)::ioctl(system_->file, TIOCNXCL);
  ::close(system_->file);
  system_->file = -1;
}

std::ptrdiff_t SerialPort::receive(std::span<std::byte> room, Time deadline) {
  pollfd waits[] = {{system_->wake, POLLIN, 0}, {system_->file, POLLIN, 0}};
  const auto left =
      std::chrono::ceil<std::chrono::milliseconds>(deadline - std::chrono::steady_clock::now());
  const auto milliseconds = std::clamp<std::int64_t>(left.count(), 0, 1'000'000'000);
  if (::poll(waits, is_open() ? 2 : 1, static_cast<int>(milliseconds)) <= 0) return nothing_now;
  if (waits[0].revents != 0) {
    std::uint64_t times = 0;
    (void)!::read(system_->wake, &times, sizeof times);
  }
  if (!is_open() || waits[1].revents == 0) return nothing_now;
  const ssize_t got = ::read(system_->file, room.data(), room.size());
  if (got > 0) return got;
  return got < 0 && (errno == EAGAIN || errno == EINTR) ? nothing_now : broken;
}

bool SerialPort::send(std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t sent = ::write(system_->file, bytes.data(), bytes.size());
    if (sent > 0) {
      bytes = bytes.subspan(static_cast<std::size_t>(sent));
    } else if (sent < 0 && errno == EAGAIN) {
      // The line is slower than we are.
      pollfd room{system_->file, POLLOUT, 0};
      if (::poll(&room, 1, 1000) == 0) return true;
    } else if (sent == 0 || errno != EINTR) {
      return false;
    }
  }
  return true;
}

void SerialPort::wake() const {
  const std::uint64_t one = 1;
  (void)!::write(system_->wake, &one, sizeof one);
}

}  // namespace rr::platform
