// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "rr/definition.hpp"
#include "rr/skeleton.hpp"
#include "runtime/cpp/src/endpoint/service_path.hpp"
#include "runtime/cpp/src/service/member_index.hpp"

namespace rr::service {

/// An object at its path.
struct ServedObject {
  std::string path;  ///< canonical
  std::shared_ptr<Skeleton> skeleton;
  const ObjectType* type = nullptr;
  const MemberIndex* members = nullptr;
};

/// The objects of a service by their paths. They are found when first asked for, each through its
/// parent's objref, and kept until released. No user code runs under the lock.
class ObjectTree {
 public:
  /// `attach` is called for each object that joins, `detach` when it goes.
  using Notice = std::function<void(const ServedObject&)>;
  ObjectTree(std::string root_name, std::shared_ptr<Skeleton> root, Notice attach, Notice detach);

  /// Finds the object, perhaps by asking its ancestors, which is user code. Throws rr::Error, and
  /// what user code throws.
  std::shared_ptr<const ServedObject> find(std::string_view path);
  [[nodiscard]] const std::shared_ptr<const ServedObject>& root() const { return root_; }

  /// Forgets the object and those below. False when none is known there.
  bool release(std::string_view path);
  void clear();

  /// Changes when an object is forgotten: what was found before may be used while it stays.
  [[nodiscard]] std::uint32_t generation() const {
    return generation_.load(std::memory_order_acquire);
  }

 private:
  struct Place {
    std::shared_ptr<const ServedObject> object;  // null while a thread looks for it
  };

  std::shared_ptr<const ServedObject> find_known(const std::string& path, bool& must_look);
  std::shared_ptr<const ServedObject> look_up(const ServedObject& parent,
                                              const endpoint::PathSegment& segment,
                                              const std::string& path);
  void settle(const std::string& path, std::shared_ptr<const ServedObject> object);
  const MemberIndex& members_of(const ObjectType& type);

  std::shared_ptr<const ServedObject> root_;
  const Notice attach_;
  const Notice detach_;
  std::atomic<std::uint32_t> generation_{0};
  std::mutex mutex_;
  std::condition_variable settled_;
  std::unordered_map<std::string, Place> places_;  // all but the root
  std::map<const ObjectType*, std::unique_ptr<MemberIndex>> indexes_;
};

}  // namespace rr::service
