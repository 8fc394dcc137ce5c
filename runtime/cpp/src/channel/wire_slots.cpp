// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/channel/wire_slots.hpp"

#include <algorithm>
#include <cstring>
#include <new>
#include <type_traits>
#include <utility>

#include "runtime/cpp/src/channel/shared_header.hpp"

namespace rr::channel {
namespace {

constexpr std::size_t words_at = 0x100;
constexpr std::size_t heads_at = 0x200;
constexpr std::size_t slots_at = SharedHeader::first_data;
static_assert(words_at + sizeof(SlotWords<Synchronization>) <= heads_at &&
              heads_at + SlotSizes::most_slots * sizeof(SlotHead<Synchronization>) <= slots_at);
// The words are at the same places in all processes, and need nothing of the process that uses
// them.
static_assert(sizeof(SlotWords<Synchronization>) == 128 &&
              sizeof(SlotHead<Synchronization>) == 64 &&
              std::is_standard_layout_v<SlotWords<Synchronization>> &&
              std::is_standard_layout_v<SlotHead<Synchronization>> &&
              std::atomic<std::uint64_t>::is_always_lock_free);

// Values over this are large: a reader needs longer for the copy, but each slot more is memory.
constexpr std::size_t large_slot = std::size_t{64} * 1024;
constexpr std::size_t small_slots = 4;
constexpr std::size_t large_slots = 3;
constexpr std::size_t slot_unit = 4096;

// Of one read. The publisher has to be ahead by all slots but one each time.
constexpr int most_attempts = 16;

template <class T>
T* slot_place(const platform::SharedMemory& memory, std::size_t at) {
  return std::launder(reinterpret_cast<T*>(memory.bytes() + at));
}

std::int64_t as_nanoseconds(Time time) {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(time.time_since_epoch()).count();
}

}  // namespace

// Sizes

SlotSizes SlotSizes::for_value(std::size_t bytes) {
  if (bytes > largest_slot) return {};
  const std::size_t wanted = std::max(bytes + bytes / 4, smallest_slot);
  const std::size_t whole = (wanted + slot_unit - 1) / slot_unit * slot_unit;
  const std::size_t slot = std::min(whole, largest_slot);
  return {slot, slot > large_slot ? large_slots : small_slots};
}

std::size_t SlotSizes::memory() const { return slots_at + slot * count; }

bool SlotSizes::are_right() const {
  return slot >= smallest_slot && slot <= largest_slot && slot % slot_unit == 0 && count >= 2 &&
         count <= most_slots;
}

// The publisher

SlotWriter::SlotWriter(platform::SharedMemory memory, platform::Descriptor handle,
                       const SlotSizes& sizes, std::uint64_t id)
    : memory_(std::move(memory)),
      handle_(std::move(handle)),
      sizes_(sizes),
      id_(id),
      words_(*slot_place<Words>(memory_, words_at)),
      heads_(slot_place<Head>(memory_, heads_at)) {}

std::unique_ptr<SlotWriter> SlotWriter::make(const SlotSizes& sizes, std::uint64_t id,
                                             std::error_code& error) {
  if (!sizes.are_right()) {
    error = std::make_error_code(std::errc::invalid_argument);
    return nullptr;
  }
  platform::Descriptor handle;
  platform::SharedMemory memory = platform::make_published_memory(sizes.memory(), handle, error);
  if (!memory) return nullptr;
  SharedHeader header = SharedHeader::of(SharedKind::slots, sizes.slot);
  header.area_count = static_cast<std::uint32_t>(sizes.count);
  header.id = id;
  std::memcpy(memory.bytes(), &header, sizeof header);
  new (memory.bytes() + words_at) Words;
  for (std::size_t i = 0; i < sizes.count; ++i) {
    new (memory.bytes() + heads_at + i * sizeof(Head)) Head;
  }
  return std::unique_ptr<SlotWriter>(
      new SlotWriter(std::move(memory), std::move(handle), sizes, id));
}

bool SlotWriter::is_empty() const {
  const MutexLock lock(mutex_);
  return number_ == 0;
}

[[gnu::hot]] bool SlotWriter::publish(std::span<const Piece> value, std::size_t size,
                                      std::int64_t time) {
  if (size > sizes_.slot) return false;
  {
    const MutexLock lock(mutex_);
    if (time <= time_) return true;
    time_ = time;
    ++number_;
    Head& head = heads_[number_ % sizes_.count];
    std::byte* at = memory_.bytes() + slots_at + number_ % sizes_.count * sizes_.slot;
    Steps::begin(head, number_);
    head.size.store(size, std::memory_order_relaxed);
    head.published.store(as_nanoseconds(Clock::now()), std::memory_order_relaxed);
    for (const Piece& piece : value) {
      if (piece.size != 0) std::memcpy(at, piece.data, piece.size);
      at += piece.size;
    }
    Steps::commit(words_, head, number_);
  }
  ring();
  return true;
}

// Whoever sleeps has been counted, and was woken after that.
void SlotWriter::ring() {
  if (sleepers_.load() != 0) platform::wake_shared(&words_.bell);
}

void SlotWriter::add_sleeper() {
  sleepers_.fetch_add(1);
  Steps::ring(words_);  // a publisher may have looked before that
  platform::wake_shared(&words_.bell);
}

void SlotWriter::remove_sleeper() { sleepers_.fetch_sub(1); }

void SlotWriter::end() {
  Steps::end(words_);
  platform::wake_shared(&words_.bell);
}

// The reader

SlotReader::SlotReader(platform::SharedMemory memory, const SlotSizes& sizes, std::uint64_t id)
    : memory_(std::move(memory)),
      sizes_(sizes),
      id_(id),
      words_(*slot_place<const Words>(memory_, words_at)),
      heads_(slot_place<const Head>(memory_, heads_at)) {}

std::unique_ptr<SlotReader> SlotReader::open(const platform::Descriptor& handle,
                                             std::error_code& error) {
  constexpr std::size_t largest = slots_at + SlotSizes::largest_slot * SlotSizes::most_slots;
  platform::SharedMemory memory = platform::map_published_memory(handle, largest, error);
  if (!memory) return nullptr;
  const auto header = SharedHeader::read(memory);
  const SlotSizes sizes{header.area_size, header.area_count};
  const bool is_right =
      header.is_of(SharedKind::slots) && sizes.are_right() && memory.size() == sizes.memory();
  if (!is_right) {
    error = std::make_error_code(std::errc::invalid_argument);
    return nullptr;
  }
  return std::unique_ptr<SlotReader>(new SlotReader(std::move(memory), sizes, header.id));
}

[[gnu::hot]] SlotReader::Found SlotReader::read(SlotValue& value) {
  std::uint64_t torn = 0;  // the number that was written over meanwhile
  for (int left = most_attempts; left != 0; --left) {
    const std::uint64_t newest = words_.newest.load(std::memory_order_acquire);
    if (newest == seen_) return Found::nothing;
    // Whoever has written over a value has published others since.
    if (newest < seen_ || newest == torn) return Found::wrong;
    bool is_torn = false;
    const Found found = read_number(newest, value, is_torn);
    if (!is_torn) return found;
    torn = newest;
  }
  return Found::nothing;
}

SlotReader::Found SlotReader::read_number(std::uint64_t number, SlotValue& value, bool& is_torn) {
  const std::size_t slot = number % sizes_.count;
  const Head& head = heads_[slot];
  const auto found = [&](Steps::State state) {
    is_torn = state == Steps::State::later;
    return state == Steps::State::wrong ? Found::wrong : Found::nothing;
  };
  const Steps::State before = Steps::look(head, number, sizes_.count);
  if (before != Steps::State::whole) return found(before);
  const std::uint64_t size = head.size.load(std::memory_order_relaxed);
  const Time published{std::chrono::nanoseconds(head.published.load(std::memory_order_relaxed))};
  const bool fits = size <= sizes_.slot;
  if (fits) {
    std::byte* bytes = value.room.data();
    if (size > value.room.size()) {
      Allocation made = allocate(size);
      bytes = made.bytes;
      value.owner = std::move(made.owner);
    } else {
      value.owner = {};
    }
    std::memcpy(bytes, memory_.bytes() + slots_at + slot * sizes_.slot, size);
    value.bytes = {bytes, static_cast<std::size_t>(size)};
  }
  const Steps::State after = Steps::look_again(head, number, sizes_.count);
  if (after != Steps::State::whole) return found(after);
  if (!fits) return Found::wrong;
  value.published = std::clamp(published, Time(), Clock::now());
  seen_ = number;
  return Found::value;
}

void SlotReader::sleep(std::uint32_t bell, Clock::duration time) {
  if (!is_interrupted_.load()) platform::sleep_on_shared(words_.bell, bell, time);
  is_interrupted_.store(false);
}

void SlotReader::interrupt() {
  is_interrupted_.store(true);
  platform::wake_shared(&words_.bell);
}

}  // namespace rr::channel
