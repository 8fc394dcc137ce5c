// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <thread>
#include <type_traits>

#include "rr/visibility.hpp"

/// Pods that threads hand each other without locks. Both classes allocate nothing and never call
/// the kernel, but for SignalGroup::read().
namespace RR_VISIBLE rr {
namespace realtime {

static_assert(std::atomic<std::uint64_t>::is_always_lock_free);

/// What can be handed from thread to thread as bytes: numbers, and structs and arrays of them.
template <class T>
concept Pod = std::is_trivially_copyable_v<T> && std::is_default_constructible_v<T>;

/// A group of signals that one thread writes, typically the loop, and any number read. Writing
/// takes a bounded time whatever readers do; a reader gets a snapshot that is whole, or none for
/// the moment.
template <Pod T>
class SignalGroup {
 public:
  /// T{} at first, which counts as written.
  SignalGroup() { write(T{}); }
  /// This value at first, which counts as written.
  explicit SignalGroup(const T& first) { write(first); }
  SignalGroup(const SignalGroup&) = delete;
  SignalGroup& operator=(const SignalGroup&) = delete;

  /// By one thread at a time.
  void write(const T& value) {
    Words words{};
    std::memcpy(words.data(), &value, sizeof(T));
    const std::uint64_t count = count_.load(std::memory_order_relaxed);
    count_.store(count + 1, std::memory_order_relaxed);
    // Who reads one of these words sees the odd count too, when it looks at it again.
    for (std::size_t i = 0; i < word_count; ++i) {
      words_[i].store(words[i], std::memory_order_release);
    }
    count_.store(count + 2, std::memory_order_release);
  }

  /// A snapshot; nothing when the writer was in the way each time. May be called by a loop.
  [[nodiscard]] std::optional<T> try_read(int attempts = 4) const {
    for (int i = 0; i < attempts; ++i) {
      const std::uint64_t before = count_.load(std::memory_order_acquire);
      if (before % 2 != 0) continue;
      Words words;
      for (std::size_t j = 0; j < word_count; ++j) {
        words[j] = words_[j].load(std::memory_order_acquire);
      }
      if (count_.load(std::memory_order_relaxed) != before) continue;
      T value;
      std::memcpy(static_cast<void*>(&value), words.data(), sizeof(T));
      return value;
    }
    return std::nullopt;
  }
  /// A snapshot, for as long as it takes: gives the processor away in between, so not for a loop.
  [[nodiscard]] T read() const {
    for (;;) {
      if (const auto value = try_read()) return *value;
      std::this_thread::yield();
    }
  }
  /// How often it was written; the first value counts.
  [[nodiscard]] std::uint64_t version() const { return count_.load(std::memory_order_acquire) / 2; }

 private:
  static constexpr std::size_t word_count = (sizeof(T) + 7) / 8;
  using Words = std::array<std::uint64_t, word_count>;

  std::atomic<std::uint64_t> count_{0};  // odd while it is written
  std::array<std::atomic<std::uint64_t>, word_count> words_{};
};

/// Values from one thread for one other, typically from outside for the loop. Neither ever waits:
/// both have a place of their own, and exchange the third. The newest wins.
template <Pod T>
class Mailbox {
 public:
  /// T{} at first.
  Mailbox() = default;
  /// This value at first, as if it had been taken.
  explicit Mailbox(const T& first) { places_[read_] = first; }
  Mailbox(const Mailbox&) = delete;
  Mailbox& operator=(const Mailbox&) = delete;

  /// By one thread at a time.
  void put(const T& value) {
    places_[write_] = value;
    const std::uint8_t before =
        middle_.exchange(static_cast<std::uint8_t>(write_ | is_new), std::memory_order_acq_rel);
    write_ = before & place_mask;
  }
  /// Takes the newest value, when there is one since the last time. By one thread at a time.
  bool take() {
    if ((middle_.load(std::memory_order_relaxed) & is_new) == 0) return false;
    read_ = middle_.exchange(read_, std::memory_order_acq_rel) & place_mask;
    return true;
  }
  /// What was taken last; by the thread that takes.
  [[nodiscard]] const T& value() const { return places_[read_]; }

 private:
  static constexpr std::uint8_t is_new = 4;
  static constexpr std::uint8_t place_mask = 3;

  std::array<T, 3> places_{};
  std::atomic<std::uint8_t> middle_{1};
  std::uint8_t write_ = 2;  // of the writer
  std::uint8_t read_ = 0;   // of the reader
};

}  // namespace realtime
}  // namespace rr
