// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/node/testing/test_channel.hpp"

#include <unistd.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <mutex>
#include <utility>

#include "rr/authority.hpp"

namespace rr::testing {
namespace {

class Folder {
 public:
  Folder() {
    // Short: paths of local sockets have 107 bytes.
    const std::string name = "rr-" + NodeId::random().text().substr(0, 8);
    const auto folder = std::filesystem::temp_directory_path() / name;
    if (!std::filesystem::create_directory(folder)) return;
    std::filesystem::permissions(folder, std::filesystem::perms::owner_all);
    path_ = folder.string();
  }
  ~Folder() {
    std::error_code error;
    if (!path_.empty() && owner_ == getpid()) std::filesystem::remove_all(path_, error);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  [[nodiscard]] const std::string& path() const { return path_; }

 private:
  std::string path_;
  const pid_t owner_ = getpid();
};

void add_certificate(NodeOptions& options) {
  static std::mutex mutex;
  const std::lock_guard lock(mutex);
  const std::string folder = test_folder() + "/ca";
  if (!std::filesystem::exists(folder)) Authority::create(folder);
  Authority authority(folder);
  if (options.id.is_any()) options.id = NodeId::random();
  options.tls.certificate_file = authority.issue(options.id);
  options.tls.authority_files = {authority.certificate_file()};
}

}  // namespace

std::string test_channel() {
  const char* const name = std::getenv("ROBDEF_TEST_CHANNEL");
  return name == nullptr ? "tcp" : name;
}

std::string test_folder() {
  static const Folder folder;
  return folder.path();
}

NodeOptions with_channel(NodeOptions options, const std::string& channel) {
  if (channel == "local" || channel == "shm") {
    options.local.user_run_dir = test_folder() + "/run";
    options.local.shared_memory = channel == "shm";
  }
  if (channel == "tls" || channel == "wss") add_certificate(options);
  return options;
}

std::string listen_by_channel(Node& node, std::uint16_t& port, const std::string& channel) {
  const std::string who = "nodeid=" + node.id().text() + "&";
  if (channel == "local" || channel == "shm" || channel == "intra") {
    const std::string scheme = channel == "shm" ? "rr+local" : "rr+" + channel;
    node.listen(scheme + "://");
    return scheme + ":///?" + who;
  }
  port = node.listen_tcp(0, "127.0.0.1");
  const std::string place = "://127.0.0.1:" + std::to_string(port) + "/?";
  if (channel == "tls") return "rrs+tcp" + place;
  return "rr+" + channel + place;
}

}  // namespace rr::testing
