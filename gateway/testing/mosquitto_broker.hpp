// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <fstream>
#include <memory>
#include <string>

#include "gateway/testing/folder.hpp"
#include "gateway/testing/process.hpp"
#include "rr/node.hpp"

namespace rr::gateway::testing {

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

  void start() {
    process_ = std::make_unique<Process>(
        std::vector<std::string>{program(), "-c", folder_.path() + "/mosquitto.conf"});
  }
  void kill() { process_->end(SIGKILL); }
  [[nodiscard]] std::string url() const { return "mqtt://127.0.0.1:" + std::to_string(port_); }

 private:
  static int free_port() {
    Node node;
    return node.listen_tcp(0);
  }

  Folder folder_;
  int port_;
  std::unique_ptr<Process> process_;
};

}  // namespace rr::gateway::testing
