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

  /// Adds a reference. Any thread may do so.
  void retain() noexcept { references_.fetch_add(1, std::memory_order_relaxed); }
  /// Gives up a reference; the last one destroys the memory. Any thread may do so.
  void release() noexcept {
    if (references_.fetch_sub(1, std::memory_order_acq_rel) == 1) destroy();
  }
  /// Whether there is one reference only, whose holder may change the memory.
  [[nodiscard]] bool is_unique() const noexcept {
    return !is_read_only_ && references_.load(std::memory_order_acquire) == 1;
  }
  /// The bytes, if the holder of the only reference may write over them; empty if not.
  [[nodiscard]] virtual std::span<std::byte> storage() noexcept { return {}; }

 protected:
  /// Whether what is kept may be changed.
  enum class Use : std::uint8_t {
    read_write,  ///< by the holder of the only reference
    read_only,   ///< by nobody
  };
  /// Made with one reference, which a MemoryRef takes over.
  explicit Memory(Use use = Use::read_write) noexcept : is_read_only_(use == Use::read_only) {}
  ~Memory() = default;
  /// Frees this. Called once, on the thread that releases the last reference.
  virtual void destroy() noexcept = 0;  // frees this

 private:
  std::atomic<std::uint32_t> references_{1};
  const bool is_read_only_;
};

/// A counted reference to Memory; may be empty.
class MemoryRef {
 public:
  /// Refers to nothing.
  MemoryRef() = default;
  /// Takes over one reference.
  explicit MemoryRef(Memory* adopted) noexcept : memory_(adopted) {}
  /// Adds a reference.
  MemoryRef(const MemoryRef& other) noexcept : memory_(other.memory_) {
    if (memory_ != nullptr) memory_->retain();
  }
  /// Takes over the reference; `other` is empty afterwards.
  MemoryRef(MemoryRef&& other) noexcept : memory_(std::exchange(other.memory_, nullptr)) {}
  /// Refers to the same as `other`, and no longer to what it referred to.
  MemoryRef& operator=(MemoryRef other) noexcept {
    std::swap(memory_, other.memory_);
    return *this;
  }
  ~MemoryRef() {
    if (memory_ != nullptr) memory_->release();
  }

  /// Whether it refers to something.
  explicit operator bool() const noexcept { return memory_ != nullptr; }
  /// Whether this is the only reference, to memory that may be changed. False when it is empty.
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
  MemoryRef owner;             ///< keeps the bytes
  std::byte* bytes = nullptr;  ///< the first one
};

/// Allocates `size` bytes. Throws std::bad_alloc.
Allocation allocate(std::size_t size);

}  // namespace rr
