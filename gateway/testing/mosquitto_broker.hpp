// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "gateway/testing/real_broker.hpp"

namespace rr::gateway::testing {

/// Mosquitto, which keeps nothing on disk.
class MosquittoBroker final : public RealBroker {
 public:
  /// Empty when it is not installed.
  static std::string program() {
    for (const char* path : {"/usr/sbin/mosquitto", "/usr/local/sbin/mosquitto"}) {
      if (std::filesystem::exists(path)) return path;
    }
    return {};
  }

  void configure(const BrokerSetup& setup) override {
    std::ofstream file(path("mosquitto.conf"));
    file << "listener " << port() << " 127.0.0.1\npersistence false\nlog_dest none\nuser root\n"
         << "allow_anonymous "
         << (setup.users.empty() && setup.client_authority.empty() ? "true" : "false") << "\n";
    if (!setup.users.empty()) {
      write_passwords(setup);
      file << "password_file " << path("passwords") << "\n";
    }
    if (!setup.access_list.empty()) {
      std::ofstream(path("acl")) << setup.access_list;
      file << "acl_file " << path("acl") << "\n";
    }
    if (!setup.certificate.empty()) {
      file << "certfile " << setup.certificate << "\nkeyfile " << setup.certificate << "\n";
    }
    if (!setup.client_authority.empty()) {
      file << "require_certificate true\nuse_identity_as_username true\ncafile "
           << setup.client_authority << "\n";
    }
    file << setup.more;
  }
  [[nodiscard]] std::string url(bool is_encrypted) const override {
    return (is_encrypted ? "mqtts://127.0.0.1:" : "mqtt://127.0.0.1:") + std::to_string(port());
  }

 private:
  [[nodiscard]] std::vector<std::string> command() const override {
    return {program(), "-c", path("mosquitto.conf")};
  }
  void write_passwords(const BrokerSetup& setup) const {
    std::ofstream file(path("passwords"));
    for (const auto& [user, password] : setup.users) file << user << ":" << password << "\n";
    file.close();
    if (!exited_with(Program({"mosquitto_passwd", "-U", path("passwords")}).wait(), 0)) {
      throw std::runtime_error("no passwords were made");
    }
  }
};

}  // namespace rr::gateway::testing
