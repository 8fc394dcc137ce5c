// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <list>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace rr::gateway::testing {

/// A TCP link to a port of this machine. While it stands still it carries nothing, and connections
/// stay.
class Relay {
 public:
  explicit Relay(int target) : target_(target), listening_(listen_at_free_port()) {
    thread_ = std::thread([this] { run(); });
  }
  ~Relay() {
    ends_ = true;
    thread_.join();
    for (const Pipe& pipe : pipes_) close_both(pipe);
    ::close(listening_);
  }
  Relay(const Relay&) = delete;
  Relay& operator=(const Relay&) = delete;

  /// The URL of a server behind the relay, by the server's own.
  [[nodiscard]] std::string url(const std::string& url) const {
    return url.substr(0, url.rfind(':') + 1) + std::to_string(port_);
  }
  /// Returns when nothing is carried any more.
  void stand_still(bool is_still) {
    is_still_ = is_still;
    const std::uint64_t round = rounds_;
    while (rounds_ < round + 2) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }

 private:
  static constexpr int round_time_ms = 5;

  /// A connection, and what waits for each side. Few bytes, so that a link that stands still blocks
  /// its writers soon.
  struct Pipe {
    std::array<int, 2> sides;
    std::array<std::vector<char>, 2> waiting{};
  };

  static sockaddr_in local(int port) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    return address;
  }
  static void close_both(const Pipe& pipe) {
    for (const int side : pipe.sides) ::close(side);
  }

  int listen_at_free_port() {
    const int descriptor = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    sockaddr_in address = local(0);
    socklen_t size = sizeof address;
    if (::bind(descriptor, reinterpret_cast<sockaddr*>(&address), size) != 0 ||
        ::listen(descriptor, 16) != 0 ||
        ::getsockname(descriptor, reinterpret_cast<sockaddr*>(&address), &size) != 0) {
      throw std::runtime_error("no port for a relay");
    }
    port_ = ntohs(address.sin_port);
    return descriptor;
  }

  void run() {
    while (!ends_) {
      std::vector<pollfd> wanted{{listening_, POLLIN, 0}};
      for (const Pipe& pipe : pipes_) {
        for (std::size_t i = 0; i < 2; ++i) wanted.push_back({pipe.sides[i], events(pipe, i), 0});
      }
      // Without connections while it stands still: only the time passes.
      ::poll(wanted.data(), is_still_ ? 0 : wanted.size(), round_time_ms);
      if (!is_still_) carry();
      ++rounds_;
    }
  }
  static short events(const Pipe& pipe, std::size_t side) {
    const bool may_read = pipe.waiting[1 - side].empty();
    const bool has_more = !pipe.waiting[side].empty();
    return static_cast<short>((may_read ? POLLIN : 0) | (has_more ? POLLOUT : 0));
  }

  void carry() {
    accept_one();
    for (auto pipe = pipes_.begin(); pipe != pipes_.end();) {
      if (carry(*pipe, 0) && carry(*pipe, 1)) {
        ++pipe;
      } else {
        close_both(*pipe);
        pipe = pipes_.erase(pipe);
      }
    }
  }
  void accept_one() {
    const int from = ::accept4(listening_, nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK);
    if (from < 0) return;
    const int to = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    const sockaddr_in address = local(target_);
    if (::connect(to, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
      ::close(to);
      ::close(from);
      return;
    }
    const int yes = 1;
    for (const int side : {from, to}) {
      ::setsockopt(side, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
    }
    pipes_.push_back({{from, to}});
  }
  /// From one side to the other. False when the connection has ended.
  static bool carry(Pipe& pipe, std::size_t from) {
    std::vector<char>& waiting = pipe.waiting[1 - from];
    if (waiting.empty()) {
      waiting.resize(4096);
      const ssize_t got = ::recv(pipe.sides[from], waiting.data(), waiting.size(), MSG_DONTWAIT);
      waiting.resize(got > 0 ? static_cast<std::size_t>(got) : 0);
      if (got == 0 || (got < 0 && errno != EAGAIN && errno != EINTR)) return false;
    }
    if (waiting.empty()) return true;
    const ssize_t sent =
        ::send(pipe.sides[1 - from], waiting.data(), waiting.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
    if (sent < 0) return errno == EAGAIN || errno == EINTR;
    waiting.erase(waiting.begin(), waiting.begin() + sent);
    return true;
  }

  const int target_;
  int port_ = 0;  // before listening_, which sets it
  const int listening_;
  std::atomic<bool> is_still_{false};
  std::atomic<bool> ends_{false};
  std::atomic<std::uint64_t> rounds_{0};
  std::list<Pipe> pipes_;  // of the thread
  std::thread thread_;
};

}  // namespace rr::gateway::testing
