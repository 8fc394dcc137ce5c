// SPDX-License-Identifier: Apache-2.0
#include "runtime/matlab/src/handles.hpp"

#include <utility>

namespace rr::matlab {

std::uint64_t Handles::add(std::shared_ptr<Handled> object) {
  std::size_t index = places_.size();
  if (free_.empty()) {
    places_.emplace_back();
  } else {
    index = free_.back();
    free_.pop_back();
  }
  places_[index] = {++generation_, std::move(object)};
  return std::uint64_t{places_[index].generation} << 32 | index;
}

std::shared_ptr<Handled> Handles::find(std::uint64_t number) const {
  const std::size_t index = index_of(number);
  if (index >= places_.size() || places_[index].generation != number >> 32) return nullptr;
  return places_[index].object;
}

void Handles::remove(std::uint64_t number) {
  if (!find(number)) return;
  Place& place = places_[index_of(number)];
  place.generation = 0;
  // Its end may come back here.
  const std::shared_ptr<Handled> object = std::exchange(place.object, nullptr);
  free_.push_back(index_of(number));
}

void Handles::clear() {
  for (std::size_t index = 0; index < places_.size(); ++index) {
    if (places_[index].object) remove(std::uint64_t{places_[index].generation} << 32 | index);
  }
}

std::size_t Handles::size() const { return places_.size() - free_.size(); }

void Handles::refuse() {
  throw Error(ErrorCode::invalid_operation, "the object is closed, or was never opened");
}

}  // namespace rr::matlab
