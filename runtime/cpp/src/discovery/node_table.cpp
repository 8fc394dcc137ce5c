// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/discovery/node_table.hpp"

#include <algorithm>
#include <utility>

namespace rr::discovery {
namespace {

// Of a node. One that has more tells us of its newest.
constexpr std::size_t most_urls = 16;

}  // namespace

NodeTable::News NodeTable::hear(const Announcement& announcement, const std::string& sender,
                                channel::Time now) {
  auto found = nodes_.find(announcement.node);
  News news = News::none;
  if (found == nodes_.end()) {
    if (nodes_.size() >= bounds_.nodes) return News::refused;
    const auto count = of_sender_.find(sender);
    if (count != of_sender_.end() && count->second >= bounds_.nodes_of_sender) return News::refused;
    ++of_sender_[sender];
    found = nodes_.emplace(announcement.node, Row{{}, {}, sender, {}}).first;
    news = News::found;
  }
  Row& row = found->second;
  const bool is_same = row.name == announcement.name && row.nonce == announcement.nonce;
  if (!is_same && news == News::none) news = News::changed;
  row.name = announcement.name;
  row.nonce = announcement.nonce;
  const auto url = std::find_if(row.urls.begin(), row.urls.end(), [&](const HeardUrl& other) {
    return other.url == announcement.url;
  });
  if (url != row.urls.end()) {
    url->heard = now;
    return news;
  }
  if (row.urls.size() >= most_urls) {
    row.urls.erase(
        std::min_element(row.urls.begin(), row.urls.end(),
                         [](const HeardUrl& a, const HeardUrl& b) { return a.heard < b.heard; }));
  }
  row.urls.push_back({announcement.url, now});
  return news == News::none ? News::changed : news;
}

void NodeTable::release(const Row& row) {
  const auto count = of_sender_.find(row.sender);
  if (count != of_sender_.end() && --count->second == 0) of_sender_.erase(count);
}

std::vector<KnownNode> NodeTable::forget_old(channel::Time now) {
  std::vector<KnownNode> lost;
  for (auto item = nodes_.begin(); item != nodes_.end();) {
    Row& row = item->second;
    const KnownNode before = describe(item->first, row);
    std::erase_if(row.urls, [&](const HeardUrl& url) {
      return channel::after(url.heard, bounds_.lifetime) <= now;
    });
    if (!row.urls.empty()) {
      ++item;
      continue;
    }
    lost.push_back(before);
    release(row);
    item = nodes_.erase(item);
  }
  return lost;
}

std::vector<KnownNode> NodeTable::clear() {
  std::vector<KnownNode> lost = all();
  nodes_.clear();
  of_sender_.clear();
  return lost;
}

KnownNode NodeTable::describe(const NodeId& id, const Row& row) {
  KnownNode known{{id, row.name, {}}, row.nonce, row.sender};
  std::vector<const HeardUrl*> urls;
  for (const HeardUrl& url : row.urls) urls.push_back(&url);
  // Not std::stable_sort, which clang finds deprecated inside of this library's: those heard at the
  // same time stay in their order.
  std::sort(urls.begin(), urls.end(), [](const HeardUrl* a, const HeardUrl* b) {
    return a->heard != b->heard ? a->heard > b->heard : a < b;
  });
  for (const HeardUrl* url : urls) known.node.urls.push_back(url->url);
  return known;
}

std::vector<KnownNode> NodeTable::all() const {
  std::vector<KnownNode> result;
  for (const auto& [id, row] : nodes_) result.push_back(describe(id, row));
  return result;
}

std::optional<KnownNode> NodeTable::find(const NodeId& id) const {
  const auto found = nodes_.find(id);
  if (found == nodes_.end()) return std::nullopt;
  return describe(id, found->second);
}

}  // namespace rr::discovery
