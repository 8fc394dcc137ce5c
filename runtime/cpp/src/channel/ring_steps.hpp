// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>

#include "runtime/cpp/src/channel/synchronization.hpp"
#include "runtime/cpp/src/channel/time.hpp"

namespace rr::channel {

/// What the two sides of a ring tell each other, in memory that both may write to
/// (docs/reference/shared_memory.md). Each line of the processor's cache has one side that writes
/// it while messages flow.
template <class Sync>
struct RingWords {
  static constexpr std::size_t line = 64;
  template <class T>
  using Atomic = typename Sync::template Atomic<T>;
  using SleepWord = typename Sync::SleepWord;

  alignas(line) Atomic<std::uint64_t> written{0};  ///< bytes, since the beginning; by the writer
  Atomic<std::uint32_t> processor{0};              ///< on which the writer has written last
  alignas(line) Atomic<std::uint64_t> taken{0};    ///< the same that the reader has copied out
  alignas(line) SleepWord reader{0};               ///< RingSteps::Reader
  alignas(line) SleepWord room{0};                 ///< RingSteps::Room
};

/// How a reader of a ring sleeps until there are bytes, and a writer until there is room. No
/// wake-up is lost: who goes to sleep leaves word of it and looks once more; who brings something
/// looks for such word afterwards. All four operations are in one order.
template <class Sync>
struct RingSteps {
  using Words = RingWords<Sync>;

  /// How the reader is woken. Whoever brings bytes sets `runs`, and wakes.
  enum Reader : std::uint32_t {
    runs = 0,     ///< not at all: it looks again before it sleeps
    sleeps = 1,   ///< on the word
    watches = 2,  ///< by the bell
  };
  /// Bits: what a writer that has found no room wants.
  enum Room : std::uint32_t {
    by_bell = 1,
    by_word = 2,
  };

  /// The writer has put bytes into the ring, up to `written`. Returns how the reader is to be
  /// woken, which the caller has to do.
  static std::uint32_t publish(Words& words, std::uint64_t written);
  /// The reader will do something else, and is to be woken by the bell. True when there is
  /// something to read already: then it is not.
  static bool watch(Words& words, std::uint64_t taken);
  /// The reader sleeps until there is something, or somebody interrupts it, or for no reason, and
  /// for `time` at most.
  static void sleep(Words& words, std::uint64_t taken,
                    typename Sync::template Atomic<bool>& is_interrupted, Clock::duration time);
  /// Any thread, of either side: a reader that sleeps is to look at something else than the ring.
  /// True when it has to be woken on the word.
  static bool interrupt(Words& words);

  /// The reader has copied out all up to `taken`. Returns bits of Room, by which the caller has to
  /// wake the writer.
  static std::uint32_t release(Words& words, std::uint64_t taken);
  /// The writer, which has written up to `written`, asks for a notice when there is room. True when
  /// there is some already.
  static bool want_room(Words& words, Room how, std::uint64_t written, std::uint64_t size);
};

template <class Sync>
[[gnu::hot]] std::uint32_t RingSteps<Sync>::publish(Words& words, std::uint64_t written) {
  words.written.store(written);
  if (words.reader.load() == runs) return runs;
  return words.reader.exchange(runs);
}

template <class Sync>
[[gnu::hot]] bool RingSteps<Sync>::watch(Words& words, std::uint64_t taken) {
  words.reader.store(watches);
  if (words.written.load() == taken) return false;
  words.reader.store(runs, std::memory_order_relaxed);
  return true;
}

template <class Sync>
[[gnu::hot]] void RingSteps<Sync>::sleep(Words& words, std::uint64_t taken,
                                         typename Sync::template Atomic<bool>& is_interrupted,
                                         Clock::duration time) {
  words.reader.store(sleeps);
  if (words.written.load() == taken && !is_interrupted.load()) {
    Sync::sleep_on_shared(words.reader, sleeps, time);
  }
  words.reader.store(runs, std::memory_order_relaxed);
}

template <class Sync>
bool RingSteps<Sync>::interrupt(Words& words) {
  std::uint32_t expected = sleeps;
  return words.reader.compare_exchange_strong(expected, runs);
}

template <class Sync>
[[gnu::hot]] std::uint32_t RingSteps<Sync>::release(Words& words, std::uint64_t taken) {
  words.taken.store(taken);
  if (words.room.load() == 0) return 0;
  return words.room.exchange(0);
}

template <class Sync>
bool RingSteps<Sync>::want_room(Words& words, Room how, std::uint64_t written, std::uint64_t size) {
  words.room.fetch_or(how);
  return written - words.taken.load() < size;
}

}  // namespace rr::channel
