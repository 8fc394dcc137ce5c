// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include "rr/visibility.hpp"

namespace RR_VISIBLE rr {

/// Memory that several values keep alive together: a receive buffer that arrays are slices of, or
/// a sent array's owner. Counts references by itself, so that a handle is one pointer.
class Memory {
 public:
  Memory(const Memory&) = delete;
  Memory& operator=(const Memory&) = delete;

  void retain() noexcept { references_.fetch_add(1, std::memory_order_relaxed); }
  void release() noexcept {
    if (references_.fetch_sub(1, std::memory_order_acq_rel) == 1) destroy();
  }
  [[nodiscard]] bool is_unique() const noexcept {
    return references_.load(std::memory_order_acquire) == 1;
  }
  /// The bytes, if whoever holds the only reference may write over them; empty if not.
  [[nodiscard]] virtual std::span<std::byte> storage() noexcept { return {}; }

 protected:
  Memory() = default;
  ~Memory() = default;
  virtual void destroy() noexcept = 0;  // frees this

 private:
  std::atomic<std::uint32_t> references_{1};
};

/// A counted reference to Memory; may be empty.
class MemoryRef {
 public:
  MemoryRef() = default;
  /// Takes over one reference.
  explicit MemoryRef(Memory* adopted) noexcept : memory_(adopted) {}
  MemoryRef(const MemoryRef& other) noexcept : memory_(other.memory_) {
    if (memory_ != nullptr) memory_->retain();
  }
  MemoryRef(MemoryRef&& other) noexcept : memory_(std::exchange(other.memory_, nullptr)) {}
  MemoryRef& operator=(MemoryRef other) noexcept {
    std::swap(memory_, other.memory_);
    return *this;
  }
  ~MemoryRef() {
    if (memory_ != nullptr) memory_->release();
  }

  explicit operator bool() const noexcept { return memory_ != nullptr; }
  [[nodiscard]] bool is_unique() const noexcept {
    return memory_ != nullptr && memory_->is_unique();
  }
  /// The bytes, if this is the only reference and they may be written over; empty if not.
  [[nodiscard]] std::span<std::byte> own_storage() const noexcept {
    return is_unique() ? memory_->storage() : std::span<std::byte>();
  }

 private:
  Memory* memory_ = nullptr;
};

/// Raw bytes on the heap, for a received message or an array's items. `bytes` is aligned to 16.
struct Allocation {
  MemoryRef owner;
  std::byte* bytes = nullptr;
};

/// Allocates `size` bytes. Throws std::bad_alloc.
Allocation allocate(std::size_t size);

}  // namespace rr
