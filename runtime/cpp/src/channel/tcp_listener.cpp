// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/channel/tcp_listener.hpp"

#include <netinet/in.h>
#include <sys/epoll.h>
#include <sys/socket.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "rr/error.hpp"
#include "runtime/cpp/src/channel/stream_connection.hpp"

namespace rr::channel {
namespace {

// The port that URLs without a port mean belongs to a helper that shares it (04, section 1).
constexpr std::uint16_t shared_port = 48653;
constexpr int backlog = 1024;
// After a failure to accept, for want of descriptors, it is tried again.
constexpr Milliseconds accept_pause{100};

// Returns nothing, with errno, when it cannot listen there.
Descriptor open_listening(const Address& address) {
  Descriptor socket(::socket(address.family(), SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  if (!socket) return {};
  const int on = 1;
  setsockopt(socket.get(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  if (address.family() == AF_INET6) {
    setsockopt(socket.get(), IPPROTO_IPV6, IPV6_V6ONLY, &on, sizeof on);
  }
  if (bind(socket.get(), reinterpret_cast<const sockaddr*>(&address.storage), address.size) != 0 ||
      ::listen(socket.get(), backlog) != 0) {
    const int error = errno;
    socket = Descriptor();
    errno = error;
    return {};
  }
  return socket;
}

// One socket for each address, all on one port. Throws rr::Error.
std::vector<Descriptor> open_all(std::vector<Address> addresses, std::uint16_t wanted_port) {
  constexpr int attempts = 10;
  for (int attempt = 1;; ++attempt) {
    std::vector<Descriptor> sockets;
    std::uint16_t port = wanted_port;
    int error = 0;
    for (Address& address : addresses) {
      address.set_port(port);
      Descriptor socket = open_listening(address);
      if (socket) {
        port = local_address(socket.get()).port();
        sockets.push_back(std::move(socket));
        continue;
      }
      // A machine may lack a family.
      if (address.family() == AF_INET6 && (errno == EAFNOSUPPORT || errno == EADDRNOTAVAIL))
        continue;
      error = errno;
      // A port that is free for one family need not be so for the other.
      if (error == EADDRINUSE && wanted_port == 0 && attempt < attempts) break;
      throw Error(ErrorCode::connection_error,
                  "cannot listen at " + address.text() + ": " + std::strerror(error));
    }
    if (error == 0) return sockets;
  }
}

}  // namespace

class TcpListener::Port final : public Pollable,
                                public Timer,
                                public std::enable_shared_from_this<Port> {
 public:
  Port(Ground ground, Descriptor socket, AcceptHandler accept)
      : ground_(std::move(ground)), socket_(std::move(socket)), accept_(std::move(accept)) {}
  ~Port() { ground_.reactor->cancel(*this); }

  void start() { ground_.reactor->add(socket_.get(), EPOLLIN, *this); }
  void stop() {
    is_stopped_ = true;
    ground_.reactor->remove(socket_.get());
    ::shutdown(socket_.get(), SHUT_RDWR);  // nobody can connect from now on
    ground_.reactor->retire(shared_from_this());
  }
  [[nodiscard]] Address address() const { return local_address(socket_.get()); }

  void on_ready(std::uint32_t /*events*/) override {
    while (!is_stopped_) {
      Descriptor accepted(accept4(socket_.get(), nullptr, nullptr, SOCK_CLOEXEC));
      if (accepted) {
        take(std::move(accepted));
        continue;
      }
      if (errno == EINTR || errno == ECONNABORTED) continue;
      if (errno != EAGAIN && errno != EWOULDBLOCK && !is_stopped_) {
        ground_.reactor->schedule(*this, weak_from_this(), Clock::now() + accept_pause);
      }
      return;
    }
  }

 private:
  void on_timer() override {
    ground_.reactor->post([self = shared_from_this()] { self->on_ready(EPOLLIN); });
  }

  void take(Descriptor accepted) {
    if (!ground_.accepted->add()) return;
    auto connection = std::make_shared<StreamConnection>(
        StreamConnection::Role::server, std::move(accepted), ground_.reactor, ground_.options);
    connection->set_on_gone([count = ground_.accepted](StreamConnection&) { count->remove(); });
    try {
      connection->start(accept_(connection));
    } catch (const std::exception& error) {
      connection->close(Error(ErrorCode::connection_error, error.what()));
    }
  }

  const Ground ground_;
  const Descriptor socket_;
  const AcceptHandler accept_;
  std::atomic<bool> is_stopped_{false};
};

TcpListener::TcpListener(Ground ground, const Url& url, AcceptHandler accept)
    : reactor_(ground.reactor) {
  if (url.port == shared_port) {
    throw Error(ErrorCode::invalid_argument,
                "port 48653 is reserved for a port sharer; choose another, or 0 for any");
  }
  for (Descriptor& socket : open_all(resolve_for_listening(url.host, url.port), url.port)) {
    ports_.push_back(std::make_shared<Port>(ground, std::move(socket), accept));
  }
  if (ports_.empty()) {
    throw Error(ErrorCode::connection_error,
                "there is no address to listen at for `" + url.host + "`");
  }
  for (const std::shared_ptr<Port>& each : ports_) each->start();
}

TcpListener::~TcpListener() {
  for (const std::shared_ptr<Port>& port : ports_) port->stop();
}

std::vector<std::string> TcpListener::urls() const {
  std::vector<std::string> result;
  for (const std::shared_ptr<Port>& port : ports_) {
    result.push_back("rr+tcp://" + port->address().text());
  }
  return result;
}

}  // namespace rr::channel
