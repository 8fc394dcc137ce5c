// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "rr/node_id.hpp"
#include "rr/options.hpp"
#include "rr/url.hpp"
#include "runtime/cpp/src/channel/directories.hpp"
#include "runtime/cpp/src/channel/run_directories.hpp"
#include "runtime/cpp/src/platform/users.hpp"

/// The files that local nodes are found by (04, sections 7.2 and 7.3).
namespace rr::channel {

/// The files of one node, for as long as it listens.
class NodeFiles {
 public:
  /// Throws as LockedFile does.
  NodeFiles(const NodeFolder& folder, const NodeId& id, const std::string& name,
            const std::string& socket, const std::string& nonce);
  /// Leaves the files behind, as others expect that have them open, but says nothing in them.
  ~NodeFiles();
  NodeFiles(const NodeFiles&) = delete;
  NodeFiles& operator=(const NodeFiles&) = delete;

  void set_nonce(const std::string& nonce);

 private:
  void write_info() const;

  std::map<std::string, std::string> text_;
  std::vector<LockedFile> info_;
  std::vector<LockedFile> pid_;
};

/// Removes the sockets that nodes have left behind which live no more.
void clean_up(const NodeFolder& folder);

/// A socket at which a node may be.
struct FoundSocket {
  std::string path;
  /// Who may listen there: the system and the folder's owner. Somebody else has taken the place of
  /// the one who is wanted.
  std::vector<platform::UserId> servers;
};
/// Those of the node of a URL, in the order in which to try them. Throws rr::Error:
/// invalid_argument when the URL names no node, system_resource_error when it is in none of the
/// folders and another user could have changed one of them.
std::vector<FoundSocket> find_sockets(const LocalOptions& options, const Url& url);

}  // namespace rr::channel
