// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <memory>
#include <vector>

namespace rr::service {

/// The list with one more end in it, for what is sent to all. Those of one node stand together:
/// sending wakes that process once then, and not again and again with others between.
/// `node_of(end)` is the NodeId of the client.
template <class End, class NodeOf>
std::shared_ptr<const std::vector<End>> with_end(const std::vector<End>& ends, const End& end,
                                                 const NodeOf& node_of) {
  auto result = std::make_shared<std::vector<End>>();
  result->reserve(ends.size() + 1);
  *result = ends;
  const auto last = std::find_if(result->rbegin(), result->rend(),
                                 [&](const End& other) { return node_of(other) == node_of(end); });
  result->insert(last == result->rend() ? result->end() : last.base(), end);
  return result;
}

/// The list without an end.
template <class End, class One>
std::shared_ptr<const std::vector<End>> without_end(const std::vector<End>& ends, const One& end) {
  auto result = std::make_shared<std::vector<End>>(ends);
  std::erase_if(*result, [&](const End& other) { return other.get() == &end; });
  return result;
}

}  // namespace rr::service
