// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/endpoint/pipe_table.hpp"

#include <limits>

#include "runtime/cpp/src/endpoint/service_path.hpp"

namespace rr::endpoint {

[[gnu::hot]] PipeTable::End PipeTable::find(std::string_view path, std::string_view member,
                                            std::int32_t index) {
  if (last_ && last_->identity.index == index && last_->identity.member->name == member &&
      last_->identity.path == path) {
    return last_;
  }
  const auto pipe = pipes_.find(KeyView(path, member));
  if (pipe == pipes_.end()) return nullptr;
  const auto end = pipe->second.find(index);
  if (end == pipe->second.end()) return nullptr;
  last_ = end->second;
  return last_;
}

bool PipeTable::add(End end) {
  const PipeEnd::State::Identity& what = end->identity;
  Ends& ends = pipes_[Key(what.path, what.member->name)];
  if (!ends.emplace(what.index, std::move(end)).second) return false;
  ++size_;
  return true;
}

bool PipeTable::remove(const PipeEnd::State& end) {
  if (last_.get() == &end) last_.reset();
  const PipeEnd::State::Identity& what = end.identity;
  const auto pipe = pipes_.find(KeyView(what.path, what.member->name));
  if (pipe == pipes_.end()) return false;
  const auto found = pipe->second.find(what.index);
  if (found == pipe->second.end() || found->second.get() != &end) return false;
  pipe->second.erase(found);
  if (pipe->second.empty()) pipes_.erase(pipe);
  --size_;
  return true;
}

std::vector<PipeTable::End> PipeTable::take(const std::function<bool(const Key&)>& holds) {
  std::vector<End> taken;
  last_.reset();
  std::erase_if(pipes_, [&](auto& pipe) {
    if (!holds(pipe.first)) return false;
    for (auto& end : pipe.second) taken.push_back(std::move(end.second));
    return true;
  });
  size_ -= taken.size();
  return taken;
}

std::vector<PipeTable::End> PipeTable::take_below(std::string_view path) {
  return take([path](const Key& key) { return is_at_or_below(key.first, path); });
}

std::vector<PipeTable::End> PipeTable::take_all() {
  return take([](const Key&) { return true; });
}

std::vector<PipeTable::End> PipeTable::all() const {
  std::vector<End> found;
  found.reserve(size_);
  for (const auto& [key, ends] : pipes_) {
    for (const auto& [index, end] : ends) found.push_back(end);
  }
  return found;
}

std::optional<std::int32_t> PipeTable::choose(std::string_view path, std::string_view member,
                                              std::int32_t wanted) {
  std::int32_t index = wanted;
  const auto pipe = pipes_.find(KeyView(path, member));
  if (pipe != pipes_.end()) {
    for (const auto& [taken, end] : pipe->second) {
      if (taken < index) continue;
      if (taken == std::numeric_limits<std::int32_t>::max()) return std::nullopt;
      index = taken + 1;
    }
  }
  return index == -1 ? 1 : index;
}

}  // namespace rr::endpoint
