// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>

#include "rr/array_type.hpp"
#include "rr/definition.hpp"
#include "runtime/c/include/rr.h"

/// What memories are of.
namespace rr::capi {

/// The type of a memory: of numbers that of C++; of pods and namedarrays one that says how long
/// items are in requests, but does not know them.
class MemoryItems {
 public:
  /// Throws rr::Error (invalid_argument).
  explicit MemoryItems(const rr_memory_type& memory);
  MemoryItems(const MemoryItems&) = delete;
  MemoryItems& operator=(const MemoryItems&) = delete;

  [[nodiscard]] const Type& type() const;
  /// Bytes of one number; 0 for pods and namedarrays.
  [[nodiscard]] std::size_t item_size() const { return number_ != nullptr ? item_size_ : 0; }
  [[nodiscard]] bool is_multi() const { return is_multi_; }

 private:
  const bool is_multi_;
  std::size_t item_size_ = 0;
  const Type* number_ = nullptr;
  const ItemType record_;
  const ArrayType array_;
  const MultiArrayType multi_array_;
};

}  // namespace rr::capi
