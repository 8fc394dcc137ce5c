// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/subscription/object_links.hpp"

#include <utility>

#include "runtime/cpp/src/subscription/services.hpp"

namespace rr::subscription {

// Clients come in the order in which they are connected: the first is the default one.
std::shared_ptr<Stub> ObjectLinks::find(const ObjectType* type) {
  if (const auto services = services_.lock()) services->learn(type);
  const MutexLock lock(mutex_);
  if (links_.empty() || links_.front()->phase != Link::Phase::open) return nullptr;
  return as_object(*links_.front()).object;
}

std::optional<Error> ObjectLinks::why_none() const {
  if (auto error = last_error()) return error;
  const auto services = services_.lock();
  return services ? services->last_error() : std::nullopt;
}

Links::LinkPointer ObjectLinks::make_link(std::shared_ptr<const LiveClient> client) {
  return std::make_shared<ObjectLink>(*this, std::move(client));
}

void ObjectLinks::connect(const LinkPointer& link, const std::shared_ptr<Stub>& object) {
  as_object(*link).object = object;
  opened(link);
}

}  // namespace rr::subscription
