// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

#include "rr/visibility.hpp"

/// How signals, mailboxes and lookup tables hand their contents from thread to thread. Programs
/// need nothing of this. `Atomic` is std::atomic but in the models that try out interleavings.
namespace RR_VISIBLE rr {
namespace realtime {

static_assert(std::atomic<std::uint64_t>::is_always_lock_free);

/// Words that one thread writes and any number read. Writing takes a bounded time whatever readers
/// do; a reader gets words of one write, or none for the moment.
template <std::size_t word_count, template <class> class Atomic = std::atomic>
class Snapshot {
 public:
  /// What is written and read at once.
  using Words = std::array<std::uint64_t, word_count>;

  /// By one thread at a time.
  void write(const Words& words) {
    const std::uint64_t count = count_.load(std::memory_order_relaxed);
    count_.store(count + 1, std::memory_order_relaxed);
    // A reader of one of these words sees the odd count too, when it looks at it again.
    for (std::size_t i = 0; i < word_count; ++i) {
      words_[i].store(words[i], std::memory_order_release);
    }
    count_.store(count + 2, std::memory_order_release);
  }
  /// False when the writer was in the way each time; `words` is of no use then.
  [[nodiscard]] bool try_read(Words& words, int attempts) const {
    for (int i = 0; i < attempts; ++i) {
      const std::uint64_t before = count_.load(std::memory_order_acquire);
      if (before % 2 != 0) continue;
      for (std::size_t j = 0; j < word_count; ++j) {
        words[j] = words_[j].load(std::memory_order_acquire);
      }
      if (count_.load(std::memory_order_relaxed) == before) return true;
    }
    return false;
  }
  /// How often it was written.
  [[nodiscard]] std::uint64_t version() const { return count_.load(std::memory_order_acquire) / 2; }

 private:
  Atomic<std::uint64_t> count_{0};  // odd while it is written
  std::array<Atomic<std::uint64_t>, word_count> words_{};
};

/// The place between those of a writer and of a reader, which exchange their own for it: neither
/// ever waits, and what is in a place belongs to the one who has it.
template <template <class> class Atomic = std::atomic>
class PlaceExchange {
 public:
  /// Number of a place, from 0 to 3.
  using Place = std::uint8_t;

  /// The place that neither has at first.
  explicit PlaceExchange(Place place) : middle_(place) {}

  /// By the writer: what is in its place is the newest. Returns the place that is its own from now
  /// on.
  [[nodiscard]] Place give(Place place) {
    const auto given = static_cast<Place>(place | is_new);
    return middle_.exchange(given, std::memory_order_acq_rel) & place_mask;
  }
  /// By the reader: whether something was given since it took last.
  [[nodiscard]] bool has_new() const {
    return (middle_.load(std::memory_order_relaxed) & is_new) != 0;
  }
  /// By the reader, when there is something new: the place that is its own from now on. `place` is
  /// its own until now.
  [[nodiscard]] Place take(Place place) {
    return middle_.exchange(place, std::memory_order_acq_rel) & place_mask;
  }

 private:
  static constexpr Place is_new = 4;
  static constexpr Place place_mask = 3;

  Atomic<Place> middle_;
};

}  // namespace realtime
}  // namespace rr
