// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/discovery/local_nodes.hpp"

#include <algorithm>
#include <filesystem>
#include <map>
#include <string>
#include <system_error>

#include "rr/error.hpp"
#include "rr/url.hpp"
#include "runtime/cpp/src/channel/directories.hpp"
#include "runtime/cpp/src/endpoint/service_index_types.hpp"
#include "runtime/cpp/src/platform/trusted_folder.hpp"
#include "runtime/cpp/src/platform/users.hpp"

namespace rr::discovery {
namespace {

namespace fs = std::filesystem;

// Of one folder: whoever may write there may make files without end.
constexpr std::size_t most_files = 1024;

std::vector<fs::path> entries_of(const fs::path& folder) {
  std::vector<fs::path> result;
  std::error_code error;
  for (fs::directory_iterator item(folder, error), end; !error && item != end;
       item.increment(error)) {
    if (result.size() >= most_files) break;
    result.push_back(item->path());
  }
  std::sort(result.begin(), result.end());
  return result;
}

std::string text_of(const std::map<std::string, std::string>& info, const char* key) {
  const auto found = info.find(key);
  return found == info.end() ? std::string() : found->second;
}

// `nodename` by node, where the file has that name.
std::map<NodeId, std::string> names_in(const fs::path& base) {
  std::map<NodeId, std::string> names;
  for (const fs::path& file : entries_of(base / "by-nodename")) {
    if (file.extension() != ".info") continue;
    const auto info = channel::read_info_file(file);
    const std::string name = text_of(info, "nodename");
    const auto id = NodeId::parse(text_of(info, "nodeid"));
    if (id && name == file.stem().string() && Url::is_node_name(name)) names[*id] = name;
  }
  return names;
}

// Somebody else can have made the folder, and said in it what he likes.
bool is_trusted(const fs::path& base, const std::string& user) {
  platform::FolderRule rule;
  if (user.empty()) {
    rule.is_private = true;
  } else {
    rule.owner = platform::user_of(user);
  }
  try {
    return platform::open_trusted_folder(base.string(), rule).has_value();
  } catch (const Error&) {
    return false;
  }
}

// `user` is whose folder it is, in the public ones; empty for the own, private one.
void add_nodes_in(const fs::path& base, const std::string& user, std::vector<Announcement>& nodes) {
  if (!is_trusted(base, user)) return;
  const auto names = names_in(base);
  for (const fs::path& file : entries_of(base / "by-nodeid")) {
    if (file.extension() != ".info" || !channel::LockedFile::is_held(file)) continue;
    const auto info = channel::read_info_file(file);
    const auto id = NodeId::parse(text_of(info, "nodeid"));
    const std::string owner = text_of(info, "username");
    if (!id || id->is_any() || owner.empty() || (!user.empty() && owner != user)) continue;
    Announcement& node = nodes.emplace_back(Announcement{.node = *id});
    if (const auto name = names.find(*id); name != names.end()) node.name = name->second;
    const std::string place = user.empty() ? "/" : user + "@localhost/";
    node.url = service_index::service_url("rr+local://" + place, *id, service_index::service_name);
    node.nonce = text_of(info, "ServiceStateNonce");
  }
}

}  // namespace

std::vector<Announcement> find_local_nodes() {
  std::vector<Announcement> nodes;
  try {
    const auto directories = platform::node_folders();
    const fs::path below = fs::path("transport") / "local";
    add_nodes_in(directories.user_run / below, {}, nodes);
    for (const fs::path& folder : entries_of(directories.system_run / below)) {
      add_nodes_in(folder, folder.filename().string(), nodes);
    }
  } catch (const Error&) {
    // No home: there are no files of this user's.
  }
  return nodes;
}

}  // namespace rr::discovery
