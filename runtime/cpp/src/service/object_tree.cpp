// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/service/object_tree.hpp"

#include <charconv>
#include <optional>
#include <utility>

#include "rr/error.hpp"

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

}  // namespace

ObjectTree::ObjectTree(std::string root_name, std::shared_ptr<Skeleton> root, Notice attach,
                       Notice detach)
    : attach_(std::move(attach)), detach_(std::move(detach)) {
  const ObjectType& type = root->rr_object_type();
  root_ = std::make_shared<const ServedObject>(
      ServedObject{std::move(root_name), std::move(root), &type, &members_of(type)});
}

std::shared_ptr<const ServedObject> ObjectTree::find(std::string_view path) {
  if (path == root_->path) return root_;
  const auto segments = endpoint::parse_path(path);
  if (!segments) throw Error(ErrorCode::service_error, "Invalid service path specified");
  if (segments->front().name != root_->path) {
    throw Error(ErrorCode::object_not_found, "the path does not belong to this service");
  }
  std::shared_ptr<const ServedObject> object = root_;
  for (std::size_t i = 1; i < segments->size(); ++i) {
    const endpoint::PathSegment& segment = (*segments)[i];
    std::string child_path = object->path + "." + segment.name;
    if (segment.index) {
      child_path += "[" + endpoint::escape_index(spelled_index(*object, segment)) + "]";
    }
    bool must_look = false;
    auto child = find_known(child_path, must_look);
    if (must_look) child = look_up(*object, segment, child_path);
    object = std::move(child);
  }
  return object;
}

// When nobody knows the object and nobody looks for it, the caller must.
std::shared_ptr<const ServedObject> ObjectTree::find_known(const std::string& path,
                                                           bool& must_look) {
  std::unique_lock lock(mutex_);
  while (true) {
    const auto [place, is_new] = places_.try_emplace(path);
    if (is_new) {
      must_look = true;
      return nullptr;
    }
    if (place->second.object) return place->second.object;
    settled_.wait(lock);
  }
}

std::shared_ptr<const ServedObject> ObjectTree::look_up(const ServedObject& parent,
                                                        const endpoint::PathSegment& segment,
                                                        const std::string& path) {
  try {
    const auto place = parent.members->find(segment.name);
    if (!place || parent.type->members[*place].kind != MemberKind::objref) {
      throw Error(ErrorCode::member_not_found, "Member not found");
    }
    const ObjectIndex index = read_index(parent.type->members[*place], segment.index);
    std::shared_ptr<Skeleton> skeleton = parent.skeleton->rr_child(*place, index);
    if (!skeleton) throw Error(ErrorCode::service_error, "there is no object at this path");
    const ObjectType& type = skeleton->rr_object_type();
    auto object = std::make_shared<ServedObject>();
    object->path = path;
    object->skeleton = std::move(skeleton);
    object->type = &type;
    {
      const std::lock_guard lock(mutex_);
      object->members = &members_of(type);
    }
    attach_(*object);
    settle(path, object);
    return object;
  } catch (...) {
    settle(path, nullptr);
    throw;
  }
}

void ObjectTree::settle(const std::string& path, std::shared_ptr<const ServedObject> object) {
  {
    const std::lock_guard lock(mutex_);
    if (object) {
      places_[path].object = std::move(object);
    } else {
      places_.erase(path);
    }
  }
  settled_.notify_all();
}

const MemberIndex& ObjectTree::members_of(const ObjectType& type) {
  std::unique_ptr<MemberIndex>& index = indexes_[&type];
  if (!index) index = std::make_unique<MemberIndex>(type);
  return *index;
}

bool ObjectTree::release(std::string_view path) {
  std::vector<std::shared_ptr<const ServedObject>> released;
  {
    const std::lock_guard lock(mutex_);
    const auto found = places_.find(std::string(path));
    if (found == places_.end() || !found->second.object) return false;
    std::erase_if(places_, [&](const auto& place) {
      if (!place.second.object || !endpoint::is_at_or_below(place.first, path)) return false;
      released.push_back(place.second.object);
      return true;
    });
    generation_.fetch_add(1, std::memory_order_release);
  }
  for (const auto& object : released) detach_(*object);
  return true;
}

void ObjectTree::clear() {
  std::vector<std::shared_ptr<const ServedObject>> released = {root_};
  {
    const std::lock_guard lock(mutex_);
    std::erase_if(places_, [&](const auto& place) {
      if (place.second.object) released.push_back(place.second.object);
      return place.second.object != nullptr;
    });
    generation_.fetch_add(1, std::memory_order_release);
  }
  for (const auto& object : released) detach_(*object);
}

}  // namespace rr::service
