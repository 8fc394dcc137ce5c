// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "gateway/testing/real_broker.hpp"

namespace rr::gateway::testing {

/// A server of NATS, with JetStream unless it is to have none, which keeps its files from start to
/// start.
class NatsServer final : public RealBroker {
 public:
  /// Empty when it is not installed.
  static std::string program() {
    for (const char* path : {"/usr/sbin/nats-server", "/usr/local/bin/nats-server"}) {
      if (std::filesystem::exists(path)) return path;
    }
    return {};
  }

  /// `more` are lines of its configuration.
  explicit NatsServer(std::string more = "", bool has_stream = true)
      : more_(std::move(more)), has_stream_(has_stream) {}

  /// Port for the other servers of a cluster.
  [[nodiscard]] int route_port() const { return route_port_; }
  /// Makes it one of a cluster from the next configure() on; `routes` are ports of all its servers.
  void join(const std::vector<int>& routes) {
    more_ = "server_name: \"s" + std::to_string(route_port_) +
            "\"\ncluster { name: test, listen: \"127.0.0.1:" + std::to_string(route_port_) +
            "\", routes: [";
    std::string list;
    for (const int port : routes) {
      list += (list.empty() ? "\"nats://127.0.0.1:" : ", \"nats://127.0.0.1:") +
              std::to_string(port) + "\"";
    }
    more_ += list + "] }\n";
  }

  void configure(const BrokerSetup& setup) override {
    std::ofstream file(path("nats.conf"));
    file << "listen: \"127.0.0.1:" << port() << "\"\nlog_file: \"" << path("log") << "\"\n"
         << more_;
    if (has_stream_) file << "jetstream { store_dir: \"" << path("store") << "\" }\n";
    if (!setup.access_list.empty()) {
      std::ofstream passwords(path("passwords.conf"));
      for (const auto& [user, password] : setup.users) {
        passwords << "password_" << user << ": \"" << password << "\"\n";
      }
      std::ofstream(path("users.conf")) << setup.access_list;
      file << "include users.conf\n";
    } else if (!setup.users.empty()) {
      file << "authorization {\n  users: [\n";
      for (const auto& [user, password] : setup.users) {
        file << "    {user: \"" << user << "\", password: \"" << password << "\"}\n";
      }
      file << "  ]\n}\n";
    }
    if (setup.certificate.empty()) return;
    file << "tls {\n  cert_file: \"" << setup.certificate << "\"\n  key_file: \""
         << setup.certificate << "\"\n";
    if (!setup.client_authority.empty()) {
      file << "  ca_file: \"" << setup.client_authority << "\"\n  verify: true\n";
    }
    file << "}\n";
  }
  [[nodiscard]] std::string url(bool is_encrypted) const override {
    return (is_encrypted ? "tls://127.0.0.1:" : "nats://127.0.0.1:") + std::to_string(port());
  }

 private:
  [[nodiscard]] std::vector<std::string> command() const override {
    return {program(), "-c", path("nats.conf")};
  }

  std::string more_;
  bool has_stream_;
  int route_port_ = free_port();
};

}  // namespace rr::gateway::testing
