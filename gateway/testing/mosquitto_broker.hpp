// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <optional>
#include <string>

#include "gateway/testing/folder.hpp"
#include "gateway/testing/program.hpp"
#include "gateway/testing/waiting.hpp"
#include "rr/node.hpp"

namespace rr::gateway::testing {

/// A file of users and passwords for `password_file`, of lines `user:password`.
inline std::string make_passwords(const Folder& folder, const std::string& lines) {
  const std::string path = folder.path() + "/passwords";
  std::ofstream(path) << lines;
  if (!exited_with(Program({"mosquitto_passwd", "-U", path}).wait(), 0)) {
    throw std::runtime_error("no passwords were made");
  }
  return path;
}

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

/// A real broker at a free port of this machine, which keeps nothing on disk.
class MosquittoBroker {
 public:
  /// Empty when it is not installed.
  static std::string program() {
    for (const char* path : {"/usr/sbin/mosquitto", "/usr/local/sbin/mosquitto"}) {
      if (std::filesystem::exists(path)) return path;
    }
    return {};
  }

  explicit MosquittoBroker(const std::string& configuration = "allow_anonymous true\n")
      : port_(free_port()) {
    std::ofstream(folder_.path() + "/mosquitto.conf")
        << "listener " << port_ << " 127.0.0.1\n"
        << configuration << "persistence false\nlog_dest none\nuser root\n";
    start();
  }

  /// Returns when it takes connections.
  void start() {
    process_.emplace(std::vector<std::string>{program(), "-c", folder_.path() + "/mosquitto.conf"});
    if (!comes_true([&] { return listens(port_); })) throw std::runtime_error("no broker");
  }
  void kill() { process_->end(SIGKILL); }
  [[nodiscard]] std::string url(const std::string& scheme = "mqtt") const {
    return scheme + "://127.0.0.1:" + std::to_string(port_);
  }

 private:
  static int free_port() {
    Node node;
    return node.listen_tcp(0);
  }

  Folder folder_;
  int port_;
  std::optional<Program> process_;
};

}  // namespace rr::gateway::testing
