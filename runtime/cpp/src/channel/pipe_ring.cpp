// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/channel/pipe_ring.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <new>
#include <type_traits>
#include <utility>

#include "runtime/cpp/src/channel/shared_header.hpp"

namespace rr::channel {
namespace {

constexpr std::size_t ring_words_at = 0x100;
constexpr std::size_t untils_at = SharedHeader::first_data;
constexpr std::size_t packets_at = untils_at + sizeof(std::uint64_t) * pipe_ring_readers;
// The words are at the same places in all processes, and need nothing of the process that uses
// them.
static_assert(sizeof(PipeRingWords<Synchronization>) == 128 &&
              std::is_standard_layout_v<PipeRingWords<Synchronization>> &&
              std::atomic<std::uint64_t>::is_always_lock_free);

// A ring has room for so many packets at least: readers that are a little slower are not left out.
constexpr std::size_t least_packets = 4;
// And for so many of the size that it is made for.
constexpr std::size_t usual_packets = 8;

template <class T>
T* ring_place(const platform::SharedMemory& memory, std::size_t at) {
  return std::launder(reinterpret_cast<T*>(memory.bytes() + at));
}

// A part of a ring that may go on at its beginning.
struct Stretch {
  Stretch(std::uint64_t position, std::size_t size, std::size_t ring)
      : at(position % ring), first(std::min(size, ring - at)), second(size - first) {}

  std::size_t at;
  std::size_t first;
  std::size_t second;
};

[[gnu::hot]] void copy_out_of(const platform::SharedMemory& memory, std::size_t ring_size,
                              std::uint64_t position, std::span<std::byte> bytes) {
  if (bytes.empty()) return;
  const Stretch stretch(position, bytes.size(), ring_size);
  const std::byte* const ring = memory.bytes() + packets_at;
  std::memcpy(bytes.data(), ring + stretch.at, stretch.first);
  if (stretch.second != 0) std::memcpy(bytes.data() + stretch.first, ring, stretch.second);
}

}  // namespace

// Sizes

PipeRingSize PipeRingSize::for_packet(std::size_t bytes) {
  if (bytes > largest || PipeRecord::whole(bytes) > largest / least_packets) return {};
  const std::size_t wanted = PipeRecord::whole(bytes) * usual_packets;
  return {std::clamp(std::bit_ceil(wanted), smallest, largest)};
}

std::size_t PipeRingSize::memory() const { return packets_at + ring; }

bool PipeRingSize::is_right() const {
  return ring >= smallest && ring <= largest && std::has_single_bit(ring);
}

bool PipeRingSize::fits(std::size_t bytes) const {
  return bytes <= ring && PipeRecord::whole(bytes) <= ring / least_packets;
}

// The service

PipeRingWriter::PipeRingWriter(platform::SharedMemory memory, platform::Descriptor handle,
                               PipeRingSize size, std::uint64_t id)
    : memory_(std::move(memory)),
      handle_(std::move(handle)),
      size_(size),
      id_(id),
      words_(*ring_place<Words>(memory_, ring_words_at)),
      untils_(*ring_place<Untils>(memory_, untils_at)) {}

std::unique_ptr<PipeRingWriter> PipeRingWriter::make(PipeRingSize size, std::uint64_t id,
                                                     std::error_code& error) {
  if (!size.is_right()) {
    error = std::make_error_code(std::errc::invalid_argument);
    return nullptr;
  }
  platform::Descriptor handle;
  platform::SharedMemory memory = platform::make_published_memory(size.memory(), handle, error);
  if (!memory) return nullptr;
  SharedHeader header = SharedHeader::of(SharedKind::packets, size.ring);
  header.area_count = 1;
  header.id = id;
  std::memcpy(memory.bytes(), &header, sizeof header);
  new (memory.bytes() + ring_words_at) Words;
  new (memory.bytes() + untils_at) Untils{};
  return std::unique_ptr<PipeRingWriter>(
      new PipeRingWriter(std::move(memory), std::move(handle), size, id));
}

std::uint64_t PipeRingWriter::must_give_up(std::size_t bytes) const {
  const std::uint64_t end = written_ + PipeRecord::whole(bytes);
  return end - kept_from_ <= size_.ring ? 0 : end - size_.ring;
}

void PipeRingWriter::give_up(std::uint64_t position) {
  kept_from_ = position;
  Steps::discard(words_, position);
}

[[gnu::hot]] void PipeRingWriter::put(std::span<const std::byte> packet) {
  const PipeRecord record{static_cast<std::uint32_t>(packet.size())};
  copy_in(written_, std::as_bytes(std::span(&record, 1)));
  copy_in(written_ + sizeof record, packet);
  written_ += PipeRecord::whole(packet.size());
  ++count_;
  Steps::commit(words_, written_);
}

bool PipeRingWriter::for_each_from(std::uint64_t position, const Function& function) const {
  while (position != written_) {
    if (!has(position)) return false;
    PipeRecord record;
    copy_out_of(memory_, size_.ring, position, std::as_writable_bytes(std::span(&record, 1)));
    if (PipeRecord::whole(record.size) > written_ - position) return false;
    Allocation packet = allocate(record.size);
    copy_out_of(memory_, size_.ring, position + sizeof record, {packet.bytes, record.size});
    function(std::move(packet), record.size);
    position += PipeRecord::whole(record.size);
  }
  return true;
}

std::optional<std::uint32_t> PipeRingWriter::admit() {
  if (admitted_ == pipe_ring_readers) return std::nullopt;
  Steps::admit(untils_[admitted_]);
  return admitted_++;
}

[[gnu::hot]] void PipeRingWriter::copy_in(std::uint64_t position,
                                          std::span<const std::byte> bytes) {
  if (bytes.empty()) return;
  const Stretch stretch(position, bytes.size(), size_.ring);
  std::byte* const ring = memory_.bytes() + packets_at;
  std::memcpy(ring + stretch.at, bytes.data(), stretch.first);
  if (stretch.second != 0) std::memcpy(ring, bytes.data() + stretch.first, stretch.second);
}

// A reader

PipeRingReader::PipeRingReader(platform::SharedMemory memory, PipeRingSize size, std::uint64_t id)
    : memory_(std::move(memory)),
      size_(size),
      id_(id),
      words_(*ring_place<const Words>(memory_, ring_words_at)),
      until_(ring_place<const Steps::Until>(memory_, untils_at)) {}

std::unique_ptr<PipeRingReader> PipeRingReader::open(const platform::Descriptor& handle,
                                                     std::error_code& error) {
  constexpr std::size_t largest = packets_at + PipeRingSize::largest;
  platform::SharedMemory memory = platform::map_published_memory(handle, largest, error);
  if (!memory) return nullptr;
  const auto header = SharedHeader::read(memory);
  const PipeRingSize size{header.area_size};
  if (!header.is_of(SharedKind::packets) || !size.is_right() || memory.size() != size.memory()) {
    error = std::make_error_code(std::errc::invalid_argument);
    return nullptr;
  }
  return std::unique_ptr<PipeRingReader>(new PipeRingReader(std::move(memory), size, header.id));
}

bool PipeRingReader::begin(std::shared_ptr<PipeCursor> cursor, const PipeRingStart& start) {
  if (start.position % PipeRecord::unit != 0 || start.reader >= pipe_ring_readers) return false;
  until_ += start.reader;
  cursor_ = std::move(cursor);
  position_ = start.position;
  said_ = position_;
  cursor_->begin(start.turn, position_);
  return true;
}

[[gnu::hot]] PipeRingReader::Found PipeRingReader::read(RingPacket& packet) {
  const std::uint64_t end = Steps::look(words_, *until_);
  if (end != position_) return read_record(end, packet);
  if (said_ != position_) cursor_->advance(said_ = position_);
  return Found::nothing;
}

[[gnu::hot]] PipeRingReader::Found PipeRingReader::read_record(std::uint64_t end,
                                                               RingPacket& packet) {
  // Words that are no longer those of the packet are not looked at.
  const auto unless_late = [&](Found found) {
    return Steps::is_kept(words_, position_) ? found : Found::late;
  };
  if (end < position_) return Found::wrong;
  const std::uint64_t left = end - position_;
  if (left < sizeof(PipeRecord) || left > size_.ring) return unless_late(Found::wrong);
  PipeRecord record;
  copy_out_of(memory_, size_.ring, position_, std::as_writable_bytes(std::span(&record, 1)));
  if (PipeRecord::whole(record.size) > left) return unless_late(Found::wrong);
  std::byte* bytes = packet.room.data();
  packet.owner = {};
  if (record.size > packet.room.size()) {
    Allocation made = allocate(record.size);
    bytes = made.bytes;
    packet.owner = std::move(made.owner);
  }
  packet.bytes = {bytes, record.size};
  copy_out_of(memory_, size_.ring, position_ + sizeof record, {bytes, record.size});
  if (!Steps::is_kept(words_, position_)) return Found::late;
  position_ += PipeRecord::whole(record.size);
  if (position_ - said_ >= size_.ring / least_packets) cursor_->advance(said_ = position_);
  return Found::packet;
}

bool PipeRingReader::ask() { return cursor_->ask(words_, *until_, position_); }

}  // namespace rr::channel
