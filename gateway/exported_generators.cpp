// SPDX-License-Identifier: Apache-2.0
#include "gateway/exported_generators.hpp"

#include <utility>
#include <vector>

#include "gateway/properties.hpp"

namespace rr::gateway {

std::string ExportedGenerators::add(const std::string& user, ExportedGenerator generator,
                                    Clock::time_point now) {
  std::string name = random_hex();
  const MutexLock lock(mutex_);
  open_[name] = {user, std::move(generator), now};
  return name;
}

std::optional<ExportedGenerator> ExportedGenerators::find(const std::string& user,
                                                          const std::string& name,
                                                          Clock::time_point now) {
  const MutexLock lock(mutex_);
  const auto found = open_.find(name);
  if (found == open_.end() || found->second.user != user) return std::nullopt;
  found->second.used = now;
  return found->second.generator;
}

void ExportedGenerators::remove(const std::string& name) {
  // A handle sends a request to the service when it is destroyed; not under the lock.
  const auto removed = [&] {
    const MutexLock lock(mutex_);
    return open_.extract(name);
  }();
}

void ExportedGenerators::end_idle(Clock::time_point now, Clock::duration idle) {
  std::vector<dynamic::Generator> ended;
  {
    const MutexLock lock(mutex_);
    std::erase_if(open_, [&](auto& entry) {
      if (now - entry.second.used < idle) return false;
      ended.push_back(std::move(entry.second.generator.generator));
      return true;
    });
  }
  for (dynamic::Generator& generator : ended) generator.async_abort([](std::exception_ptr) {});
}

}  // namespace rr::gateway
