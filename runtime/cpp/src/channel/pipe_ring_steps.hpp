// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>

#include "runtime/cpp/src/channel/slot_holds.hpp"
#include "runtime/cpp/src/channel/synchronization.hpp"

namespace rr::channel {

/// What the service of a pipe says of its packets, in memory that it alone may write to
/// (docs/reference/shared_memory.md).
template <class Sync>
struct PipeRingWords {
  static constexpr std::size_t line = 64;
  template <class T>
  using Atomic = typename Sync::template Atomic<T>;

  alignas(line) Atomic<std::uint64_t> written{0};    ///< bytes of packets that were ever put in
  alignas(line) Atomic<std::uint64_t> kept_from{0};  ///< those before may be written over
};

/// How packets get into a ring that many read, each at its own pace. A reader says how far it is,
/// and that it wants to be told of the next packet, in the words that it has in the memory of its
/// connection. They count only when they have its turn: another reader may have had them before.
///
/// The service writes over packets that all have read. A reader that is too far behind is left out
/// first; what it has copied meanwhile it finds to be written over.
template <class Sync>
struct PipeRingSteps {
  using Words = PipeRingWords<Sync>;
  using Holds = HoldWords<Sync>;

  // The service

  /// Bytes before this position may be written over from now on. Before that is done.
  static void discard(Words& words, std::uint64_t position) {
    words.kept_from.store(position, std::memory_order_relaxed);
    Sync::fence_release();
  }
  /// The bytes before this position are there. In one order with what readers ask: a reader finds
  /// the packet, or has_asked() finds that it wants to be told.
  static void commit(Words& words, std::uint64_t position) { words.written.store(position); }
  /// How far a reader is; what it says is not to be believed. 0 when it has not begun.
  static std::uint64_t cursor(const Holds& holds, std::uint64_t turn) {
    if (holds.numbers[turn_at].load(std::memory_order_acquire) != turn) return 0;
    return holds.numbers[cursor_at].load(std::memory_order_acquire);
  }
  /// How often a reader has asked to be told, after commit().
  static std::uint64_t asked(const Holds& holds, std::uint64_t turn) {
    // The turn first: what was asked before it is not this reader's.
    return holds.numbers[turn_at].load() == turn ? holds.numbers[asked_at].load() : 0;
  }

  // A reader

  /// Takes words that another reader may have had, which does not write to them any more.
  static void begin(Holds& holds, std::uint64_t turn, std::uint64_t position) {
    holds.numbers[turn_at].store(0);
    holds.numbers[cursor_at].store(position, std::memory_order_relaxed);
    holds.numbers[asked_at].store(0, std::memory_order_relaxed);
    holds.numbers[turn_at].store(turn);
  }
  /// Up to where there are packets.
  static std::uint64_t look(const Words& words) {
    return words.written.load(std::memory_order_acquire);
  }
  /// Whether what was copied from this position on was not written over meanwhile.
  static bool is_kept(const Words& words, std::uint64_t position) {
    Sync::fence_acquire();
    return words.kept_from.load(std::memory_order_acquire) <= position;
  }
  /// Says that all before this position was copied.
  static void advance(Holds& holds, std::uint64_t position) {
    holds.numbers[cursor_at].store(position, std::memory_order_release);
  }
  /// Asks to be told, for the `count`th time. False when there is something meanwhile behind this
  /// position: then the reader may be told, or not.
  static bool ask(const Words& words, Holds& holds, std::uint64_t count, std::uint64_t position) {
    holds.numbers[asked_at].store(count);
    return words.written.load() == position;
  }

 private:
  // Which of the numbers are what.
  static constexpr std::size_t cursor_at = 0;
  static constexpr std::size_t asked_at = 1;
  static constexpr std::size_t turn_at = 2;
};

}  // namespace rr::channel
