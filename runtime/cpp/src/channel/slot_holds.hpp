// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "rr/mutex.hpp"
#include "runtime/cpp/src/channel/synchronization.hpp"

/// How a reader of slots, which may not write to their memory, says which of them it uses: arrays
/// in them are read in place (docs/reference/shared_memory.md). Readers of a pipe's ring have such
/// words, too (pipe_ring_steps.hpp).
namespace rr::channel {

/// Slots that a memory has at most.
inline constexpr std::size_t most_slots = 8;

/// What the reader of one memory says of its slots, in the memory of its connection: the number of
/// the value that it uses, for each slot; 0: none.
template <class Sync>
struct HoldWords {
  template <class T>
  using Atomic = typename Sync::template Atomic<T>;

  alignas(64) std::array<Atomic<std::uint64_t>, most_slots> numbers{};

  /// By the reader: before it looks at the slot's sequence for the last time.
  void use(std::size_t slot, std::uint64_t number) { numbers[slot].store(number); }
  /// By the reader: it has read what it will read there.
  void leave(std::size_t slot) { numbers[slot].store(0); }
  /// By the service, after it has changed the slot's sequence.
  [[nodiscard]] bool are_used(std::size_t slot) const { return numbers[slot].load() != 0; }
};

/// How many readers of a connection may do so, and the place of the first one's words.
struct HoldPlaces {
  static constexpr std::size_t count = 48;
  static constexpr std::size_t first = 0x400;
};

/// The words of one reader, as the service has them. Any thread.
class ServedHolds {
 public:
  using Words = HoldWords<Synchronization>;

  ServedHolds(std::shared_ptr<const Words> words, std::uint32_t place,
              std::shared_ptr<std::atomic<std::uint64_t>> drawn)
      : words_(std::move(words)), place_(place), drawn_(std::move(drawn)) {}
  ~ServedHolds() { drawn_->fetch_and(~(std::uint64_t{1} << place_)); }
  ServedHolds(const ServedHolds&) = delete;
  ServedHolds& operator=(const ServedHolds&) = delete;

  /// What the client knows them by.
  [[nodiscard]] std::uint32_t place() const { return place_; }
  /// Whether the client uses a slot. To be asked after the slot's sequence has been changed.
  [[nodiscard]] bool has(std::size_t slot) const { return words_->are_used(slot); }
  /// How many it uses.
  [[nodiscard]] std::size_t count() const;
  /// What the client has written.
  [[nodiscard]] const Words& words() const { return *words_; }

 private:
  const std::shared_ptr<const Words> words_;
  const std::uint32_t place_;
  const std::shared_ptr<std::atomic<std::uint64_t>> drawn_;
};

/// The words of all readers of a connection, as the service has them. Any thread.
class HoldPool {
 public:
  using Words = ServedHolds::Words;

  /// `first`: HoldPlaces::count of them.
  explicit HoldPool(std::shared_ptr<const Words> first) : first_(std::move(first)) {}

  /// Null when all are taken.
  std::shared_ptr<ServedHolds> draw();

 private:
  const std::shared_ptr<const Words> first_;
  // A bit for each place.
  const std::shared_ptr<std::atomic<std::uint64_t>> drawn_ =
      std::make_shared<std::atomic<std::uint64_t>>(0);
};

/// Words of a connection that its client writes to, until they are another reader's. Any thread.
class HeldPlace {
 public:
  HeldPlace() = default;
  HeldPlace(const HeldPlace&) = delete;
  HeldPlace& operator=(const HeldPlace&) = delete;
  virtual ~HeldPlace() = default;

  /// The words are another reader's from now on.
  virtual void detach() = 0;
};

/// The words of one reader of slots, as its client has them. Any thread.
class SlotHolds final : public HeldPlace {
 public:
  using Words = HoldWords<Synchronization>;
  /// Slots that a reader uses at once. Whoever uses more takes them away from all others.
  static constexpr unsigned most = 2;

  explicit SlotHolds(std::shared_ptr<Words> words);

  /// Before the slot of this value is looked at for the last time. False, and nothing happens, when
  /// no more may be used.
  [[nodiscard]] bool hold(std::size_t slot, std::uint64_t number);
  void release(std::size_t slot);
  void detach() override;

 private:
  Mutex mutex_;
  std::shared_ptr<Words> words_ RR_GUARDED_BY(mutex_);  // null: detached
  unsigned used_ RR_GUARDED_BY(mutex_) = 0;
};

}  // namespace rr::channel
