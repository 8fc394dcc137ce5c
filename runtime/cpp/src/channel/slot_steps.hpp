// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

#include "runtime/cpp/src/channel/slot_holds.hpp"
#include "runtime/cpp/src/channel/synchronization.hpp"

namespace rr::channel {

/// What the publisher of a wire says of its slots, in memory that it alone may write to
/// (docs/reference/shared_memory.md).
template <class Sync>
struct SlotWords {
  static constexpr std::size_t line = 64;
  template <class T>
  using Atomic = typename Sync::template Atomic<T>;

  alignas(line) Atomic<std::uint64_t> newest{0};   ///< the number of the newest value; 0: none
  Atomic<std::uint32_t> is_over{0};                ///< not 0: nothing follows in this memory
  alignas(line) typename Sync::SleepWord bell{0};  ///< grows whenever readers are to look
};

/// The same of one slot.
template <class Sync>
struct SlotHead {
  template <class T>
  using Atomic = typename Sync::template Atomic<T>;

  alignas(64) Atomic<std::uint64_t> sequence{0};  ///< see SlotSteps
  Atomic<std::uint64_t> size{0};                  ///< bytes of the value
  Atomic<std::int64_t> published{0};              ///< nanoseconds of the monotonic clock
  Atomic<std::uint32_t> begin{0};                 ///< where the value begins in the slot
  Atomic<std::uint32_t> run_count{0};             ///< of the following that there are
  /// Items of large arrays in the value, in their order: SlotRun.
  static constexpr std::size_t most_runs = 4;
  std::array<Atomic<std::uint64_t>, most_runs> runs{};
};

/// Items of a large array: where they begin in the value, and how many bytes they are.
struct SlotRun {
  std::uint32_t begin = 0;
  std::uint32_t size = 0;

  [[nodiscard]] std::uint64_t packed() const { return std::uint64_t{begin} << 32 | size; }
  static SlotRun unpack(std::uint64_t packed) {
    return {static_cast<std::uint32_t>(packed >> 32), static_cast<std::uint32_t>(packed)};
  }
};

/// How a value gets into a slot, and how a reader that may be anywhere in its copy finds out that
/// the next one but a few is being written over it. Value number `n`, from 1 on, has the slot `n`
/// modulo their number. The slot's sequence is `2 n - 1` while it is written and `2 n` afterwards.
/// A number whose slot a reader uses is left out.
template <class Sync>
struct SlotSteps {
  using Words = SlotWords<Sync>;
  using Head = SlotHead<Sync>;

  /// Before anything of the slot is changed.
  static void begin(Head& head, std::uint64_t number) {
    // With what came before: a reader that sees this sees the newest number of the time, too.
    head.sequence.store(2 * number - 1, std::memory_order_release);
    Sync::fence_release();
  }
  /// The same where readers may use the slot: asks `is_used` about that once no other one can begin
  /// to. False when one does; then the slot has what it had.
  template <class IsUsed>
  [[nodiscard]] static bool try_to_begin(Head& head, std::uint64_t number, IsUsed&& is_used) {
    const std::uint64_t before = head.sequence.load(std::memory_order_relaxed);
    // In one order with the reader's word and its look_at_used(): one of both sees the other.
    head.sequence.store(2 * number - 1);
    if (is_used()) {
      head.sequence.store(before, std::memory_order_release);
      return false;
    }
    Sync::fence_release();
    return true;
  }
  /// The value is there, and the newest.
  static void commit(Words& words, Head& head, std::uint64_t number) {
    head.sequence.store(2 * number, std::memory_order_release);
    words.newest.store(number, std::memory_order_release);
    ring(words);
  }
  /// Nothing follows.
  static void end(Words& words) {
    words.is_over.store(1, std::memory_order_release);
    ring(words);
  }
  /// Whoever sleeps, or is about to, looks again once it has been woken.
  static void ring(Words& words) { words.bell.fetch_add(1); }

  enum class State : std::uint8_t {
    whole,  ///< the value of the number is in the slot
    later,  ///< a later one is, or is being written
    wrong,  ///< neither can be: the writer does not keep to the rules
  };
  /// What is in the slot of a number that was the newest. Before the copy.
  static State look(const Head& head, std::uint64_t number, std::uint64_t slots) {
    return state(head.sequence.load(std::memory_order_acquire), number, slots);
  }
  /// The same once the reader has said that it uses the slot: while it does, the value stays.
  static State look_at_used(const Head& head, std::uint64_t number, std::uint64_t slots) {
    return state(head.sequence.load(), number, slots);
  }
  /// The same after the copy.
  static State look_again(const Head& head, std::uint64_t number, std::uint64_t slots) {
    Sync::fence_acquire();
    return state(head.sequence.load(std::memory_order_acquire), number, slots);
  }

 private:
  static State state(std::uint64_t sequence, std::uint64_t number, std::uint64_t slots) {
    if (sequence == 2 * number) return State::whole;
    const std::uint64_t other = (sequence + 1) / 2;
    const bool is_of_slot = other % slots == number % slots;
    return sequence > 2 * number && is_of_slot ? State::later : State::wrong;
  }
};

}  // namespace rr::channel
