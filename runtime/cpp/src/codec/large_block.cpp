// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/codec/large_block.hpp"

#include <algorithm>
#include <array>
#include <new>
#include <thread>
#include <utility>

#include "rr/mutex.hpp"
#include "runtime/cpp/src/platform/memory.hpp"

namespace rr::codec {
namespace {

using platform::page_size;

std::size_t whole_pages(std::size_t size) {
  const std::size_t whole = (size + page_size - 1) / page_size * page_size;
  if (whole < size) throw std::bad_alloc();
  return whole;
}

// Unmapping some MiB takes milliseconds and cannot be interrupted: other threads run between its
// parts.
void give_to_system(LargeBlock block) noexcept {
  if (block.bytes == nullptr) return;
  constexpr std::size_t part = std::size_t{512} * 1024;
  while (block.size > part) {
    platform::unmap_pages(block.bytes, block.size, block.size - part);
    block.size -= part;
    std::this_thread::yield();
  }
  platform::unmap_pages(block.bytes, block.size, 0);
}

// Blocks that were given back, the latest first.
class SpareBlocks {
 public:
  // One that fits and is not much larger; none if there is no such.
  LargeBlock take(std::size_t size) {
    const MutexLock lock(mutex_);
    const auto found = std::find_if(spares_.begin(), spares_.end(), [size](const Spare& spare) {
      return spare.block.size >= size && spare.block.size - size <= size / 4;
    });
    if (found == spares_.end()) return {};
    const LargeBlock taken = found->block;
    std::move(found + 1, spares_.end(), found);
    spares_.back() = {};
    bytes_ -= taken.size;
    return taken;
  }

  void keep(LargeBlock block) {
    Spares dropped{};
    {
      const MutexLock lock(mutex_);
      for (std::size_t i = most_blocks; i-- != 0;) {
        if (i + 1 != most_blocks && bytes_ + block.size <= most_spare_bytes) break;
        drop(i, dropped);
      }
      std::move_backward(spares_.begin(), spares_.end() - 1, spares_.end());
      spares_.front() = {block, true};
      bytes_ += block.size;
    }
    unmap(dropped);
  }

  // Drops what is not young. True when some are left, which are not young any more.
  bool age() {
    Spares dropped{};
    bool is_any_left = false;
    {
      const MutexLock lock(mutex_);
      for (std::size_t i = 0; i < most_blocks; ++i) {
        if (!std::exchange(spares_[i].is_young, false)) drop(i, dropped);
      }
      is_any_left = bytes_ != 0;
    }
    unmap(dropped);
    return is_any_left;
  }

  void drop_all() {
    Spares dropped{};
    {
      const MutexLock lock(mutex_);
      if (bytes_ == 0) return;
      for (std::size_t i = 0; i < most_blocks; ++i) drop(i, dropped);
    }
    unmap(dropped);
  }

  std::size_t bytes() {
    const MutexLock lock(mutex_);
    return bytes_;
  }

 private:
  struct Spare {
    LargeBlock block;
    bool is_young = false;
  };
  static constexpr std::size_t most_blocks = 8;
  using Spares = std::array<Spare, most_blocks>;

  void drop(std::size_t i, Spares& dropped) RR_REQUIRES(mutex_) {
    bytes_ -= spares_[i].block.size;
    dropped[i] = std::exchange(spares_[i], {});
  }
  // Without the lock: it takes time.
  static void unmap(const Spares& spares) {
    for (const Spare& spare : spares) give_to_system(spare.block);
  }

  Mutex mutex_;
  Spares spares_ RR_GUARDED_BY(mutex_){};
  std::size_t bytes_ RR_GUARDED_BY(mutex_) = 0;
};

// Arrays may be freed while the program ends: it is not destroyed.
SpareBlocks& spare_blocks() {
  alignas(SpareBlocks) static std::array<std::byte, sizeof(SpareBlocks)> room;
  static auto* const blocks = new (room.data()) SpareBlocks;
  return *blocks;
}

}  // namespace

LargeBlock take_large_block(std::size_t size) {
  if (const LargeBlock spare = spare_blocks().take(whole_pages(size)); spare.bytes != nullptr) {
    return spare;
  }
  return take_fresh_block(size);
}

LargeBlock take_fresh_block(std::size_t size) {
  const std::size_t whole = whole_pages(size);
  std::byte* const bytes = platform::map_pages(whole);
  if (bytes == nullptr) throw std::bad_alloc();
  return {bytes, whole};
}

void give_back_large_block(LargeBlock block) noexcept {
  if (block.size > most_spare_bytes) {
    give_to_system(block);
  } else {
    spare_blocks().keep(block);
  }
}

bool age_spare_blocks() noexcept { return spare_blocks().age(); }

void drop_spare_blocks() noexcept { spare_blocks().drop_all(); }

std::size_t spare_block_bytes() noexcept { return spare_blocks().bytes(); }

}  // namespace rr::codec
