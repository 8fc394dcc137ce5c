// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/endpoint/pending.hpp"

#include <utility>

namespace rr::endpoint {

// The link that points to the request, or the end of its chain.
Pending** PendingTable::find(std::uint32_t id) {
  Pending** link = &buckets_[id & (buckets_.size() - 1)];
  while (*link != nullptr && (*link)->id_ != id) link = &(*link)->next_;
  return link;
}

void PendingTable::grow() {
  std::vector<Pending*> old(buckets_.empty() ? 4 : 2 * buckets_.size());
  old.swap(buckets_);
  for (Pending* chain : old) {
    while (chain != nullptr) {
      Pending* const request = std::exchange(chain, chain->next_);
      request->next_ = std::exchange(buckets_[request->id_ & (buckets_.size() - 1)], request);
    }
  }
}

std::uint32_t PendingTable::add(Pending& request) {
  if (size_ == buckets_.size()) grow();
  request.id_ = skip();
  request.is_open_ = true;
  request.was_added_ = true;
  request.next_ = nullptr;
  *find(request.id_) = &request;
  ++size_;
  return request.id_;
}

std::uint32_t PendingTable::skip() {
  while (size_ != 0 && *find(next_id_) != nullptr) ++next_id_;
  return next_id_++;
}

Pending* PendingTable::take(std::uint32_t id) {
  if (size_ == 0) return nullptr;
  Pending** const link = find(id);
  Pending* const request = *link;
  if (request == nullptr) return nullptr;
  *link = request->next_;
  request->is_open_ = false;
  --size_;
  return request;
}

bool PendingTable::take(Pending& request) {
  return request.is_open_ && take(request.id_) != nullptr;
}

Pending* PendingTable::take_any() {
  if (size_ == 0) return nullptr;
  for (Pending* const chain : buckets_) {
    if (chain != nullptr) return take(chain->id_);
  }
  return nullptr;
}

}  // namespace rr::endpoint
