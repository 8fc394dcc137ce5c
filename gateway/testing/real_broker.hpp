// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "gateway/testing/folder.hpp"
#include "gateway/testing/program.hpp"
#include "gateway/testing/waiting.hpp"
#include "rr/node.hpp"

namespace rr::gateway::testing {

/// What a broker of a test is to do.
struct BrokerSetup {
  std::map<std::string, std::string>
      users{};                     ///< with their passwords; none: everybody may connect
  std::string access_list{};       ///< for these users, as the program prints it; empty: all rights
  std::string certificate{};       ///< PEM file with its key: TLS
  std::string client_authority{};  ///< of certificates that clients need; empty: they need none
  std::string more{};              ///< lines for its configuration
};

/// Whether a program of this machine takes connections at a port.
inline bool listens(int port) {
  const int descriptor = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  const int result =
      ::connect(descriptor, reinterpret_cast<const sockaddr*>(&address), sizeof address);
  ::close(descriptor);
  return result == 0;
}

/// A real broker at a free port of this machine.
class RealBroker {
 public:
  RealBroker() : port_(free_port()) {}
  virtual ~RealBroker() = default;
  RealBroker(const RealBroker&) = delete;
  RealBroker& operator=(const RealBroker&) = delete;

  /// For the next start().
  virtual void configure(const BrokerSetup& setup) = 0;
  /// Without TLS, or with it.
  [[nodiscard]] virtual std::string url(bool is_encrypted = false) const = 0;

  /// Returns when it takes connections.
  void start() {
    process_.emplace(command());
    if (!comes_true([&] { return listens(port_); })) throw std::runtime_error("no broker");
  }
  void kill() { process_->end(SIGKILL); }

 protected:
  [[nodiscard]] virtual std::vector<std::string> command() const = 0;
  [[nodiscard]] int port() const { return port_; }
  static int free_port() {
    Node node;
    return node.listen_tcp(0);
  }
  [[nodiscard]] std::string path(const std::string& name) const {
    return folder_.path() + "/" + name;
  }

 private:
  Folder folder_;
  int port_;
  std::optional<Program> process_;
};

}  // namespace rr::gateway::testing
