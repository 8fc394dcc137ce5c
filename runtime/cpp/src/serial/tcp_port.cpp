// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/serial/tcp_port.hpp"

#include <fcntl.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <chrono>
#include <cstring>
#include <memory>

#include "rr/error.hpp"

namespace rr::serial {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr std::string_view scheme = "tcp://";
/// For all addresses of a name together.
constexpr auto connect_patience = 3s;

std::string connect_reason(int error) {
  switch (error) {
    case ECONNREFUSED:
      return "refuses connections";
    case ETIMEDOUT:
      return "does not answer";
    default:
      return std::string("cannot be connected to: ") + std::strerror(error);
  }
}

/// Connects a socket that does not wait. The error, or 0.
int finish_connecting(int file, int wake, Clock::time_point deadline,
                      const std::function<bool()>& is_over) {
  while (!is_over()) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - Clock::now());
    if (left <= 0ms) return ETIMEDOUT;
    pollfd waits[] = {{file, POLLOUT, 0}, {wake, POLLIN, 0}};
    const int count = ::poll(waits, 2, static_cast<int>(left.count()));
    if (count < 0 && errno != EINTR) return errno;
    if (waits[0].revents != 0) {
      int error = 0;
      socklen_t size = sizeof error;
      if (::getsockopt(file, SOL_SOCKET, SO_ERROR, &error, &size) != 0) return errno;
      return error;
    }
    if (waits[1].revents != 0) {
      std::uint64_t times = 0;
      (void)!::read(wake, &times, sizeof times);
    }
  }
  return ECANCELED;
}

}  // namespace

bool is_tcp_place(std::string_view path) { return path.starts_with(scheme); }

TcpPort::TcpPort(const std::string& path) : Port(path) {
  const std::string rest = path.substr(scheme.size());
  const std::size_t colon = rest.rfind(':');
  if (colon != std::string::npos) {
    host_ = rest.substr(0, colon);
    port_ = rest.substr(colon + 1);
  }
  if (host_.size() > 2 && host_.front() == '[' && host_.back() == ']') {
    host_ = host_.substr(1, host_.size() - 2);
  } else if (host_.find(':') != std::string::npos) {
    host_.clear();
  }
  std::uint16_t number = 0;
  const char* const end = port_.data() + port_.size();
  const auto [at, error] = std::from_chars(port_.data(), end, number);
  if (host_.empty() || number == 0 || error != std::errc() || at != end) {
    throw Error(ErrorCode::invalid_argument,
                "`" + path + "` is no place over TCP, as `tcp://192.168.1.20:4000`");
  }
}

std::string TcpPort::open_file(const std::function<bool()>& is_over) {
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  const int status = ::getaddrinfo(host_.c_str(), port_.c_str(), &hints, &found);
  if (status != 0) return std::string("cannot be found: ") + ::gai_strerror(status);
  const std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)> addresses(found, &::freeaddrinfo);
  const auto deadline = Clock::now() + connect_patience;
  int error = 0;
  for (const addrinfo* one = found; one != nullptr; one = one->ai_next) {
    close();
    file_ = ::socket(one->ai_family, one->ai_socktype | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    if (file_ < 0) {
      error = errno;
      continue;
    }
    error = ::connect(file_, one->ai_addr, one->ai_addrlen) == 0 ? 0 : errno;
    if (error == EINPROGRESS) error = finish_connecting(file_, wake_, deadline, is_over);
    if (error == 0) {
      // A frame is short and waited for.
      const int on = 1;
      (void)::setsockopt(file_, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
      return {};
    }
  }
  return connect_reason(error);
}

std::ptrdiff_t TcpPort::put(std::span<const std::uint8_t> bytes) {
  return ::send(file_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
}

}  // namespace rr::serial
