// SPDX-License-Identifier: Apache-2.0
#include "rr/buffer.hpp"

#include <new>

namespace rr {
namespace {

// Sits in front of the bytes it owns, in one allocation.
class alignas(16) HeapMemory final : public Memory {
 public:
  explicit HeapMemory(std::size_t size) : size_(size) {}
  [[nodiscard]] std::span<std::byte> storage() noexcept override {
    return {reinterpret_cast<std::byte*>(this + 1), size_};
  }

 private:
  ~HeapMemory() = default;
  void destroy() noexcept override {
    this->~HeapMemory();
    ::operator delete(this);
  }

  std::size_t size_;
};
static_assert(sizeof(HeapMemory) % 16 == 0);
static_assert(__STDCPP_DEFAULT_NEW_ALIGNMENT__ >= alignof(HeapMemory));

}  // namespace

Allocation allocate(std::size_t size) {
  if (size > SIZE_MAX - sizeof(HeapMemory)) throw std::bad_alloc();
  void* block = ::operator new(sizeof(HeapMemory) + size);
  auto* memory = ::new (block) HeapMemory(size);
  return {MemoryRef(memory), static_cast<std::byte*>(block) + sizeof(HeapMemory)};
}

}  // namespace rr
