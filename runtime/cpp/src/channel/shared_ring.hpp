// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>

#include "runtime/cpp/src/channel/ring_steps.hpp"
#include "runtime/cpp/src/platform/sockets.hpp"

/// Bytes that one process writes into a ring in shared memory, and another one copies out. Nothing
/// that the other side may change is believed: its index is read once for each use, and checked
/// against one's own, which is kept elsewhere.
namespace rr::channel {

/// One ring: its words, and `size` bytes, a power of two.
struct SharedRing {
  using Words = RingWords<Synchronization>;
  Words* words = nullptr;
  std::byte* bytes = nullptr;
  std::size_t size = 0;
};

/// The writing end. One thread at a time, unless a function says otherwise.
class RingWriter {
 public:
  using Steps = RingSteps<Synchronization>;

  explicit RingWriter(const SharedRing& ring) : ring_(ring) {}

  /// Copies in what there is room for of the bytes behind the first `skipped`. `wake` is called
  /// with a Steps::Reader where the reader is to be woken. Returns how many bytes, or
  /// platform::broken when the other side's index is wrong.
  template <class Wake>
  std::ptrdiff_t write(std::span<const platform::Buffer> pieces, std::size_t skipped, Wake&& wake);
  /// After write() has had no room for all: the other side rings when there is some. True when
  /// there is some already.
  [[nodiscard]] bool want_room() {
    return Steps::want_room(*ring_.words, Steps::by_bell, written_, ring_.size);
  }
  /// Any thread: returns when there may be room, or after `time`.
  void wait_for_room(Clock::duration time);
  /// Any thread: wakes the reader if it sleeps, to look at something else.
  void interrupt_reader();

  [[nodiscard]] const SharedRing& ring() const { return ring_; }

 private:
  [[nodiscard]] bool look_for_room(std::size_t& room);
  std::size_t put(std::span<const platform::Buffer> pieces, std::size_t skipped, std::size_t most);
  void copy_in(std::span<const std::byte> bytes);

  const SharedRing ring_;
  std::uint64_t written_ = 0;
  std::uint64_t seen_taken_ = 0;  // checked
};

/// The reading end. One thread at a time, unless a function says otherwise.
class RingReader {
 public:
  using Steps = RingSteps<Synchronization>;

  explicit RingReader(const SharedRing& ring) : ring_(ring) {}

  /// Copies out what is there, as far as there is room for it: bytes, platform::nothing_now, or
  /// platform::broken when the other side's index is wrong. `wake` gets bits of Steps::Room where
  /// the writer is to be woken.
  std::ptrdiff_t read(std::span<std::byte> room, std::uint32_t& wake);
  /// Whether read() would find something.
  [[nodiscard]] bool is_ready() const {
    return ring_.words->written.load(std::memory_order_acquire) != taken_;
  }
  /// As RingSteps::watch(): true when there is something to read already.
  [[nodiscard]] bool watch() { return Steps::watch(*ring_.words, taken_); }
  /// The reader runs: nobody needs to wake it.
  void run() { ring_.words->reader.store(Steps::runs, std::memory_order_relaxed); }
  /// As RingSteps::sleep().
  void sleep(std::atomic<bool>& is_interrupted, Clock::duration time) {
    Steps::sleep(*ring_.words, taken_, is_interrupted, time);
  }
  /// Whether the writer has last written on another processor than this thread runs on.
  [[nodiscard]] bool is_written_elsewhere() const;
  /// Any thread: wakes the one that sleeps here.
  void interrupt();

  [[nodiscard]] const SharedRing& ring() const { return ring_; }

 private:
  const SharedRing ring_;
  std::uint64_t taken_ = 0;
};

/// So much is published at once: the reader copies out what is there while the rest is copied in.
inline constexpr std::size_t ring_slice = std::size_t{16} * 1024;

template <class Wake>
[[gnu::hot]] std::ptrdiff_t RingWriter::write(std::span<const platform::Buffer> pieces,
                                              std::size_t skipped, Wake&& wake) {
  const std::size_t begin = skipped;
  while (true) {
    std::size_t room = 0;
    if (!look_for_room(room)) return platform::broken;
    const std::size_t size = put(pieces, skipped, std::min(room, ring_slice));
    if (size == 0) return static_cast<std::ptrdiff_t>(skipped - begin);
    skipped += size;
    ring_.words->processor.store(platform::current_processor(), std::memory_order_relaxed);
    const std::uint32_t reader = Steps::publish(*ring_.words, written_);
    if (reader != Steps::runs) wake(reader);
  }
}

}  // namespace rr::channel
