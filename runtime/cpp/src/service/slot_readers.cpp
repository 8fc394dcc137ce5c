// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/service/slot_readers.hpp"

#include <algorithm>
#include <utility>

#include "runtime/cpp/src/service/counted_memory.hpp"
#include "runtime/cpp/src/service/served_wire_end.hpp"

namespace rr::service {
std::size_t SlotReaders::find(const ServedWireEnd& end) const {
  const auto found = std::find_if(readers_.begin(), readers_.end(),
                                  [&](const Reader& reader) { return reader.end == &end; });
  return static_cast<std::size_t>(found - readers_.begin());
}

bool SlotReaders::make(std::size_t value_size,
                       const std::shared_ptr<channel::SlotBudget>& of_node) {
  const auto sizes = channel::SlotSizes::for_value(value_size);
  if (sizes.slot == 0) return false;
  memory_ = make_counted<channel::SlotWriter>(of_node, sizes.memory(), sizes);
  return memory_ != nullptr;
}

bool SlotReaders::has_restricted() const {
  return std::any_of(readers_.begin(), readers_.end(),
                     [](const Reader& reader) { return reader.is_restricted; });
}

bool SlotReaders::add(const ServedWireEnd& end, bool is_restricted, std::size_t value_size,
                      const std::shared_ptr<channel::SlotBudget>& of_node,
                      const std::shared_ptr<channel::SlotBudget>& of_session) {
  if (!memory_ && !make(value_size, of_node)) return false;
  channel::SlotShare share(of_session, memory_->sizes().memory());
  if (!share.is_drawn()) {
    if (readers_.empty()) memory_.reset();
    return false;
  }
  std::shared_ptr<channel::ServedHolds> holds;
  if (memory_->sizes().are_large()) holds = end.draw_holds();
  if (holds) memory_->add_holds(holds);
  readers_.push_back({&end, is_restricted, false, std::move(share), std::move(holds)});
  return true;
}

void SlotReaders::set_woken(const ServedWireEnd& end, bool is_woken) {
  const std::size_t place = find(end);
  if (place == readers_.size() || readers_[place].is_woken == is_woken) return;
  readers_[place].is_woken = is_woken;
  if (is_woken) {
    memory_->add_sleeper();
  } else {
    memory_->remove_sleeper();
  }
}

bool SlotReaders::remove(const ServedWireEnd& end) {
  const std::size_t place = find(end);
  if (place == readers_.size()) return false;
  set_woken(end, false);
  if (const auto& holds = readers_[place].holds) memory_->remove_holds(*holds);
  readers_.erase(readers_.begin() + static_cast<std::ptrdiff_t>(place));
  if (readers_.empty()) memory_.reset();
  return true;
}

std::shared_ptr<channel::SlotWriter> SlotReaders::clear() {
  readers_.clear();
  return std::exchange(memory_, nullptr);
}

}  // namespace rr::service
