// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstring>
#include <source_location>
#include <span>

/// The memory orders of the lines that a model runs, and one of them that is weaker than it is
/// written.
namespace rr::models {

/// A use of an atomic word.
struct OrderedUse {
  const char* file = nullptr;
  unsigned line = 0;
  unsigned column = 0;
  std::memory_order order = std::memory_order_relaxed;  ///< as written

  friend bool operator==(const OrderedUse& one, const OrderedUse& other) {
    return one.line == other.line && one.column == other.column && one.order == other.order &&
           std::strcmp(one.file, other.file) == 0;
  }
};

/// Without memory from the heap, which is the model's.
class Orders {
 public:
  static Orders& current() {
    static Orders orders;
    return orders;
  }

  /// Collects uses with an order from now on.
  void begin() {
    count_ = 0;
    is_collecting_ = true;
  }
  /// What has been collected.
  std::span<const OrderedUse> end() {
    is_collecting_ = false;
    return {uses_.data(), count_};
  }
  /// This use has the order `weaker` from now on.
  void weaken(const OrderedUse& use, std::memory_order weaker) {
    weak_ = use;
    weaker_ = weaker;
  }
  void weaken_none() { weak_ = {}; }

  /// The order that a use is to have.
  std::memory_order of(std::memory_order order, const std::source_location& source) {
    if (!is_collecting_ && weak_.file == nullptr) return order;
    const OrderedUse use{source.file_name(), source.line(), source.column(), order};
    if (is_collecting_) note(use);
    return weak_.file != nullptr && use == weak_ ? weaker_ : order;
  }

 private:
  void note(const OrderedUse& use) {
    if (use.order == std::memory_order_relaxed) return;
    for (std::size_t i = 0; i < count_; ++i) {
      if (uses_[i] == use) return;
    }
    if (count_ != uses_.size()) uses_[count_++] = use;
  }

  std::array<OrderedUse, 128> uses_;
  std::size_t count_ = 0;
  bool is_collecting_ = false;
  OrderedUse weak_;
  std::memory_order weaker_ = std::memory_order_relaxed;
};

}  // namespace rr::models
