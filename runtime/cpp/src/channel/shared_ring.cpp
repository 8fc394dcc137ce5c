// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/channel/shared_ring.hpp"

#include <algorithm>
#include <cstring>
#include <type_traits>

namespace rr::channel {
namespace {

using Words = SharedRing::Words;

// The words are at the same places in all processes, and need nothing of the process that uses
// them.
static_assert(sizeof(Words) == 4 * Words::line && std::is_standard_layout_v<Words> &&
              std::atomic<std::uint64_t>::is_always_lock_free);

}  // namespace

// The writer

// False when the index of the other side is wrong. It is looked at when what is known is too
// little for a slice: each look may have to fetch the line from another processor.
bool RingWriter::look_for_room(std::size_t& room) {
  room = ring_.size - static_cast<std::size_t>(written_ - seen_taken_);
  if (room >= std::min(ring_slice, ring_.size / 2)) return true;
  const std::uint64_t taken = ring_.words->taken.load(std::memory_order_acquire);
  if (written_ - taken > ring_.size) return false;
  seen_taken_ = taken;
  room = ring_.size - static_cast<std::size_t>(written_ - taken);
  return true;
}

// Copies in `most` bytes, where there are so many behind those to be skipped.
[[gnu::hot]] std::size_t RingWriter::put(std::span<const platform::Buffer> pieces,
                                         std::size_t skipped, std::size_t most) {
  const std::uint64_t begin = written_;
  for (const platform::Buffer& piece : pieces) {
    if (skipped >= piece.size) {
      skipped -= piece.size;
      continue;
    }
    const std::size_t left = most - static_cast<std::size_t>(written_ - begin);
    if (left == 0) break;
    copy_in({piece.data + skipped, std::min(piece.size - skipped, left)});
    skipped = 0;
  }
  return static_cast<std::size_t>(written_ - begin);
}

// The caller has seen that there is room.
[[gnu::hot]] void RingWriter::copy_in(std::span<const std::byte> bytes) {
  const std::size_t at = static_cast<std::size_t>(written_) & (ring_.size - 1);
  const std::size_t first = std::min(bytes.size(), ring_.size - at);
  std::memcpy(ring_.bytes + at, bytes.data(), first);
  if (first != bytes.size()) std::memcpy(ring_.bytes, bytes.data() + first, bytes.size() - first);
  written_ += bytes.size();
}

// Both indices are those in the shared memory: what is wrong with them costs the waiting time.
void RingWriter::wait_for_room(Clock::duration time) {
  Words& words = *ring_.words;
  const std::uint32_t wanted = words.room.fetch_or(Steps::by_word) | Steps::by_word;
  if (words.written.load() - words.taken.load() < ring_.size) return;
  platform::sleep_on_shared(words.room, wanted, time);
}

void RingWriter::interrupt_reader() {
  if (Steps::interrupt(*ring_.words)) platform::wake_shared(&ring_.words->reader);
}

// The reader

[[gnu::hot]] std::ptrdiff_t RingReader::read(std::span<std::byte> room, std::uint32_t& wake) {
  const std::uint64_t ready = ring_.words->written.load(std::memory_order_acquire) - taken_;
  if (ready > ring_.size) return platform::broken;
  const std::size_t size = std::min(static_cast<std::size_t>(ready), room.size());
  if (size == 0) return platform::nothing_now;
  const std::size_t at = static_cast<std::size_t>(taken_) & (ring_.size - 1);
  const std::size_t first = std::min(size, ring_.size - at);
  std::memcpy(room.data(), ring_.bytes + at, first);
  if (first != size) std::memcpy(room.data() + first, ring_.bytes, size - first);
  taken_ += size;
  wake = Steps::release(*ring_.words, taken_);
  return static_cast<std::ptrdiff_t>(size);
}

bool RingReader::is_written_elsewhere() const {
  return ring_.words->processor.load(std::memory_order_relaxed) != platform::current_processor();
}

void RingReader::interrupt() {
  if (Steps::interrupt(*ring_.words)) platform::wake_shared(&ring_.words->reader);
}

}  // namespace rr::channel
