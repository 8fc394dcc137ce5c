// SPDX-License-Identifier: Apache-2.0
// Pairs of nodes in a build without TLS and files of Linux: by TCP or web sockets.
#include <cstdlib>
#include <filesystem>
#include <string>

#include "runtime/cpp/src/node/testing/test_channel.hpp"

namespace rr::testing {

std::string test_channel() {
  const char* const name = std::getenv("ROBDEF_TEST_CHANNEL");
  return name == nullptr ? "tcp" : name;
}

std::string test_folder() { return std::filesystem::temp_directory_path().string(); }

NodeOptions with_channel(NodeOptions options, const std::string& /*channel*/) { return options; }

std::string listen_by_channel(Node& node, std::uint16_t& port, const std::string& channel) {
  port = node.listen_tcp(0, "127.0.0.1");
  return "rr+" + channel + "://127.0.0.1:" + std::to_string(port) + "/?";
}

}  // namespace rr::testing
