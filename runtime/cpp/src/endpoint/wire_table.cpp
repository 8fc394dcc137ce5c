// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/endpoint/wire_table.hpp"

#include <utility>

#include "runtime/cpp/src/endpoint/service_path.hpp"

namespace rr::endpoint {

WireTable::End WireTable::find(std::string_view path, std::string_view member) const {
  const MutexLock lock(mutex_);
  if (ends_.empty()) return nullptr;
  const auto found = ends_.find(Key{path, member});
  return found == ends_.end() ? nullptr : found->second;
}

WireTable::Added WireTable::add(const End& end) {
  const MutexLock lock(mutex_);
  if (is_ended_) return Added::ended;
  return ends_.try_emplace(Key{end->path(), end->member().name}, end).second ? Added::yes
                                                                             : Added::exists;
}

void WireTable::remove(const WireEnd::State& end) {
  End removed;  // freed outside of the lock
  const MutexLock lock(mutex_);
  const auto found = ends_.find(Key{end.path(), end.member().name});
  if (found == ends_.end() || found->second.get() != &end) return;
  removed = std::move(found->second);
  ends_.erase(found);
}

std::vector<WireTable::End> WireTable::all() const {
  std::vector<End> found;
  const MutexLock lock(mutex_);
  found.reserve(ends_.size());
  for (const auto& item : ends_) found.push_back(item.second);
  return found;
}

std::vector<WireTable::End> WireTable::take_below(std::string_view path, const Choice& is_taken) {
  std::vector<End> taken;
  const MutexLock lock(mutex_);
  std::erase_if(ends_, [&](const auto& item) {
    if (!is_at_or_below(item.first.path, path)) return false;
    if (is_taken && !is_taken(*item.second)) return false;
    taken.push_back(item.second);
    return true;
  });
  return taken;
}

std::vector<WireTable::End> WireTable::take_all() {
  std::vector<End> taken;
  const MutexLock lock(mutex_);
  is_ended_ = true;
  for (const auto& item : ends_) taken.push_back(item.second);
  ends_.clear();
  return taken;
}

}  // namespace rr::endpoint
