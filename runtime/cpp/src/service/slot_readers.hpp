// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "runtime/cpp/src/channel/slot_budget.hpp"
#include "runtime/cpp/src/channel/wire_slots.hpp"

namespace rr::service {

class ServedWireEnd;

/// The memory in which the values of one wire are published, and the ends whose clients read them
/// there. Guarded by the wire's lock.
class SlotReaders {
 public:
  /// Null: there is none, and no end is here.
  [[nodiscard]] const std::shared_ptr<channel::SlotWriter>& memory() const { return memory_; }
  [[nodiscard]] bool is_empty() const { return readers_.empty(); }
  [[nodiscard]] bool has(const ServedWireEnd& end) const { return find(end) != readers_.size(); }

  /// Whether somebody who leaves, or has left, may lose the right to read: then those who stay are
  /// to have another memory.
  [[nodiscard]] bool has_restricted() const;

  /// Adds an end, with a memory for values of so many bytes if there is none. False, and nothing
  /// happens, when one of the budgets has no room for that, or the system no memory.
  /// `is_restricted`: its service has users or rights.
  bool add(const ServedWireEnd& end, bool is_restricted, std::size_t value_size,
           const std::shared_ptr<channel::SlotBudget>& of_node,
           const std::shared_ptr<channel::SlotBudget>& of_session);
  /// The words by which the client of an end that is here says what it uses; null for none.
  [[nodiscard]] const std::shared_ptr<channel::ServedHolds>& holds(const ServedWireEnd& end) const {
    return readers_[find(end)].holds;
  }
  /// Whether the client of an end that is here wants to be woken.
  void set_woken(const ServedWireEnd& end, bool is_woken);
  /// False when it was not here.
  bool remove(const ServedWireEnd& end);
  /// Forgets all, and the memory, which the caller ends under no lock. Null when there was none.
  std::shared_ptr<channel::SlotWriter> clear();

 private:
  struct Reader {
    const ServedWireEnd* end = nullptr;
    bool is_restricted = false;
    bool is_woken = false;
    channel::SlotShare share;  // of its session
    std::shared_ptr<channel::ServedHolds> holds;
  };
  [[nodiscard]] std::size_t find(const ServedWireEnd& end) const;
  bool make(std::size_t value_size, const std::shared_ptr<channel::SlotBudget>& of_node);

  std::shared_ptr<channel::SlotWriter> memory_;
  std::vector<Reader> readers_;
};

}  // namespace rr::service
