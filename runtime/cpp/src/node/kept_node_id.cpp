// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/node/kept_node_id.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <system_error>

#include "rr/error.hpp"
#include "rr/url.hpp"
#include "runtime/cpp/src/platform/trusted_folder.hpp"
#include "runtime/cpp/src/platform/users.hpp"

namespace rr {
namespace {

namespace fs = std::filesystem;

constexpr std::streamsize longest_id = 256;

// The text in a file without the blanks around it; nothing when it cannot be read.
std::optional<std::string> read_trimmed(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) return std::nullopt;
  std::string text(static_cast<std::size_t>(longest_id), '\0');
  stream.read(text.data(), longest_id);
  text.resize(static_cast<std::size_t>(stream.gcount()));
  constexpr const char* blanks = " \t\r\n\v\f";
  text.erase(0, std::min(text.find_first_not_of(blanks), text.size()));
  text.erase(text.find_last_not_of(blanks) + 1);
  return text;
}

fs::path id_file(const platform::NodeFolders& directories, const std::string& name) {
  const fs::path configured = directories.user_config / "nodeids" / name;
  std::error_code error;
  if (!platform::is_system_process() || fs::exists(configured, error)) return configured;
  return directories.user_state / "nodeids" / name;
}

}  // namespace

void KeptNodeId::lock(const std::string& name, const platform::NodeFolders& directories) {
  // It becomes the name of a file.
  if (!Url::is_node_name(name)) {
    throw Error(ErrorCode::invalid_argument, "`" + name + "` is no name for a node");
  }
  platform::make_trusted_folder((directories.user_run / "nodeids").string(), {.is_private = true},
                                directories.user_run.string());
  lock_.emplace(directories.user_run / "nodeids" / (name + ".pid"), "the node name `" + name + "`");
  lock_->write(std::to_string(platform::process_id()));
}

KeptNodeId::KeptNodeId(const std::string& name, const NodeId& id) : id_(id) {
  lock(name, platform::node_folders());
}

KeptNodeId::KeptNodeId(const std::string& name) {
  const auto directories = platform::node_folders();
  lock(name, directories);
  const fs::path file = id_file(directories, name);
  const auto text = read_trimmed(file);
  if (text && !text->empty()) {
    const auto id = NodeId::parse(*text);
    if (!id || id->is_any()) {
      throw Error(ErrorCode::invalid_configuration, file.string() + " holds no node id");
    }
    id_ = *id;
    return;
  }
  id_ = NodeId::random();
  channel::LockedFile(file, "the id of `" + name + "`").write(id_.text_with_braces());
}

}  // namespace rr
