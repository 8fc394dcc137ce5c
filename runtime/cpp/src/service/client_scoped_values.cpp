// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/service/client_scoped_values.hpp"

#include <utility>

#include "runtime/cpp/src/service/server_endpoint.hpp"

namespace rr {
namespace service {

bool ClientScopedValues::add(const std::shared_ptr<ClientValues>& values) {
  const MutexLock lock(mutex_);
  if (has_ended_) return false;
  // What has gone is dropped whenever the list would grow.
  if (keepers_.size() == keepers_.capacity()) {
    std::erase_if(keepers_, [](const auto& keeper) { return keeper.expired(); });
  }
  keepers_.push_back(values);
  return true;
}

void ClientScopedValues::end(const void* session) {
  std::vector<std::weak_ptr<ClientValues>> keepers;
  {
    const MutexLock lock(mutex_);
    has_ended_ = true;
    keepers.swap(keepers_);
  }
  for (const auto& keeper : keepers) {
    if (const auto values = keeper.lock()) values->forget(session);
  }
}

}  // namespace service

const void* ClientValues::current_session() { return service::ServerEndpoint::current(); }

bool ClientValues::keep_for_current(const std::shared_ptr<ClientValues>& values) {
  service::ServerEndpoint* const endpoint = service::ServerEndpoint::current();
  return endpoint != nullptr && endpoint->client_values().add(values);
}

}  // namespace rr
