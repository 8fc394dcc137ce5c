// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/serial/serial_port.hpp"

#include <algorithm>
#include <iterator>
#include <optional>

#include "rr/error.hpp"

namespace rr::serial {

SerialPort::SerialPort(const std::string& path, std::uint32_t baud)
    : Port(name_of(path)), baud_(baud) {
  const auto& rates = platform::serial_rates;
  if (std::find(std::begin(rates), std::end(rates), baud) == std::end(rates)) {
    throw Error(ErrorCode::invalid_argument,
                "serial ports have no rate of " + std::to_string(baud) + " baud");
  }
}

std::string SerialPort::name_of(const std::string& path) {
  std::optional<std::string> name = platform::serial_port_name(path);
  if (!name) {
    throw Error(ErrorCode::invalid_argument, "`" + path + "` is no name of a serial port, as `" +
                                                 platform::serial_port_example() + "`");
  }
  return *std::move(name);
}

std::string SerialPort::open(const std::function<bool()>& /*is_over*/) {
  return port_.open(path(), baud_);
}

std::ptrdiff_t SerialPort::receive(std::span<std::byte> room, platform::Time deadline) {
  return port_.receive(room, deadline);
}

}  // namespace rr::serial
