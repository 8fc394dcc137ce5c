// SPDX-License-Identifier: Apache-2.0
#include "gateway/value_claim.hpp"

#include <utility>

#include "gateway/properties.hpp"

namespace rr::gateway {
namespace {

constexpr std::chrono::seconds between_wishes{1};

}  // namespace

void ValueClaim::disconnected() {
  is_connected_ = false;
  other_is_up_ = false;
}

void ValueClaim::take(const Message& life) {
  other_is_up_ = text_of(life.payload) == "up" && !claim_.is_mine(life);
}

bool ValueClaim::update() {
  const NodeClaim::State state = claim_.state();
  const bool may_hold = is_connected_ && !other_is_up_ && state != NodeClaim::State::refused;
  const bool before =
      std::exchange(allows_, may_hold && (allows_ || state == NodeClaim::State::holding));
  return allows_ && !before;
}

bool ValueClaim::wants_life(Clock::time_point now) {
  const bool is_disputed = other_is_up_ && claim_.state() == NodeClaim::State::holding;
  if (!is_disputed || now - wanted_ < between_wishes) return false;
  wanted_ = now;
  return true;
}

}  // namespace rr::gateway
