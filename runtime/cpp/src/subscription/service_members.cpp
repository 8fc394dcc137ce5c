// SPDX-License-Identifier: Apache-2.0
// The members of a subscription's services that are used at all clients.
#include <utility>

#include "rr/error.hpp"
#include "runtime/cpp/src/client/definition_reader.hpp"
#include "runtime/cpp/src/subscription/object_links.hpp"
#include "runtime/cpp/src/subscription/pipe_links.hpp"
#include "runtime/cpp/src/subscription/services.hpp"
#include "runtime/cpp/src/subscription/wire_links.hpp"

namespace rr::subscription {

std::shared_ptr<Links> Services::add_member(std::shared_ptr<Links> member) {
  check_open();
  members_.push_back(member);
  for (const TargetPointer& target : connected()) {
    inner_->add([member, client = target->client] { member->client_came(client); });
  }
  return member;
}

// Where the program was built without the definitions all values are of one type.
void Services::check_holding(std::string_view member, const Holding& holding) const {
  if (!options_.make_definition_reader) return;
  const auto reader = options_.make_definition_reader();
  if (&reader->holding() == &holding) return;
  throw Error(ErrorCode::data_type_mismatch,
              "the values of `" + std::string(member) + "` are " +
                  std::string(reader->name_of_values()) +
                  ", as all of a subscription without generated code");
}

std::shared_ptr<Links> Services::add_wire(std::string_view member, std::string_view path,
                                          const Holding& holding) {
  check_holding(member, holding);
  auto wire =
      std::make_shared<WireLinks>(host_.core, weak_from_this(), std::string(member), path, holding);
  const MutexLock lock(mutex_);
  for (const auto& other : members_) {
    const auto same = std::dynamic_pointer_cast<WireLinks>(other);
    if (!same || same->member() != wire->member() || same->path() != wire->path()) continue;
    if (&same->holding() == &holding) return same;
    throw Error(ErrorCode::invalid_operation,
                "the wire `" + wire->member() + "` is used with values of another type");
  }
  return add_member(std::move(wire));
}

std::shared_ptr<Links> Services::add_pipe(std::string_view member, std::string_view path,
                                          const Holding& holding, std::size_t max_received) {
  check_holding(member, holding);
  auto pipe = std::make_shared<PipeLinks>(host_.core, weak_from_this(), std::string(member), path,
                                          holding, max_received);
  const MutexLock lock(mutex_);
  return add_member(std::move(pipe));
}

std::shared_ptr<Links> Services::add_sub_object(std::string_view path) {
  auto object = std::make_shared<ObjectLinks>(host_.core, weak_from_this(), path);
  const MutexLock lock(mutex_);
  return add_member(std::move(object));
}

void Services::forget(const Links& member) {
  std::shared_ptr<Links> gone;
  const MutexLock lock(mutex_);
  const auto found = std::find_if(members_.begin(), members_.end(),
                                  [&](const auto& other) { return other.get() == &member; });
  if (found == members_.end()) return;
  gone = std::move(*found);
  members_.erase(found);
}

}  // namespace rr::subscription
