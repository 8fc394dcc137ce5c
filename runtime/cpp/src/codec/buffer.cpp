// SPDX-License-Identifier: Apache-2.0
#include "rr/buffer.hpp"

#include <new>
#include <utility>

#include "runtime/cpp/src/codec/large_allocations.hpp"
#include "runtime/cpp/src/codec/large_block.hpp"

namespace rr {
namespace {

// The address sanitizer watches the edges of what comes from the heap only.
#if defined(__SANITIZE_ADDRESS__)
constexpr bool has_large_blocks = false;
#elif defined(__has_feature)
constexpr bool has_large_blocks = !__has_feature(address_sanitizer);
#else
constexpr bool has_large_blocks = true;
#endif

constinit thread_local codec::LargeAllocations* watch = nullptr;

void tell_freed(std::size_t size) noexcept {
  if (size >= codec::smallest_large_block && watch != nullptr) watch->freed(size);
}

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
    tell_freed(size_);
    this->~HeapMemory();
    ::operator delete(this);
  }

  std::size_t size_;
};
static_assert(sizeof(HeapMemory) % 16 == 0);
static_assert(__STDCPP_DEFAULT_NEW_ALIGNMENT__ >= alignof(HeapMemory));

class LargeMemory final : public Memory {
 public:
  LargeMemory(codec::LargeBlock block, std::size_t size) : block_(block), size_(size) {}
  [[nodiscard]] std::span<std::byte> storage() noexcept override { return {block_.bytes, size_}; }

 private:
  ~LargeMemory() {
    codec::give_back_large_block(block_);
    tell_freed(size_);
  }
  void destroy() noexcept override { delete this; }

  const codec::LargeBlock block_;
  const std::size_t size_;
};

Allocation allocate_large(std::size_t size, codec::LargeBlock (*take)(std::size_t)) {
  const codec::LargeBlock block = take(size);
  try {
    return {MemoryRef(new LargeMemory(block, size)), block.bytes};
  } catch (const std::bad_alloc&) {
    codec::give_back_large_block(block);
    throw;
  }
}

bool is_large(std::size_t size) { return has_large_blocks && size >= codec::smallest_large_block; }

}  // namespace

Allocation codec::allocate_fresh(std::size_t size) {
  return is_large(size) ? allocate_large(size, codec::take_fresh_block) : allocate(size);
}

codec::WatchedThread::WatchedThread(LargeAllocations* next) noexcept
    : outer_(std::exchange(watch, next)) {}

codec::WatchedThread::~WatchedThread() { watch = outer_; }

Allocation allocate(std::size_t size) {
  if (size >= codec::smallest_large_block && watch != nullptr) watch->before(size);
  if (is_large(size)) return allocate_large(size, codec::take_large_block);
  if (size > SIZE_MAX - sizeof(HeapMemory)) throw std::bad_alloc();
  void* block = ::operator new(sizeof(HeapMemory) + size);
  auto* memory = ::new (block) HeapMemory(size);
  return {MemoryRef(memory), static_cast<std::byte*>(block) + sizeof(HeapMemory)};
}

}  // namespace rr
