// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/channel/tcp_listener.hpp"

#include <netinet/in.h>
#include <sys/socket.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "rr/error.hpp"
#include "runtime/cpp/src/channel/tls.hpp"

namespace rr::channel {
namespace {

// The port that URLs without a port mean belongs to a helper that shares it (04, section 1).
constexpr std::uint16_t shared_port = 48653;
constexpr int backlog = 1024;

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
  Descriptor shared;  // kept, so that it is not given again
  for (int attempt = 1;; ++attempt) {
    std::vector<Descriptor> sockets;
    std::uint16_t port = wanted_port;
    int error = 0;
    for (Address& address : addresses) {
      address.set_port(port);
      Descriptor socket = open_listening(address);
      if (socket) {
        port = local_address(socket.get()).port();
        if (port == shared_port) {
          shared = std::move(socket);
          error = EADDRINUSE;
          break;
        }
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
    if (attempt == attempts) {
      throw Error(ErrorCode::connection_error, "there is no free port to listen at");
    }
  }
}

}  // namespace

TcpListener::TcpListener(const ChannelContext& context, const Url& url,
                         const AcceptHandler& accept) {
  if (url.port == shared_port) {
    throw Error(ErrorCode::invalid_argument,
                "port 48653 is reserved for a port sharer; choose another, or 0 for any");
  }
  LinkTerms terms = tcp_terms(*context.options);
  if (context.options->web_socket.is_enabled) terms.web_sockets = context.web_sockets;
  terms.tls = context.tls;
  terms.is_tls_required = context.options->tls.is_required;
  if (terms.is_tls_required && (!terms.tls || !terms.tls->has_certificate())) {
    throw Error(ErrorCode::invalid_configuration,
                "TLS is required of clients, and the node has no certificate");
  }
  if (!terms.is_tls_required) schemes_.emplace_back("rr+tcp");
  if (terms.tls && terms.tls->has_certificate()) schemes_.emplace_back("rrs+tcp");
  for (Descriptor& socket : open_all(resolve_for_listening(url.host, url.port), url.port)) {
    ports_.push_back(std::make_shared<ListeningSocket>(context, std::move(socket), terms, accept));
  }
  if (ports_.empty()) {
    throw Error(ErrorCode::connection_error,
                "there is no address to listen at for `" + url.host + "`");
  }
  for (const auto& each : ports_) each->start();
}

TcpListener::~TcpListener() {
  for (const auto& port : ports_) port->stop();
}

std::vector<std::string> TcpListener::urls() const {
  std::vector<std::string> result;
  for (const auto& port : ports_) {
    for (const std::string& scheme : schemes_) {
      result.push_back(scheme + "://" + port->address().text());
    }
  }
  return result;
}

}  // namespace rr::channel
