// SPDX-License-Identifier: Apache-2.0
#include <WiFi.h>
#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <deque>

struct WiFiClient::Connection {
  explicit Connection(int opened) : file(opened) {}
  ~Connection() { ::close(file); }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  void fill() {
    std::uint8_t bytes[256];
    const ssize_t got = ::recv(file, bytes, sizeof bytes, MSG_DONTWAIT);
    if (got > 0) received.insert(received.end(), bytes, bytes + got);
    if (got == 0 || (got < 0 && errno != EAGAIN && errno != EINTR)) is_over = true;
  }

  const int file;
  std::deque<std::uint8_t> received{};
  bool is_over = false;
};

WiFiClient::WiFiClient(int file) : connection_(std::make_shared<Connection>(file)) {}

bool WiFiClient::connected() {
  if (!connection_) return false;
  connection_->fill();
  return !connection_->is_over || !connection_->received.empty();
}

int WiFiClient::available() {
  if (!connection_) return 0;
  if (connection_->received.empty()) connection_->fill();
  return static_cast<int>(connection_->received.size());
}

int WiFiClient::peek() { return available() == 0 ? -1 : connection_->received.front(); }

int WiFiClient::read() {
  const int byte = peek();
  if (byte >= 0) connection_->received.pop_front();
  return byte;
}

std::size_t WiFiClient::write(const std::uint8_t* bytes, std::size_t count) {
  if (!connection_) return 0;
  const ssize_t sent = ::send(connection_->file, bytes, count, MSG_NOSIGNAL | MSG_DONTWAIT);
  return sent > 0 ? static_cast<std::size_t>(sent) : 0;
}

WiFiServer::~WiFiServer() {
  if (file_ >= 0) ::close(file_);
}

void WiFiServer::begin() {
  file_ = ::socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  const int on = 1;
  (void)::setsockopt(file_, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port_);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  if (::bind(file_, reinterpret_cast<sockaddr*>(&address), size) != 0 || ::listen(file_, 4) != 0 ||
      ::getsockname(file_, reinterpret_cast<sockaddr*>(&address), &size) != 0) {
    std::perror("the board cannot listen");
    std::exit(1);
  }
  port_ = ntohs(address.sin_port);
}

WiFiClient WiFiServer::accept() {
  const int file = ::accept4(file_, nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC);
  if (file < 0) return {};
  const int on = 1;
  (void)::setsockopt(file, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
  return WiFiClient(file);
}
