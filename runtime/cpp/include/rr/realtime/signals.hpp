// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <thread>
#include <type_traits>

#include "rr/realtime/exchange.hpp"
#include "rr/visibility.hpp"

/// Pods that threads hand each other without locks. Both classes allocate nothing and never call
/// the kernel, but for SignalGroup::read().
namespace RR_VISIBLE rr {
namespace realtime {

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
    snapshot_.write(words);
  }

  /// A snapshot; nothing when the writer was in the way each time. May be called by a loop.
  [[nodiscard]] std::optional<T> try_read(int attempts = 4) const {
    Words words;
    if (!snapshot_.try_read(words, attempts)) return std::nullopt;
    T value;
    std::memcpy(static_cast<void*>(&value), words.data(), sizeof(T));
    return value;
  }
  /// A snapshot, for as long as it takes: gives the processor away in between, so not for a loop.
  [[nodiscard]] T read() const {
    for (;;) {
      if (const auto value = try_read()) return *value;
      std::this_thread::yield();
    }
  }
  /// How often it was written; the first value counts.
  [[nodiscard]] std::uint64_t version() const { return snapshot_.version(); }

 private:
  static constexpr std::size_t word_count = (sizeof(T) + 7) / 8;
  using Words = typename Snapshot<word_count>::Words;

  Snapshot<word_count> snapshot_;
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
    write_ = middle_.give(write_);
  }
  /// Takes the newest value, when there is one since the last time. By one thread at a time.
  bool take() {
    if (!middle_.has_new()) return false;
    read_ = middle_.take(read_);
    return true;
  }
  /// What was taken last; by the thread that takes.
  [[nodiscard]] const T& value() const { return places_[read_]; }

 private:
  std::array<T, 3> places_{};
  PlaceExchange<> middle_{1};
  std::uint8_t write_ = 2;  // of the writer
  std::uint8_t read_ = 0;   // of the reader
};

}  // namespace realtime
}  // namespace rr
