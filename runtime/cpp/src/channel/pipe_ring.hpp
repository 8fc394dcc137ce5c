// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <system_error>

#include "rr/buffer.hpp"
#include "runtime/cpp/src/channel/pipe_cursor.hpp"
#include "runtime/cpp/src/channel/pipe_ring_steps.hpp"
#include "runtime/cpp/src/channel/slot_holds.hpp"
#include "runtime/cpp/src/platform/shared_memory.hpp"

/// The memory of one pipe: a header, and a ring that its service writes packets into, once for all
/// clients. Each reads them at its own pace, and can write to none of it. The layout is on a page,
/// so that other implementations can have it: docs/reference/shared_memory.md.
namespace rr::channel {

/// What is in front of the bytes of each packet in a ring.
struct PipeRecord {
  std::uint32_t size = 0;  ///< bytes of the packet
  std::uint32_t unused = 0;

  /// Where records begin: at multiples of this.
  static constexpr std::size_t unit = 8;
  /// Bytes that a packet takes with all that belongs to it.
  static constexpr std::uint64_t whole(std::uint64_t size) {
    return (sizeof(PipeRecord) + size + unit - 1) / unit * unit;
  }
};
static_assert(sizeof(PipeRecord) == PipeRecord::unit);

/// How large such a ring is: a power of two.
struct PipeRingSize {
  static constexpr std::size_t smallest = std::size_t{256} * 1024;
  static constexpr std::size_t largest = std::size_t{64} * 1024 * 1024;

  std::size_t ring = 0;  ///< bytes for packets; 0: there can be no such ring

  /// For packets like one of so many bytes.
  static PipeRingSize for_packet(std::size_t bytes);
  /// Bytes of the whole memory.
  [[nodiscard]] std::size_t memory() const;
  /// Whether a header may say so.
  [[nodiscard]] bool is_right() const;
  /// Whether a packet leaves enough room for others.
  [[nodiscard]] bool fits(std::size_t bytes) const;
};

/// The side that sends packets. Not synchronized.
class PipeRingWriter {
 public:
  using Steps = PipeRingSteps<Synchronization>;

  /// Null when `error` says why not. `id` is what readers know it by.
  static std::unique_ptr<PipeRingWriter> make(PipeRingSize size, std::uint64_t id,
                                              std::error_code& error);

  [[nodiscard]] std::uint64_t id() const { return id_; }
  [[nodiscard]] PipeRingSize size() const { return size_; }
  /// To be passed to readers; it is read-only.
  [[nodiscard]] const platform::Descriptor& handle() const { return handle_; }

  /// Where the next packet will begin, and how many were before it.
  [[nodiscard]] std::uint64_t position() const { return written_; }
  [[nodiscard]] std::uint64_t count() const { return count_; }
  /// Up to where packets are to be given up before one of so many bytes can be put in; 0: there is
  /// room. Only for what fits.
  [[nodiscard]] std::uint64_t must_give_up(std::size_t bytes) const;
  /// Packets before this position may be written over.
  void give_up(std::uint64_t position);
  /// There must be room.
  void put(std::span<const std::byte> packet);
  /// Whether a record begins at this position, which a reader has said.
  [[nodiscard]] bool has(std::uint64_t position) const {
    return position >= kept_from_ && position <= written_ && position % PipeRecord::unit == 0;
  }
  /// Calls `function` with a copy of each packet from this position on, which has() is right of.
  /// False when no record begins there. Throws std::bad_alloc.
  using Function = std::function<void(Allocation packet, std::size_t size)>;
  bool for_each_from(std::uint64_t position, const Function& function) const;

  /// The number of another reader, for whom all packets are that come. Nothing when there were
  /// pipe_ring_readers already.
  std::optional<std::uint32_t> admit();
  /// Packets that come are not for this reader any more.
  void dismiss(std::uint32_t reader) { Steps::dismiss(untils_[reader], written_); }

 private:
  using Words = Steps::Words;
  using Untils = std::array<Steps::Until, pipe_ring_readers>;

  PipeRingWriter(platform::SharedMemory memory, platform::Descriptor handle, PipeRingSize size,
                 std::uint64_t id);
  void copy_in(std::uint64_t position, std::span<const std::byte> bytes);

  const platform::SharedMemory memory_;
  const platform::Descriptor handle_;
  const PipeRingSize size_;
  const std::uint64_t id_;
  Words& words_;
  Untils& untils_;
  std::uint32_t admitted_ = 0;
  std::uint64_t written_ = 0;
  std::uint64_t kept_from_ = 0;
  std::uint64_t count_ = 0;
};

/// What a reader begins with.
struct PipeRingStart {
  std::uint64_t id = 0;        ///< of the memory; 0: there is none
  std::uint64_t position = 0;  ///< of the first packet that is for it
  std::uint64_t number = 0;    ///< of that packet
  std::uint64_t place = 0;     ///< of its words in the memory of the connection
  std::uint64_t turn = 0;      ///< what these words are to have
  std::uint64_t reader = 0;    ///< its number among the readers of the memory
};

/// A packet that was read from a ring.
struct RingPacket {
  std::span<const std::byte> bytes{};
  MemoryRef owner{};  ///< of the bytes, if arrays may be parts of them

  static constexpr std::size_t small = 4096;
  std::array<std::byte, small> room;  // left uninitialized
};

/// The side of one reader. One thread at a time. What is in the memory is looked at once, and
/// checked.
class PipeRingReader {
 public:
  using Steps = PipeRingSteps<Synchronization>;

  /// Maps what a service has passed. Refuses what is not as the page says: invalid_argument.
  static std::unique_ptr<PipeRingReader> open(const platform::Descriptor& handle,
                                              std::error_code& error);

  [[nodiscard]] std::uint64_t id() const { return id_; }
  /// Before it is read. False when it cannot begin so.
  [[nodiscard]] bool begin(std::shared_ptr<PipeCursor> cursor, const PipeRingStart& start);

  enum class Found : std::uint8_t {
    nothing,  ///< no packet now
    packet,
    late,   ///< it was written over: what is missing comes by messages
    wrong,  ///< the memory is not as it can be: nothing more is to be read from it
  };
  /// Copies out the next packet. Throws std::bad_alloc, and then the packet is still there.
  Found read(RingPacket& packet);
  /// After read() has found nothing: requests a notice of the next packet. False when there is one
  /// already.
  [[nodiscard]] bool ask();
  /// Whether it has read all that it will ever get there: the rest comes by messages.
  [[nodiscard]] bool is_at_end() const { return Steps::is_end(*until_, position_); }

 private:
  using Words = Steps::Words;

  PipeRingReader(platform::SharedMemory memory, PipeRingSize size, std::uint64_t id);
  Found read_record(std::uint64_t end, RingPacket& packet);

  const platform::SharedMemory memory_;
  const PipeRingSize size_;
  const std::uint64_t id_;
  const Words& words_;
  const Steps::Until* until_;
  std::shared_ptr<PipeCursor> cursor_;
  std::uint64_t position_ = 0;
  std::uint64_t said_ = 0;  // the position that the service knows
};

}  // namespace rr::channel
