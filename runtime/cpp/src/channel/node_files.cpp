// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/channel/node_files.hpp"

#include <filesystem>
#include <optional>
#include <utility>

#include "rr/error.hpp"
#include "runtime/cpp/src/platform/trusted_folder.hpp"

namespace rr::channel {
namespace {

using InfoText = std::map<std::string, std::string>;

// Empty when there is none.
std::string socket_of(const InfoText& info) {
  const auto found = info.find("socket");
  return found == info.end() ? std::string() : found->second;
}

}  // namespace

NodeFiles::NodeFiles(const NodeFolder& folder, const NodeId& id, const std::string& name,
                     const std::string& socket, const std::string& nonce)
    : text_{{"nodeid", id.text_with_braces()},
            {"pid", std::to_string(platform::process_id())},
            {"socket", socket},
            {"username", own_user_name()},
            {"ServiceStateNonce", nonce}} {
  const std::string by_id = folder.base + "/by-nodeid/" + id.text();
  const std::string what_id = "the node id " + id.text();
  info_.emplace_back(by_id + ".info", what_id);
  pid_.emplace_back(by_id + ".pid", what_id);
  if (!name.empty()) {
    text_["nodename"] = name;
    const std::string by_name = folder.base + "/by-nodename/" + name;
    const std::string what_name = "the node name `" + name + "`";
    info_.emplace_back(by_name + ".info", what_name);
    pid_.emplace_back(by_name + ".pid", what_name);
  }
  for (const LockedFile& file : pid_) file.write(text_["pid"]);
  write_info();
}

NodeFiles::~NodeFiles() {
  try {
    for (const LockedFile& file : info_) file.write({});
    for (const LockedFile& file : pid_) file.write({});
  } catch (const Error&) {
    // The lock goes in any case, by which others know.
  }
}

void NodeFiles::set_nonce(const std::string& nonce) {
  text_["ServiceStateNonce"] = nonce;
  write_info();
}

void NodeFiles::write_info() const {
  std::string text;
  for (const auto& [key, value] : text_) text.append(key).append(": ").append(value).append("\n");
  for (const LockedFile& file : info_) file.write(text);
}

void clean_up(const NodeFolder& folder) {
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder.base + "/by-nodeid", error)) {
    if (entry.path().extension() != ".info") continue;
    const std::string path = entry.path().string();
    const std::string socket = socket_of(read_info_file(path));
    if (socket.empty()) continue;
    // Only what such a node has made there.
    const bool is_ours =
        std::filesystem::path(socket).parent_path() == folder.sockets && socket.ends_with(".sock");
    if (!is_ours || LockedFile::is_held(path)) continue;
    if (std::filesystem::is_socket(std::filesystem::symlink_status(socket, error))) {
      std::filesystem::remove(socket, error);
    }
  }
}

namespace {

// Empty when the node is not there.
std::string socket_in(const NodeFolder& folder, const Url& url) {
  const auto is_named = [&](const InfoText& info) {
    const auto name = info.find("nodename");
    return name != info.end() && name->second == url.node_name;
  };
  const std::string by_name = folder.base + "/by-nodename/" + url.node_name + ".info";
  if (url.node_id.is_any()) {
    const InfoText info = read_info_file(by_name);
    return is_named(info) || !info.contains("nodename") ? socket_of(info) : std::string();
  }
  const InfoText info = read_info_file(folder.base + "/by-nodeid/" + url.node_id.text() + ".info");
  if (url.node_name.empty()) return socket_of(info);
  const bool is_same = is_named(info) && socket_of(read_info_file(by_name)) == socket_of(info);
  return is_same ? socket_of(info) : std::string();
}

// Nothing when it does not exist.
std::optional<FoundSocket> trusted_socket(const std::string& path,
                                          const platform::FolderRule& rule) {
  const std::string name = std::filesystem::path(path).parent_path().string();
  const auto folder = platform::open_trusted_folder(name, rule);
  if (!folder) return std::nullopt;
  return FoundSocket{path, {platform::system_user, platform::current_user(), folder->owner}};
}

// Who names a path means what its folder's owner has there.
std::vector<FoundSocket> socket_at(const std::string& path) {
  const std::string folder = std::filesystem::path(path).parent_path().string();
  const platform::FolderRule rule{.owner = platform::owner_of(folder)};
  auto socket = trusted_socket(path, rule);
  if (!socket) return {};
  return {std::move(*socket)};
}

std::optional<FoundSocket> socket_in_trusted(const NodeFolder& folder, const Url& url) {
  if (!platform::open_trusted_folder(folder.base, folder.rule)) return std::nullopt;
  const std::string path = socket_in(folder, url);
  if (!path.starts_with('/')) return std::nullopt;
  return trusted_socket(path, folder.rule);
}

}  // namespace

std::vector<FoundSocket> find_sockets(const LocalOptions& options, const Url& url) {
  if (url.path.size() > 1) return socket_at(url.path);
  if (url.node_id.is_any() && url.node_name.empty()) {
    throw Error(ErrorCode::invalid_argument,
                "a local URL needs `nodeid`, `nodename`, or the path of a socket");
  }
  std::vector<FoundSocket> sockets;
  std::optional<Error> failure;
  for (const NodeFolder& folder : folders_for_host(options, url.host)) {
    try {
      if (auto socket = socket_in_trusted(folder, url)) sockets.push_back(std::move(*socket));
    } catch (const Error& error) {
      if (!failure) failure = error;
    }
  }
  if (sockets.empty() && failure) throw Error(*failure);
  return sockets;
}

}  // namespace rr::channel
