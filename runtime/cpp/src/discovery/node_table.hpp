// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "rr/discovery.hpp"
#include "runtime/cpp/src/channel/time.hpp"
#include "runtime/cpp/src/discovery/packets.hpp"

namespace rr::discovery {

/// What is known of a node.
struct KnownNode {
  DetectedNode node;   ///< the URL that was heard last comes first
  std::string nonce;   ///< empty for none
  std::string sender;  ///< the address that has announced it first
};

/// The nodes that have announced themselves, bounded in every direction (05, section 4). For one
/// thread at a time.
class NodeTable {
 public:
  struct Bounds {
    std::size_t nodes = 4096;
    std::size_t nodes_of_sender = 256;
    channel::Milliseconds lifetime{60'000};
  };
  explicit NodeTable(Bounds bounds) : bounds_(bounds) {}

  enum class News : std::uint8_t {
    none,     ///< what was known before
    found,    ///< a new node
    changed,  ///< another nonce, name or URL
    refused,  ///< there is no room for it
  };
  /// `sender`: the text of its address, without port.
  News hear(const Announcement& announcement, const std::string& sender, channel::Time now);
  /// Forgets what has not been heard for too long; returns the nodes of which nothing is left.
  std::vector<KnownNode> forget_old(channel::Time now);
  /// Forgets all.
  std::vector<KnownNode> clear();

  [[nodiscard]] std::vector<KnownNode> all() const;
  [[nodiscard]] std::optional<KnownNode> find(const NodeId& id) const;
  [[nodiscard]] std::size_t size() const { return nodes_.size(); }

 private:
  struct HeardUrl {
    std::string url;
    channel::Time heard;
  };
  struct Row {
    std::string name;
    std::string nonce;
    std::string sender;
    std::vector<HeardUrl> urls;
  };
  static KnownNode describe(const NodeId& id, const Row& row);
  void release(const Row& row);

  const Bounds bounds_;
  std::map<NodeId, Row> nodes_;
  std::map<std::string, std::size_t> of_sender_;
};

}  // namespace rr::discovery
