// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <system_error>
#include <vector>

#include "rr/buffer.hpp"
#include "rr/mutex.hpp"
#include "rr/reader.hpp"
#include "rr/writer.hpp"
#include "runtime/cpp/src/channel/slot_holds.hpp"
#include "runtime/cpp/src/channel/slot_steps.hpp"
#include "runtime/cpp/src/channel/time.hpp"
#include "runtime/cpp/src/platform/shared_memory.hpp"

/// The memory of one wire: a header, and slots that its service writes values into. Everybody else
/// reads it. The layout is on a page, so that other implementations can have it:
/// docs/reference/shared_memory.md.
namespace rr::channel {

/// How large such a memory is.
struct SlotSizes {
  static constexpr std::size_t smallest_slot = 4096;
  static constexpr std::size_t largest_slot = std::size_t{16} * 1024 * 1024;

  std::size_t slot = 0;   ///< bytes for a value; 0: there can be no such slots
  std::size_t count = 0;  ///< slots

  /// For values like one of so many bytes; some may be larger.
  static SlotSizes for_value(std::size_t bytes);
  /// Bytes of the whole memory.
  [[nodiscard]] std::size_t memory() const;
  /// Whether a header may say so.
  [[nodiscard]] bool are_right() const;
  /// Whether values have arrays that are worth to be read in place.
  [[nodiscard]] bool are_large() const;
};

/// The side that publishes values. Any thread.
class SlotWriter {
 public:
  using Steps = SlotSteps<Synchronization>;

  /// Null when `error` says why not. `id` is what readers know it by.
  static std::unique_ptr<SlotWriter> make(const SlotSizes& sizes, std::uint64_t id,
                                          std::error_code& error);

  [[nodiscard]] std::uint64_t id() const { return id_; }
  [[nodiscard]] const SlotSizes& sizes() const { return sizes_; }
  /// To be passed to readers, who cannot write by it.
  [[nodiscard]] const platform::Descriptor& handle() const { return handle_; }
  /// Whether nothing was published yet.
  [[nodiscard]] bool is_empty() const;

  /// Writes a value into the next slot that no reader uses, and wakes readers if some want that.
  /// One that is not later than the one before is dropped. False when it does not fit, or all slots
  /// but that of the newest value are used.
  bool publish(std::span<const Piece> value, std::size_t size, std::int64_t time);
  /// A reader that says which slots it uses. One that uses more of them than it may, so that none
  /// was left for a while, is no longer listened to.
  void add_holds(std::shared_ptr<const ServedHolds> holds);
  void remove_holds(const ServedHolds& holds);
  /// One reader more wants to be woken; those that sleep look again.
  void add_sleeper();
  void remove_sleeper();
  /// Tells readers that nothing follows.
  void end();

 private:
  using Words = Steps::Words;
  using Head = Steps::Head;
  using Holds = std::vector<std::shared_ptr<const ServedHolds>>;

  SlotWriter(platform::SharedMemory memory, platform::Descriptor handle, const SlotSizes& sizes,
             std::uint64_t id);
  [[nodiscard]] std::uint64_t begin() RR_REQUIRES(mutex_);
  void refuse_greedy() RR_REQUIRES(mutex_);
  void put(std::span<const Piece> value, std::size_t size, std::uint64_t number);
  void ring();

  const platform::SharedMemory memory_;
  const platform::Descriptor handle_;
  const SlotSizes sizes_;
  const std::uint64_t id_;
  Words& words_;
  Head* const heads_;
  std::atomic<std::uint32_t> sleepers_{0};
  mutable Mutex mutex_;
  std::uint64_t number_ RR_GUARDED_BY(mutex_) = 0;  // of the last value
  std::int64_t time_ RR_GUARDED_BY(mutex_) = 0;     // and its time
  Holds holds_ RR_GUARDED_BY(mutex_);
  unsigned without_slot_ RR_GUARDED_BY(mutex_) = 0;  // values in a row
};

/// A value that was read from a slot.
struct SlotValue {
  std::span<const std::byte> bytes{};
  MemoryRef owner{};                            ///< of the bytes, if arrays may be parts of them
  Time published{};                             ///< as its service says; never later than now
  std::span<const DisplacedItems> displaced{};  ///< what is still in the slot
  MemoryRef slot{};                             ///< keeps it there
  MemoryRef gapped{};                           ///< keeps the bytes around it

  static constexpr std::size_t small = 4096;
  std::array<std::byte, small> room;  // left uninitialized
};

/// The side of one reader. One thread at a time, unless a function says otherwise. What is in the
/// memory is looked at once, and checked.
class SlotReader {
 public:
  using Steps = SlotSteps<Synchronization>;

  /// Maps what a service has passed. Refuses what is not as the page says: invalid_argument.
  static std::unique_ptr<SlotReader> open(const platform::Descriptor& handle,
                                          std::error_code& error);

  [[nodiscard]] std::uint64_t id() const { return id_; }
  [[nodiscard]] const SlotSizes& sizes() const { return sizes_; }
  /// Before it is read: large arrays are read in place, and these say so.
  void use_holds(std::shared_ptr<SlotHolds> holds) { holds_ = std::move(holds); }

  enum class Found : std::uint8_t {
    nothing,  ///< newer than what was read before, or not to be had now
    value,
    wrong,  ///< the memory is not as it can be: nothing more is to be read from it
  };
  /// Copies out the newest value, if it is newer than what was read before, but for large arrays
  /// where they may stay. Throws std::bad_alloc.
  Found read(SlotValue& value);
  /// Any thread: nothing follows what is there.
  [[nodiscard]] bool is_over() const { return words_.is_over.load(std::memory_order_acquire) != 0; }

  /// Any thread: a number that changes with each value, at the end, and for no reason.
  [[nodiscard]] std::uint32_t bell() const { return words_.bell.load(); }
  /// Any thread: sleeps until that number has changed from `bell`, or interrupt() was called, or
  /// for no reason, and for `time` at most.
  void sleep(std::uint32_t bell, Clock::duration time);
  /// Any thread: sleep() returns, now or the next time.
  void interrupt();

 private:
  using Words = Steps::Words;
  using Head = Steps::Head;

  // What the head of a slot says, read once.
  struct Contents {
    explicit Contents(const Head& head);
    [[nodiscard]] bool are_right(const SlotSizes& sizes) const;

    std::uint64_t size;
    std::int64_t published;
    std::uint32_t begin;
    std::uint32_t run_count;
    std::array<SlotRun, Head::most_runs> runs;
  };
  class Gapped;
  class Use;

  SlotReader(platform::SharedMemory memory, const SlotSizes& sizes, std::uint64_t id);
  Found read_number(std::uint64_t number, SlotValue& value, bool& is_torn);
  MemoryRef use(std::size_t slot, std::uint64_t number);
  void copy(const std::byte* slot, const Contents& contents, SlotValue& value);
  void copy_around(const std::byte* slot, const Contents& contents, SlotValue& value);

  const std::shared_ptr<const platform::SharedMemory> memory_;
  const SlotSizes sizes_;
  const std::uint64_t id_;
  const Words& words_;
  const Head* const heads_;
  std::atomic<bool> is_interrupted_{false};
  std::uint64_t seen_ = 0;  // the number of the value that was read last
  std::shared_ptr<SlotHolds> holds_;
  // For the parts of a value that are not left in its slot. Another one while a value has it.
  MemoryRef gapped_memory_;
  Gapped* gapped_ = nullptr;
};

}  // namespace rr::channel
