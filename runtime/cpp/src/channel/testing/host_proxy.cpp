// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/channel/testing/host_proxy.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <openssl/ssl.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <stdexcept>

#include "runtime/cpp/src/channel/certificate.hpp"

namespace rr::testing {
namespace {

using SessionPtr = std::unique_ptr<SSL, channel::Releases<SSL_free>>;
constexpr int pause_ms = 20;

sockaddr_in loopback(std::uint16_t port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  return address;
}

int connect_to(std::uint16_t port) {
  const int descriptor = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const sockaddr_in address = loopback(port);
  static_cast<void>(
      ::connect(descriptor, reinterpret_cast<const sockaddr*>(&address), sizeof address));
  return descriptor;
}

}  // namespace

void make_host_certificate(const std::string& file) {
  const std::string command =
      "openssl req -x509 -newkey ec -pkeyopt ec_paramgen_curve:P-256 -nodes -days 2"
      " -subj /CN=localhost -addext subjectAltName=DNS:localhost,IP:127.0.0.1"
      " -keyout " +
      file + ".key -out " + file + " 2>/dev/null && cat " + file + ".key >> " + file;
  if (std::system(command.c_str()) != 0) throw std::runtime_error("no certificate was made");
}

struct HostProxy::Context {
  channel::ContextPtr tls{SSL_CTX_new(TLS_server_method())};
};

HostProxy::HostProxy(const std::string& certificate_file, std::uint16_t target)
    : context_(std::make_unique<Context>()), target_(target) {
  SSL_CTX* const tls = context_->tls.get();
  if (SSL_CTX_use_certificate_chain_file(tls, certificate_file.c_str()) != 1 ||
      SSL_CTX_use_PrivateKey_file(tls, certificate_file.c_str(), SSL_FILETYPE_PEM) != 1) {
    throw std::runtime_error("the certificate cannot be used");
  }
  listening_ = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address = loopback(0);
  socklen_t size = sizeof address;
  static_cast<void>(::bind(listening_, reinterpret_cast<const sockaddr*>(&address), size));
  ::listen(listening_, 8);
  ::getsockname(listening_, reinterpret_cast<sockaddr*>(&address), &size);
  port_ = ntohs(address.sin_port);
  thread_ = std::thread([this] { serve(); });
}

HostProxy::~HostProxy() {
  is_ended_ = true;
  thread_.join();
  ::close(listening_);
}

void HostProxy::serve() {
  while (!is_ended_) {
    pollfd wanted{listening_, POLLIN, 0};
    if (::poll(&wanted, 1, pause_ms) <= 0) continue;
    const int descriptor = ::accept4(listening_, nullptr, nullptr, SOCK_CLOEXEC);
    const timeval limit{5, 0};
    ::setsockopt(descriptor, SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof limit);
    pass(descriptor);
    ::close(descriptor);
  }
}

void HostProxy::pass(int descriptor) {
  const SessionPtr session(SSL_new(context_->tls.get()));
  SSL_set_fd(session.get(), descriptor);
  if (SSL_accept(session.get()) != 1) return;
  const int inside = connect_to(target_);
  std::array<char, 16 * 1024> bytes{};
  bool goes_on = true;
  while (goes_on && !is_ended_) {
    std::array<pollfd, 2> wanted{{{descriptor, POLLIN, 0}, {inside, POLLIN, 0}}};
    if (SSL_pending(session.get()) == 0 && ::poll(wanted.data(), 2, pause_ms) <= 0) continue;
    if (wanted[0].revents != 0 || SSL_pending(session.get()) != 0) {
      const int size = SSL_read(session.get(), bytes.data(), bytes.size());
      goes_on = size > 0 &&
                ::send(inside, bytes.data(), static_cast<std::size_t>(size), MSG_NOSIGNAL) == size;
    } else {
      const ssize_t size = ::recv(inside, bytes.data(), bytes.size(), 0);
      goes_on = size > 0 && SSL_write(session.get(), bytes.data(), static_cast<int>(size)) > 0;
    }
  }
  ::close(inside);
}

}  // namespace rr::testing
