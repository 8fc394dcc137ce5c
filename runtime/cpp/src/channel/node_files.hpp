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
#include "runtime/cpp/src/channel/run_directories.hpp"
#include "runtime/cpp/src/channel/socket.hpp"

/// The files that local nodes are found by (04, sections 7.2 and 7.3).
namespace rr::channel {

/// A file that is kept locked while the object lives.
class HeldFile {
 public:
  /// Opens or makes the file. Throws rr::Error: invalid_operation when somebody has locked it, and
  /// `what` says what that means; system_resource_error.
  HeldFile(const std::string& path, std::string_view what);
  /// Replaces the content.
  void write(std::string_view text) const;

 private:
  std::string path_;
  Descriptor file_;
};

/// `key: value` lines; the first of a key counts.
using InfoText = std::map<std::string, std::string>;
InfoText parse_info(std::string_view text);
/// Of a file; nothing when it cannot be read or is larger than such files are.
std::optional<InfoText> read_info(const std::string& path);
/// Whether a node that lives has the file locked.
bool is_locked(const std::string& path);

/// The files of one node, for as long as it listens.
class NodeFiles {
 public:
  /// Throws as HeldFile does.
  NodeFiles(const NodeFolder& folder, const NodeId& id, const std::string& name,
            const std::string& socket, const std::string& nonce);
  /// Leaves the files behind, as others expect that have them open, but says nothing in them.
  ~NodeFiles();
  NodeFiles(const NodeFiles&) = delete;
  NodeFiles& operator=(const NodeFiles&) = delete;

  void set_nonce(const std::string& nonce);

 private:
  void write_info() const;

  InfoText text_;
  std::vector<HeldFile> info_;
  std::vector<HeldFile> pid_;
};

/// Removes the sockets that nodes have left behind which live no more.
void clean_up(const NodeFolder& folder);

/// The sockets at which the node of a URL may be, in the order in which to try them. Throws
/// rr::Error (invalid_argument) when the URL names no node.
std::vector<std::string> find_sockets(const LocalOptions& options, const Url& url);

}  // namespace rr::channel
