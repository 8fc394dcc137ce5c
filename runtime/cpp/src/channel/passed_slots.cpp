// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/channel/passed_slots.hpp"

#include <algorithm>
#include <system_error>
#include <utility>

namespace rr::channel {

void PassedSlots::add(const platform::Descriptor& handle) {
  std::error_code error;
  auto reader = SlotReader::open(handle, error);
  if (!reader) return;
  if (readers_.size() == most) readers_.pop_front();
  readers_.push_back(std::move(reader));
}

std::unique_ptr<SlotReader> PassedSlots::take(std::uint64_t id) {
  const auto found = std::find_if(readers_.begin(), readers_.end(),
                                  [&](const auto& reader) { return reader->id() == id; });
  if (found == readers_.end()) return nullptr;
  std::unique_ptr<SlotReader> reader = std::move(*found);
  readers_.erase(found);
  return reader;
}

}  // namespace rr::channel
