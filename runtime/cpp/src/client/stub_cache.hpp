// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "rr/mutex.hpp"
#include "rr/stub.hpp"

namespace rr::client {

/// The stubs of a session by the paths of their objects: there is one for each. It owns none.
class StubCache {
 public:
  /// A question for the type of an object, from before it is asked until the stub is kept. When the
  /// object is released meanwhile, the answer may be of the object that was there before.
  class Lookup {
   public:
    Lookup(StubCache& cache, std::string path);
    ~Lookup();
    Lookup(const Lookup&) = delete;
    Lookup& operator=(const Lookup&) = delete;

    [[nodiscard]] const std::string& path() const { return path_; }

   private:
    friend class StubCache;
    StubCache& cache_;
    const std::string path_;
    bool is_outdated_ RR_GUARDED_BY(cache_.mutex_) = false;  // under the cache's lock
  };

  StubCache() = default;
  StubCache(const StubCache&) = delete;
  StubCache& operator=(const StubCache&) = delete;

  /// Null when there is none.
  std::shared_ptr<Stub> find(const std::string& path);
  /// Keeps the stub of a path and returns it, or the one that is there already.
  std::shared_ptr<Stub> keep(const std::string& path, const std::shared_ptr<Stub>& stub);
  /// The same for what was looked up: null when the object was released since.
  std::shared_ptr<Stub> keep(const Lookup& lookup, const std::shared_ptr<Stub>& stub);
  /// The object at a path is released, and all below it; the one at `root` never is.
  void release(std::string_view path, std::string_view root);
  /// A stub goes away.
  void forget(const Stub& stub);
  /// The session has ended.
  void clear();

 private:
  std::shared_ptr<Stub> keep_locked(const std::string& path, const std::shared_ptr<Stub>& stub)
      RR_REQUIRES(mutex_);

  Mutex mutex_;
  std::unordered_map<std::string, std::weak_ptr<Stub>> stubs_ RR_GUARDED_BY(mutex_);
  std::vector<Lookup*> lookups_ RR_GUARDED_BY(mutex_);
};

}  // namespace rr::client
