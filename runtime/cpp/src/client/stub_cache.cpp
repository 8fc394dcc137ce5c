// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/client/stub_cache.hpp"

#include <utility>

#include "runtime/cpp/src/endpoint/service_path.hpp"

namespace rr::client {

StubCache::Lookup::Lookup(StubCache& cache, std::string path)
    : cache_(cache), path_(std::move(path)) {
  const MutexLock lock(cache_.mutex_);
  cache_.lookups_.push_back(this);
}

StubCache::Lookup::~Lookup() {
  const MutexLock lock(cache_.mutex_);
  std::erase(cache_.lookups_, this);
}

std::shared_ptr<Stub> StubCache::find(const std::string& path) {
  const MutexLock lock(mutex_);
  const auto found = stubs_.find(path);
  return found == stubs_.end() ? nullptr : found->second.lock();
}

std::shared_ptr<Stub> StubCache::keep(const std::string& path, const std::shared_ptr<Stub>& stub) {
  const MutexLock lock(mutex_);
  return keep_locked(path, stub);
}

std::shared_ptr<Stub> StubCache::keep(const Lookup& lookup, const std::shared_ptr<Stub>& stub) {
  const MutexLock lock(mutex_);
  lookup.cache_.mutex_.assert_held();  // this one's
  return lookup.is_outdated_ ? nullptr : keep_locked(lookup.path_, stub);
}

std::shared_ptr<Stub> StubCache::keep_locked(const std::string& path,
                                             const std::shared_ptr<Stub>& stub) {
  std::weak_ptr<Stub>& kept = stubs_[path];
  if (auto other = kept.lock()) return other;  // somebody was faster
  kept = stub;
  return stub;
}

void StubCache::release(std::string_view path, std::string_view root) {
  const MutexLock lock(mutex_);
  std::erase_if(stubs_, [&](const auto& item) {
    return endpoint::is_at_or_below(item.first, path) && item.first != root;
  });
  for (Lookup* const lookup : lookups_) {
    lookup->cache_.mutex_.assert_held();
    if (endpoint::is_at_or_below(lookup->path_, path)) lookup->is_outdated_ = true;
  }
}

void StubCache::forget(const Stub& stub) {
  const MutexLock lock(mutex_);
  const auto kept = stubs_.find(stub.rr_path());
  if (kept != stubs_.end() && kept->second.expired()) stubs_.erase(kept);
}

void StubCache::clear() {
  const MutexLock lock(mutex_);
  stubs_.clear();
}

}  // namespace rr::client
