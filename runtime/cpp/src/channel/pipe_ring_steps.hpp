// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
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

/// Readers that such a memory ever has: each has a word of its own, in which the service says up to
/// which position packets are for it.
inline constexpr std::size_t pipe_ring_readers = 1024;

/// How packets get into a ring that many read, each at its own pace. A reader says how far it is,
/// and that it requests a notice of the next packet, in the words that it has in the memory of its
/// connection. They count only when they have its turn: another reader may have had them before.
///
/// The service writes over packets that all have read. A reader that is too far behind is left out
/// first; what it has copied meanwhile it finds to be written over. A reader that is left out reads
/// nothing that is put in afterwards: it may get that by messages, with others between.
template <class Sync>
struct PipeRingSteps {
  using Words = PipeRingWords<Sync>;
  using Holds = HoldWords<Sync>;
  using Until = typename Sync::template Atomic<std::uint64_t>;

  // The service

  /// All that comes is for a reader. Before it begins.
  static void admit(Until& until) { until.store(all, std::memory_order_relaxed); }
  /// What is put in from this position on is not for a reader. Before it is put in.
  static void dismiss(Until& until, std::uint64_t position) {
    until.store(position, std::memory_order_relaxed);
  }
  /// Bytes before this position may be written over from now on. Before that is done.
  static void discard(Words& words, std::uint64_t position) {
    words.kept_from.store(position, std::memory_order_relaxed);
    Sync::fence_release();
  }
  /// The bytes before this position are there. In one order with what readers ask: a reader finds
  /// the packet, or asked() finds the request for a notice.
  static void commit(Words& words, std::uint64_t position) { words.written.store(position); }
  /// How far a reader is; what it says is not to be believed. 0 when it has not begun.
  static std::uint64_t cursor(const Holds& holds, std::uint64_t turn) {
    if (holds.numbers[turn_at].load(std::memory_order_acquire) != turn) return 0;
    return holds.numbers[cursor_at].load(std::memory_order_acquire);
  }
  /// How many notices a reader has requested, after commit().
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
  /// Up to where there are packets for it. The position first: it has been dismissed before more
  /// was put in.
  static std::uint64_t look(const Words& words, const Until& until) {
    const std::uint64_t end = words.written.load(std::memory_order_acquire);
    return std::min(end, until.load(std::memory_order_relaxed));
  }
  /// Whether it is left out, and has got all that was for it.
  static bool is_end(const Until& until, std::uint64_t position) {
    return until.load(std::memory_order_relaxed) == position;
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
  /// Requests a notice, for the `count`th time. False when there is something meanwhile behind this
  /// position: then the reader may get one, or not.
  static bool ask(const Words& words, const Until& until, Holds& holds, std::uint64_t count,
                  std::uint64_t position) {
    holds.numbers[asked_at].store(count);
    const std::uint64_t end = words.written.load();
    return std::min(end, until.load(std::memory_order_relaxed)) == position;
  }

 private:
  static constexpr std::uint64_t all = ~std::uint64_t{0};
  // Which of the numbers are what.
  static constexpr std::size_t cursor_at = 0;
  static constexpr std::size_t asked_at = 1;
  static constexpr std::size_t turn_at = 2;
};

}  // namespace rr::channel
