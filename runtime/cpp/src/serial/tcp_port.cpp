// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/serial/tcp_port.hpp"

#include <array>
#include <charconv>
#include <chrono>
#include <system_error>
#include <vector>

#include "rr/error.hpp"
#include "runtime/cpp/src/platform/ready.hpp"
#include "runtime/cpp/src/platform/waiting.hpp"

namespace rr::serial {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr std::string_view scheme = "tcp://";
/// For all addresses of a name together.
constexpr auto connect_patience = 3s;
/// What a board does not take for so long is lost.
constexpr auto send_patience = 1s;

std::string connect_reason(const std::error_code& error) {
  if (error == std::errc::connection_refused) return "refuses connections";
  if (error == std::errc::timed_out) return "does not answer";
  return "cannot be connected to: " + error.message();
}

}  // namespace

bool is_tcp_place(std::string_view path) { return path.starts_with(scheme); }

TcpPort::TcpPort(const std::string& path) : Port(path) {
  const std::string rest = path.substr(scheme.size());
  std::string port;
  const std::size_t colon = rest.rfind(':');
  if (colon != std::string::npos) {
    host_ = rest.substr(0, colon);
    port = rest.substr(colon + 1);
  }
  if (host_.size() > 2 && host_.front() == '[' && host_.back() == ']') {
    host_ = host_.substr(1, host_.size() - 2);
  } else if (host_.find(':') != std::string::npos) {
    host_.clear();
  }
  const char* const end = port.data() + port.size();
  const auto [at, error] = std::from_chars(port.data(), end, number_);
  if (host_.empty() || number_ == 0 || error != std::errc() || at != end) {
    throw Error(ErrorCode::invalid_argument,
                "`" + path + "` is no place over TCP, as `tcp://192.168.1.20:4000`");
  }
  if (platform::make_pair(ringing_, ringer_)) {
    throw Error(ErrorCode::system_resource_error, "no socket is free");
  }
}

void TcpPort::wake() const {
  constexpr std::byte mark{0};
  (void)platform::send(ringer_.get(), {&mark, 1});
}

// Whether the socket has one of these. Ends early for wake().
bool TcpPort::wait(std::uint32_t events, platform::Time deadline) {
  std::array<platform::Awaited, 2> waits{
      {{ringing_.get(), platform::ready::input}, {is_open() ? socket_.get() : -1, events}}};
  if (!platform::wait_for_any(waits, deadline)) return false;
  if (waits[0].found != 0) {
    std::array<std::byte, 64> marks;
    (void)platform::receive(ringing_.get(), marks, platform::Wait::none);
  }
  return waits[1].found != 0;
}

std::error_code TcpPort::finish_connecting(platform::Time deadline,
                                           const std::function<bool()>& is_over) {
  while (!is_over()) {
    if (Clock::now() >= deadline) return std::make_error_code(std::errc::timed_out);
    if (wait(platform::ready::room, deadline)) return platform::connect_result(socket_.get());
  }
  return std::make_error_code(std::errc::operation_canceled);
}

std::string TcpPort::open(const std::function<bool()>& is_over) {
  std::vector<platform::Address> addresses = platform::look_up(host_, platform::LookUp::all);
  if (addresses.empty()) return "cannot be found: no machine has this name";
  const auto deadline = Clock::now() + connect_patience;
  std::error_code error;
  for (platform::Address& address : addresses) {
    address.set_port(number_);
    error.clear();
    const auto connecting = platform::begin_connect(address, socket_, error);
    if (connecting == platform::Connecting::begun) error = finish_connecting(deadline, is_over);
    if (!error) {
      // A frame is short and waited for.
      platform::set_stream_options(socket_.get());
      return {};
    }
    close();
  }
  return connect_reason(error);
}

std::ptrdiff_t TcpPort::receive(std::span<std::byte> room, platform::Time deadline) {
  if (!wait(platform::ready::input, deadline)) return platform::nothing_now;
  const std::ptrdiff_t got = platform::receive(socket_.get(), room, platform::Wait::none);
  return got == 0 ? platform::broken : got;
}

bool TcpPort::send(std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const std::ptrdiff_t sent = platform::send(socket_.get(), bytes);
    if (sent == platform::broken) return false;
    if (sent > 0) {
      bytes = bytes.subspan(static_cast<std::size_t>(sent));
    } else if (!platform::wait_for(socket_.get(), platform::ready::room,
                                   Clock::now() + send_patience)) {
      return true;
    }
  }
  return true;
}

}  // namespace rr::serial
