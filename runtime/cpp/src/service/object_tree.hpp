// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "rr/definition.hpp"
#include "rr/mutex.hpp"
#include "rr/skeleton.hpp"
#include "runtime/cpp/src/channel/account.hpp"
#include "runtime/cpp/src/channel/time.hpp"
#include "runtime/cpp/src/endpoint/service_path.hpp"
#include "runtime/cpp/src/service/member_index.hpp"

namespace rr::service {

/// An object at its path.
struct ServedObject {
  std::string path;  ///< canonical
  std::shared_ptr<Skeleton> skeleton;
  const ObjectType* type = nullptr;
  const MemberIndex* members = nullptr;
  std::uint32_t owner = 0;  ///< the client whose own it is (per_client()); 0: of all
};

/// The objects of a service by their paths. They are found when first asked for, each through its
/// parent's objref, and kept until released. At one path there is an object of all clients, or one
/// for each of them; below a client's own object everything is that client's. No user code runs
/// under the lock.
///
/// Clients bring objects up, so there are only so many. Who has used an object is known while its
/// session lasts: what nobody uses any more gives way to others, and where many are left, at the
/// end of a session.
class ObjectTree {
 public:
  using Object = std::shared_ptr<const ServedObject>;
  using Released = std::vector<Object>;
  /// What the tree asks of its service.
  struct Notices {
    /// For each object that joins.
    std::function<void(const ServedObject&)> attach;
    /// Objects that had to give way.
    std::function<void(Released)> drop;
    /// Whether something keeps an object that nobody uses. Called under the lock.
    std::function<bool(const ServedObject&)> is_held;
  };
  /// At most `limit` objects besides the root, and as many as the account allows. `patience`: how
  /// long a request waits for an object that another one looks for.
  ObjectTree(std::string root_name, std::shared_ptr<Skeleton> root, std::size_t limit,
             std::shared_ptr<channel::Account> account, Notices notices,
             channel::Milliseconds patience);

  /// Finds the object as a client sees it, perhaps by asking its ancestors, which is user code.
  /// Whoever is no client (0) finds objects of all only. Throws rr::Error, out_of_system_resource
  /// where there are too many objects, and what user code throws.
  Object find(std::string_view path, std::uint32_t client);
  [[nodiscard]] const Object& root() const { return root_; }
  /// Objects that are known, the root among them.
  [[nodiscard]] std::size_t size() const {
    const MutexLock lock(mutex_);
    return size_ + 1;
  }

  // What is forgotten is returned, for the caller to let go of.
  /// The objects at a path and below, of whomever they are; nothing when none is known there.
  Released release(std::string_view path);
  /// A client's own; nothing when it has none at the path.
  Released release(std::string_view path, std::uint32_t client);
  Released release_all_of(std::uint32_t client);
  /// A client has left. While there are more than `limit` objects, those that nobody uses any more
  /// are forgotten.
  Released leave(std::uint32_t client, std::size_t limit);
  /// All, the root too, but not what is a client's own: that is released when the client has gone.
  Released clear();

  /// Changes when an object is forgotten: what was found before may be used while it stays.
  [[nodiscard]] std::uint32_t generation() const {
    return generation_.load(std::memory_order_acquire);
  }

 private:
  // Either an object of all, or what is clients' own; null while a thread looks for it.
  struct Place {
    Object object;
    std::map<std::uint32_t, Object> own;
    std::vector<std::uint32_t> users{};  // clients that have used the object of all; sorted
  };
  // What find_known() has found: an object, or that the caller has to look for it, as one of all or
  // as one of the client's own.
  struct Known {
    Object object;
    bool must_look = false;
    bool is_own = false;
  };

  void await_settlement(channel::Time deadline) RR_REQUIRES(mutex_);
  Known find_known(const std::string& path, std::uint32_t client, bool is_below_own);
  bool take_room(const std::string& path) RR_REQUIRES(mutex_);
  static void add_user(Place& place, std::uint32_t client);
  Object look_up(const ServedObject& parent, const endpoint::PathSegment& segment,
                 const std::string& path, std::uint32_t client, bool is_own);
  std::shared_ptr<ServedObject> make(const ServedObject& parent,
                                     const endpoint::PathSegment& segment, const std::string& path);
  void settle(const std::string& path, std::uint32_t client, bool is_own, Object object);
  template <class Condition>
  Released release_if(Condition condition) RR_REQUIRES(mutex_);
  Released release_unused() RR_REQUIRES(mutex_);
  void count_out(const std::string& path) RR_REQUIRES(mutex_);
  void take(Object& object, Released& released) RR_REQUIRES(mutex_);
  const MemberIndex& members_of(const ObjectType& type) RR_REQUIRES(mutex_);

  Object root_;
  const std::size_t limit_;
  const Notices notices_;
  const channel::Milliseconds patience_;
  std::atomic<std::uint32_t> generation_{0};
  mutable Mutex mutex_;
  Condition settled_;
  std::uint64_t settlements_ RR_GUARDED_BY(mutex_) = 0;
  std::size_t size_ RR_GUARDED_BY(mutex_) =
      0;  // objects besides the root, and those that are looked for
  std::size_t path_size_ RR_GUARDED_BY(mutex_) = 0;  // bytes of their paths
  channel::Charge charge_ RR_GUARDED_BY(mutex_);     // for them
  channel::Time next_sweep_
      RR_GUARDED_BY(mutex_){};  // what is not used is looked for then, or later
  std::unordered_map<std::string, Place> places_ RR_GUARDED_BY(mutex_);  // all but the root
  std::unordered_map<std::uint32_t, std::set<std::string>> own_paths_
      RR_GUARDED_BY(mutex_);  // of clients' own
  std::map<const ObjectType*, std::unique_ptr<MemberIndex>> indexes_ RR_GUARDED_BY(mutex_);
};

}  // namespace rr::service
