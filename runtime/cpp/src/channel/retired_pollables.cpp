// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/channel/retired_pollables.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace rr::channel {

bool RetiredPollables::add(std::shared_ptr<Pollable>&& pollable) {
  if (has_ended_) return false;
  retired_.push_back(std::move(pollable));
  return true;
}

void RetiredPollables::leave(const Pollable* pollable) {
  inside_.erase(std::find(inside_.begin(), inside_.end(), pollable));
}

RetiredPollables::Pollables RetiredPollables::take() {
  const auto is_inside = [&](const auto& pollable) {
    return std::find(inside_.begin(), inside_.end(), pollable.get()) != inside_.end();
  };
  const auto kept = std::partition(retired_.begin(), retired_.end(), is_inside);
  Pollables retired(std::make_move_iterator(kept), std::make_move_iterator(retired_.end()));
  retired_.erase(kept, retired_.end());
  return retired;
}

RetiredPollables::Pollables RetiredPollables::end() {
  has_ended_ = true;
  return std::exchange(retired_, {});
}

}  // namespace rr::channel
