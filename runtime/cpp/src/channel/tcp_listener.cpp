// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/channel/tcp_listener.hpp"

#include <system_error>
#include <utility>

#include "rr/error.hpp"
#include "runtime/cpp/src/channel/tls.hpp"

namespace rr::channel {
namespace {

// The port that URLs without a port mean belongs to a helper that shares it (04, section 1).
constexpr std::uint16_t shared_port = 48653;

// One socket for each address, all on one port. Throws rr::Error.
std::vector<Descriptor> open_all(std::vector<Address> addresses, std::uint16_t wanted_port) {
  constexpr int attempts = 10;
  Descriptor shared;  // kept, so that it is not given again
  for (int attempt = 1;; ++attempt) {
    std::vector<Descriptor> sockets;
    std::uint16_t port = wanted_port;
    std::error_code error;
    for (Address& address : addresses) {
      address.set_port(port);
      std::error_code failure;
      Descriptor socket = platform::listen_at(address, failure);
      if (socket) {
        port = platform::local_address(socket.get()).port();
        if (port == shared_port) {
          shared = std::move(socket);
          error = std::make_error_code(std::errc::address_in_use);
          break;
        }
        sockets.push_back(std::move(socket));
        continue;
      }
      // A machine may lack a family.
      if (address.family() == Family::v6 && (failure == std::errc::address_family_not_supported ||
                                             failure == std::errc::address_not_available)) {
        continue;
      }
      error = failure;
      // A port that is free for one family need not be so for the other.
      if (error == std::errc::address_in_use && wanted_port == 0 && attempt < attempts) break;
      throw Error(ErrorCode::connection_error,
                  "cannot listen at " + address.text() + ": " + error.message());
    }
    if (!error) return sockets;
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
