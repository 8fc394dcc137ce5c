// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/channel/slot_holds.hpp"

#include <utility>

namespace rr::channel {

std::size_t ServedHolds::count() const {
  std::size_t count = 0;
  for (std::size_t slot = 0; slot < most_slots; ++slot) count += has(slot) ? 1 : 0;
  return count;
}

std::shared_ptr<ServedHolds> HoldPool::draw() {
  for (std::uint32_t place = 0; place < HoldPlaces::count; ++place) {
    const std::uint64_t bit = std::uint64_t{1} << place;
    if ((drawn_->fetch_or(bit) & bit) != 0) continue;
    return std::make_shared<ServedHolds>(std::shared_ptr<const Words>(first_, first_.get() + place),
                                         place, drawn_);
  }
  return nullptr;
}

// The reader before may have left numbers.
SlotHolds::SlotHolds(std::shared_ptr<Words> words) : words_(std::move(words)) {
  for (std::size_t slot = 0; slot < most_slots; ++slot) words_->leave(slot);
}

bool SlotHolds::hold(std::size_t slot, std::uint64_t number) {
  const MutexLock lock(mutex_);
  if (!words_ || used_ == most) return false;
  // A service that has published into a slot that is used does not keep to the rules.
  if (words_->are_used(slot)) return false;
  words_->use(slot, number);
  ++used_;
  return true;
}

void SlotHolds::release(std::size_t slot) {
  const MutexLock lock(mutex_);
  if (!words_) return;
  words_->leave(slot);
  --used_;
}

void SlotHolds::detach() {
  const MutexLock lock(mutex_);
  words_.reset();
}

}  // namespace rr::channel
