// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

namespace rr::testing {

/// Gives a page to browsers of this machine, one request at a time, and hears what the page asks
/// for.
class PageServer {
 public:
  explicit PageServer(std::string page)
      : page_(std::move(page)), socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    static_cast<void>(::bind(socket_, reinterpret_cast<const sockaddr*>(&address), size));
    ::listen(socket_, 16);
    ::getsockname(socket_, reinterpret_cast<sockaddr*>(&address), &size);
    port_ = ntohs(address.sin_port);
    thread_ = std::thread([this] { serve(); });
  }
  ~PageServer() {
    is_over_ = true;
    thread_.join();
    ::close(socket_);
  }
  PageServer(const PageServer&) = delete;
  PageServer& operator=(const PageServer&) = delete;

  [[nodiscard]] std::uint16_t port() const { return port_; }
  /// What followed `prefix` in a request; waits a minute at most. Empty when none came.
  std::string wait_for(std::string_view prefix) {
    std::unique_lock lock(mutex_);
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::minutes(1);
    while (true) {
      for (const std::string& target : asked_) {
        if (target.starts_with(prefix)) return target.substr(prefix.size());
      }
      if (changed_.wait_until(lock, deadline) == std::cv_status::timeout) return {};
    }
  }

 private:
  void serve() {
    while (!is_over_) {
      pollfd wanted{socket_, POLLIN, 0};
      if (::poll(&wanted, 1, 50) <= 0) continue;
      const int client = ::accept4(socket_, nullptr, nullptr, SOCK_CLOEXEC);
      answer(client);
      ::close(client);
    }
  }
  void answer(int client) {
    std::string request;
    std::array<char, 4096> bytes{};
    pollfd wanted{client, POLLIN, 0};
    // Browsers open connections beforehand, and say nothing.
    while (request.find("\r\n\r\n") == std::string::npos && ::poll(&wanted, 1, 200) > 0) {
      const ssize_t size = ::recv(client, bytes.data(), bytes.size(), 0);
      if (size <= 0) return;
      request.append(bytes.data(), static_cast<std::size_t>(size));
    }
    const std::size_t begin = request.find(' ');
    const std::size_t end = request.find(' ', begin + 1);
    if (!request.starts_with("GET ") || end == std::string::npos) return;
    const std::string target = request.substr(begin + 1, end - begin - 1);
    const bool is_page = target.starts_with("/?");
    const std::string body = is_page ? page_ : std::string();
    const std::string reply = std::string("HTTP/1.1 ") + (is_page ? "200 OK" : "204 No Content") +
                              "\r\nContent-Type: text/html\r\nConnection: close\r\n"
                              "Content-Length: " +
                              std::to_string(body.size()) + "\r\n\r\n" + body;
    [[maybe_unused]] const ssize_t sent = ::send(client, reply.data(), reply.size(), MSG_NOSIGNAL);
    const std::lock_guard lock(mutex_);
    asked_.push_back(target);
    changed_.notify_all();
  }

  const std::string page_;
  const int socket_;
  std::uint16_t port_ = 0;
  std::atomic<bool> is_over_{false};
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<std::string> asked_;
  std::thread thread_;
};

}  // namespace rr::testing
