// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "rr/channel.hpp"
#include "rr/mutex.hpp"
#include "rr/node_id.hpp"
#include "rr/visibility.hpp"

namespace RR_VISIBLE rr {

/// Where nodes of one process find each other by `rr+intra` (04, section 1). A message is laid out
/// once, in memory that the other node takes over: its arrays are that memory, and nothing passes
/// through the system.
class IntraSpace : public std::enable_shared_from_this<IntraSpace> {
 public:
  /// A space without nodes. Nodes find each other in it that have it as NodeOptions::intra.
  IntraSpace();
  ~IntraSpace();
  IntraSpace(const IntraSpace&) = delete;
  IntraSpace& operator=(const IntraSpace&) = delete;

  /// The one that nodes use which are given no other: it is for the process by what it is.
  static std::shared_ptr<IntraSpace> of_process();

  /// A node that listens here.
  struct Present {
    NodeId id;         ///< of the node
    std::string name;  ///< empty when it has none
  };
  /// All nodes that listen here now.
  [[nodiscard]] std::vector<Present> nodes() const;

  /// The channel of a node, for its use.
  std::shared_ptr<MessageChannel> channel(const NodeId& id, std::string name);

 private:
  class Channel;
  class Listening;
  struct Entry;

  mutable Mutex mutex_;
  std::map<NodeId, std::shared_ptr<Entry>> entries_ RR_GUARDED_BY(mutex_);
};

}  // namespace rr
