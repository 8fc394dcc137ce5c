// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <system_error>

#include "rr/buffer.hpp"
#include "rr/mutex.hpp"
#include "rr/writer.hpp"
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
  static constexpr std::size_t most_slots = 8;

  std::size_t slot = 0;   ///< bytes for a value; 0: there can be no such slots
  std::size_t count = 0;  ///< slots

  /// For values like one of so many bytes; some may be larger.
  static SlotSizes for_value(std::size_t bytes);
  /// Bytes of the whole memory.
  [[nodiscard]] std::size_t memory() const;
  /// Whether a header may say so.
  [[nodiscard]] bool are_right() const;
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

  /// Writes a value into the next slot, and wakes readers if some want that. One that is not later
  /// than the one before is dropped. False when it does not fit.
  bool publish(std::span<const Piece> value, std::size_t size, std::int64_t time);
  /// One reader more wants to be woken; those that sleep look again.
  void add_sleeper();
  void remove_sleeper();
  /// Tells readers that nothing follows.
  void end();

 private:
  using Words = Steps::Words;
  using Head = Steps::Head;

  SlotWriter(platform::SharedMemory memory, platform::Descriptor handle, const SlotSizes& sizes,
             std::uint64_t id);
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
};

/// A value that was copied out of a slot.
struct SlotValue {
  std::span<const std::byte> bytes{};
  MemoryRef owner{};  ///< of the bytes; empty: they are in this object
  Time published{};   ///< as its service says; never later than now

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

  enum class Found : std::uint8_t {
    nothing,  ///< newer than what was read before, or not to be had now
    value,
    wrong,  ///< the memory is not as it can be: nothing more is to be read from it
  };
  /// Copies out the newest value, if it is newer than what was read before. Throws std::bad_alloc.
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

  SlotReader(platform::SharedMemory memory, const SlotSizes& sizes, std::uint64_t id);
  Found read_number(std::uint64_t number, SlotValue& value, bool& is_torn);

  const platform::SharedMemory memory_;
  const SlotSizes sizes_;
  const std::uint64_t id_;
  const Words& words_;
  const Head* const heads_;
  std::atomic<bool> is_interrupted_{false};
  std::uint64_t seen_ = 0;  // the number of the value that was read last
};

}  // namespace rr::channel
