// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "rr/node_id.hpp"
#include "runtime/cpp/src/channel/directories.hpp"

namespace rr {

/// The id that the nodes of this user have by a name: kept in a file, made when it is missing. The
/// name is used by one node at a time (04, section 7.4).
class KeptNodeId {
 public:
  /// Throws rr::Error: invalid_operation when a node of this name runs, invalid_configuration for a
  /// file that holds no id, system_resource_error when it cannot be read or made.
  explicit KeptNodeId(const std::string& name);
  /// The same for a node whose id is known from elsewhere: no file is asked, and none is made.
  KeptNodeId(const std::string& name, const NodeId& id);

  [[nodiscard]] const NodeId& id() const { return id_; }

 private:
  void lock(const std::string& name, const platform::NodeFolders& directories);

  std::optional<channel::LockedFile> lock_;  // while this lives
  NodeId id_;
};

}  // namespace rr
