// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/service/object_tree.hpp"

#include <algorithm>
#include <charconv>
#include <iterator>
#include <optional>
#include <string>
#include <utility>

#include "rr/error.hpp"
#include "rr/mutex.hpp"
#include "runtime/cpp/src/channel/reactor.hpp"
#include "runtime/cpp/src/service/places.hpp"
#include "runtime/cpp/src/service/turn_break.hpp"

namespace rr::service {
namespace {

bool read_number(std::string_view digits, std::int32_t& number) {
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  return error == std::errc() && end == digits.data() + digits.size();
}

// How an index is handed to the objref (07, section 14).
ObjectIndex read_index(const Member& member, const std::optional<std::string>& text) {
  ObjectIndex index;
  switch (member.index) {
    case IndexForm::none:
      if (text) throw Error(ErrorCode::service_error, "this objref has no index");
      break;
    case IndexForm::int32: {
      if (!read_number(text ? std::string_view(*text) : std::string_view(), index.number)) {
        throw Error(ErrorCode::invalid_argument, "the index of this objref is a number");
      }
      break;
    }
    case IndexForm::string:
      if (text) index.text = *text;
      break;
  }
  return index;
}

// A number has one spelling in paths, or a client could have one object remembered at any number of
// them.
std::string spelled_index(const ServedObject& parent, const endpoint::PathSegment& segment) {
  const auto place = parent.members->find(segment.name);
  std::int32_t number = 0;
  const bool is_number = place && parent.type->members[*place].index == IndexForm::int32 &&
                         read_number(*segment.index, number);
  return is_number ? std::to_string(number) : *segment.index;
}

// Bytes of an object's path, on average; it is kept several times.
constexpr std::size_t path_room = 256;
// What an object takes, about; the program's own part of it is not known.
constexpr std::size_t object_cost = 1024;
constexpr std::size_t copies_of_path = 7;
std::size_t cost_of(const std::string& path) { return object_cost + copies_of_path * path.size(); }
// When nothing was found that is not used.
constexpr channel::Milliseconds sweep_pause{100};

}  // namespace

ObjectTree::ObjectTree(std::string root_name, std::shared_ptr<Skeleton> root, std::size_t limit,
                       std::shared_ptr<channel::Account> account, Notices notices,
                       channel::Milliseconds patience)
    : limit_(limit),
      notices_(std::move(notices)),
      patience_(patience),
      charge_(std::move(account)) {
  const ObjectType& type = root->rr_object_type();
  root_ = std::make_shared<const ServedObject>(
      ServedObject{std::move(root_name), std::move(root), &type, &members_of(type)});
}

ObjectTree::Object ObjectTree::find(std::string_view path, std::uint32_t client) {
  if (path == root_->path) return root_;
  const auto segments = endpoint::parse_path(path);
  if (!segments) throw Error(ErrorCode::service_error, "Invalid service path specified");
  if (segments->front().name != root_->path) {
    throw Error(ErrorCode::object_not_found, "the path does not belong to this service");
  }
  Object object = root_;
  for (std::size_t i = 1; i < segments->size(); ++i) {
    const endpoint::PathSegment& segment = (*segments)[i];
    std::string child_path = object->path + "." + segment.name;
    if (segment.index) {
      child_path += "[" + endpoint::escape_index(spelled_index(*object, segment)) + "]";
    }
    Known known = find_known(child_path, client, object->owner != 0);
    if (known.must_look) {
      known.object = look_up(*object, segment, child_path, client, known.is_own);
    }
    object = std::move(known.object);
  }
  return object;
}

// When nobody knows the object and nobody looks for it, the caller must. What is found to be a
// client's own says nothing to others, who then look for theirs.
ObjectTree::Known ObjectTree::find_known(const std::string& path, std::uint32_t client,
                                         bool is_below_own) {
  const channel::Time deadline = channel::after(channel::Clock::now(), patience_);
  const MutexLock lock(mutex_);
  while (true) {
    const auto found = places_.find(path);
    if (found == places_.end()) {
      if (is_below_own && client == 0) break;
      if (!take_room(path)) continue;
      Place& place = places_[path];
      if (is_below_own) place.own.try_emplace(client);
      return {nullptr, true, is_below_own};
    }
    Place& place = found->second;
    if (is_below_own || !place.own.empty()) {
      if (client == 0) break;
      const auto own = place.own.find(client);
      if (own == place.own.end()) {
        if (!take_room(path)) continue;
        place.own.try_emplace(client);
        return {nullptr, true, true};
      }
      if (own->second) return {own->second, false, true};
    } else if (place.object) {
      add_user(place, client);
      return {place.object, false, false};
    }
    await_settlement(deadline);
  }
  throw Error(ErrorCode::object_not_found, "this object is for clients only");
}

// The lock is given up meanwhile. Who looks for the object may be waiting for its
// client, and that for this request. Throws rr::Error at the deadline.
void ObjectTree::await_settlement(channel::Time deadline) {
  const std::uint64_t seen = settlements_;
  {
    const MutexUnlock unlock(mutex_);
    const TurnBreak turn_break(channel::never);  // what follows needs the turn
    channel::Reactor::about_to_wait();
    const MutexLock lock(mutex_);  // not when the turn is taken again
    while (settlements_ == seen && channel::Clock::now() < deadline) {
      channel::wait_until(settled_, mutex_, deadline);
    }
  }
  if (settlements_ == seen) {
    throw Error(ErrorCode::operation_timeout, "another request still looks for this object");
  }
}

// False when the lock was given up meanwhile, for what is not used to be released.
bool ObjectTree::take_room(const std::string& path) {
  const bool has_room = size_ < limit_ && path_size_ + path.size() <= limit_ * path_room &&
                        charge_.add(cost_of(path));
  if (!has_room) {
    // Not for each request of a client that asks for more and more.
    const channel::Time now = channel::coarse_now();
    Released released = now < next_sweep_ ? Released() : release_unused();
    if (released.empty() && now >= next_sweep_) next_sweep_ = now + sweep_pause;
    const bool is_full = released.empty();
    const MutexUnlock unlock(mutex_);
    if (is_full) {
      throw Error(ErrorCode::out_of_system_resource,
                  "the objects of the service are as many as they may be, " +
                      std::to_string(limit_) + ", or take too much memory");
    }
    notices_.drop(std::move(released));
    return false;
  }
  ++size_;
  path_size_ += path.size();
  return true;
}

void ObjectTree::count_out(const std::string& path) {
  --size_;
  path_size_ -= path.size();
  charge_.reduce(cost_of(path));
}

void ObjectTree::add_user(Place& place, std::uint32_t client) {
  if (client == 0) return;
  const auto at = std::lower_bound(place.users.begin(), place.users.end(), client);
  if (at == place.users.end() || *at != client) place.users.insert(at, client);
}

ObjectTree::Object ObjectTree::look_up(const ServedObject& parent,
                                       const endpoint::PathSegment& segment,
                                       const std::string& path, std::uint32_t client, bool is_own) {
  try {
    const std::shared_ptr<ServedObject> object = make(parent, segment, path);
    const bool is_for_client =
        is_own || Skeleton::Places::of(*object->skeleton).is_per_client.load();
    if (is_for_client && client == 0) {
      throw Error(ErrorCode::object_not_found, "this object is for clients only");
    }
    if (is_for_client) object->owner = client;
    notices_.attach(*object);
    settle(path, client, is_own, object);
    return object;
  } catch (...) {
    settle(path, client, is_own, nullptr);
    throw;
  }
}

// Asks the parent.
std::shared_ptr<ServedObject> ObjectTree::make(const ServedObject& parent,
                                               const endpoint::PathSegment& segment,
                                               const std::string& path) {
  const auto place = parent.members->find(segment.name);
  if (!place || parent.type->members[*place].kind != MemberKind::objref) {
    throw Error(ErrorCode::member_not_found, "Member not found");
  }
  const ObjectIndex index = read_index(parent.type->members[*place], segment.index);
  std::shared_ptr<Skeleton> skeleton = parent.skeleton->rr_child(*place, index);
  if (!skeleton) throw Error(ErrorCode::service_error, "there is no object at this path");
  const ObjectType& type = skeleton->rr_object_type();
  const MutexLock lock(mutex_);
  return std::make_shared<ServedObject>(
      ServedObject{path, std::move(skeleton), &type, &members_of(type)});
}

// Ends what find_known() has begun: `is_own` as it said then.
void ObjectTree::settle(const std::string& path, std::uint32_t client, bool is_own, Object object) {
  {
    const MutexLock lock(mutex_);
    ++settlements_;
    Place& place = places_[path];
    if (object && object->owner != 0) {
      place.own[client] = std::move(object);
      own_paths_[client].insert(path);
    } else if (object) {
      place.object = std::move(object);
      add_user(place, client);
    } else {
      count_out(path);
      if (is_own) place.own.erase(client);
      if (place.own.empty() && !place.object) places_.erase(path);
    }
  }
  settled_.notify_all();
}

const MemberIndex& ObjectTree::members_of(const ObjectType& type) {
  std::unique_ptr<MemberIndex>& index = indexes_[&type];
  if (!index) index = std::make_unique<MemberIndex>(type);
  return *index;
}

void ObjectTree::take(Object& object, Released& released) {
  if (object->owner != 0) {
    const auto paths = own_paths_.find(object->owner);
    paths->second.erase(object->path);
    if (paths->second.empty()) own_paths_.erase(paths);
  }
  count_out(object->path);
  released.push_back(std::move(object));
}

// What a thread looks for just now stays.
template <class Condition>
ObjectTree::Released ObjectTree::release_if(Condition condition) {
  Released released;
  const auto is_released = [&](Object& object) RR_REQUIRES(mutex_) {
    if (!object || !condition(*object)) return false;
    take(object, released);
    return true;
  };
  for (auto place = places_.begin(); place != places_.end();) {
    auto& [object, own, users] = place->second;
    const std::size_t count = released.size();
    if (is_released(object)) users.clear();
    for (auto one = own.begin(); one != own.end();) {
      one = is_released(one->second) ? own.erase(one) : std::next(one);
    }
    const bool is_empty = released.size() != count && !object && own.empty();
    place = is_empty ? places_.erase(place) : std::next(place);
  }
  if (!released.empty()) generation_.fetch_add(1, std::memory_order_release);
  return released;
}

ObjectTree::Released ObjectTree::release(std::string_view path) {
  const MutexLock lock(mutex_);
  const auto found = places_.find(std::string(path));
  if (found == places_.end()) return {};
  const Place& place = found->second;
  const bool has_own =
      std::any_of(place.own.begin(), place.own.end(), [](const auto& own) { return own.second; });
  if (!place.object && !has_own) return {};
  return release_if(
      [&](const ServedObject& object) { return endpoint::is_at_or_below(object.path, path); });
}

ObjectTree::Released ObjectTree::release(std::string_view path, std::uint32_t client) {
  const MutexLock lock(mutex_);
  const auto found = places_.find(std::string(path));
  if (found == places_.end()) return {};
  const auto own = found->second.own.find(client);
  if (own == found->second.own.end() || !own->second) return {};
  return release_if([&](const ServedObject& object) {
    return object.owner == client && endpoint::is_at_or_below(object.path, path);
  });
}

ObjectTree::Released ObjectTree::release_all_of(std::uint32_t client) {
  Released released;
  const MutexLock lock(mutex_);
  const auto paths = own_paths_.extract(client);
  if (paths.empty()) return released;
  for (const std::string& path : paths.mapped()) {
    const auto found = places_.find(path);
    count_out(path);
    released.push_back(std::move(found->second.own.extract(client).mapped()));
    if (found->second.own.empty() && !found->second.object) places_.erase(found);
  }
  generation_.fetch_add(1, std::memory_order_release);
  return released;
}

// Objects of all that no client uses, but for those that something holds. Whoever
// uses one has used those above it.
ObjectTree::Released ObjectTree::release_unused() {
  Released released;
  for (auto place = places_.begin(); place != places_.end();) {
    auto& [object, own, users] = place->second;
    if (!object || !users.empty() || !own.empty() || notices_.is_held(*object)) {
      ++place;
      continue;
    }
    take(object, released);
    place = places_.erase(place);
  }
  if (!released.empty()) generation_.fetch_add(1, std::memory_order_release);
  return released;
}

ObjectTree::Released ObjectTree::leave(std::uint32_t client, std::size_t limit) {
  const MutexLock lock(mutex_);
  for (auto& [path, place] : places_) {
    const auto at = std::lower_bound(place.users.begin(), place.users.end(), client);
    if (at != place.users.end() && *at == client) place.users.erase(at);
  }
  const bool is_much = size_ > limit || path_size_ > limit * path_room;
  return is_much ? release_unused() : Released();
}

ObjectTree::Released ObjectTree::clear() {
  const MutexLock lock(mutex_);
  Released released = release_if([](const ServedObject& object) { return object.owner == 0; });
  released.push_back(root_);
  generation_.fetch_add(1, std::memory_order_release);
  return released;
}

}  // namespace rr::service
