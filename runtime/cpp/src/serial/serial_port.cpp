// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/serial/serial_port.hpp"

#include <fcntl.h>
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

std::string port_reason(int error) {
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

void SerialPort::check_rate(std::uint32_t baud) { (void)speed_of(baud); }

SerialPort::SerialPort(const std::string& path, std::uint32_t baud) : Port(path), baud_(baud) {
  check_rate(baud);
}

SerialPort::~SerialPort() { SerialPort::close(); }

std::string SerialPort::open_file(const std::function<bool()>& /*is_over*/) {
  file_ = ::open(path().c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (file_ < 0) return port_reason(errno);
  // Two who read one line would each get half of the answers. The lock is for those who ask for it,
  // as we do; TIOCEXCL is for all others but those of root.
  if (::flock(file_, LOCK_EX | LOCK_NB) != 0) return port_reason(errno);
  termios settings{};
  if (::tcgetattr(file_, &settings) != 0) return port_reason(errno);
  (void)::ioctl(file_, TIOCEXCL);
  ::cfmakeraw(&settings);
  settings.c_cflag |= CLOCAL | CREAD;
  settings.c_cflag &= ~static_cast<tcflag_t>(CSTOPB | CRTSCTS);
  ::cfsetispeed(&settings, speed_of(baud_));
  ::cfsetospeed(&settings, speed_of(baud_));
  if (::tcsetattr(file_, TCSANOW, &settings) != 0) return port_reason(errno);
  ::tcflush(file_, TCIOFLUSH);
  return {};
}

void SerialPort::close() {
  // Whoever else has it open keeps it so.
  if (is_open()) (void)::ioctl(file_, TIOCNXCL);
  Port::close();
}

std::ptrdiff_t SerialPort::put(std::span<const std::uint8_t> bytes) {
  return ::write(file_, bytes.data(), bytes.size());
}

}  // namespace rr::serial
