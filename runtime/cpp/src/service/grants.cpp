// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/service/grants.hpp"

#include "runtime/cpp/src/service/rights_line.hpp"

namespace rr::service {
namespace {

// A client may ask for any names: what is remembered for it is small.
constexpr std::size_t known_members = 256;
constexpr std::size_t known_name = 256;  // bytes

}  // namespace

Grants::Grants(std::shared_ptr<const Rights> rights, const User* user)
    : rights_(std::move(rights)) {
  for (const Rights::Line& line : rights_->rr_lines()) {
    if (line.concerns(user)) lines_.push_back(&line);
  }
}

RightSet Grants::of(std::string_view path, std::string_view member) const {
  {
    const MutexLock lock(mutex_);
    const auto found = known_.find(KeyView(path, member));
    if (found != known_.end()) return found->second;
  }
  const RightSet rights = decide(lines_, path, member);
  if (path.size() + member.size() <= known_name) {
    const MutexLock lock(mutex_);
    if (known_.size() >= known_members) known_.clear();
    known_.emplace(Key(path, member), rights);
  }
  return rights;
}

}  // namespace rr::service
