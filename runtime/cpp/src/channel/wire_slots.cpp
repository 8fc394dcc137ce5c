// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/channel/wire_slots.hpp"

#include <algorithm>
#include <cstring>
#include <new>
#include <ranges>
#include <type_traits>
#include <utility>

#include "runtime/cpp/src/channel/shared_header.hpp"
#include "runtime/cpp/src/platform/memory.hpp"

namespace rr::channel {
namespace {

constexpr std::size_t words_at = 0x100;
constexpr std::size_t heads_at = 0x200;
constexpr std::size_t slots_at = SharedHeader::first_data;
static_assert(words_at + sizeof(SlotWords<Synchronization>) <= heads_at &&
              heads_at + most_slots * sizeof(SlotHead<Synchronization>) <= slots_at);
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
// One for the newest value, one that is written, and others that readers use.
constexpr std::size_t large_slots = 5;
constexpr std::size_t slot_unit = 4096;
// Items of an array that are read in place: so many, as a slot that is used has its price, too.
constexpr std::size_t large_array = std::size_t{64} * 1024;
// Where the first of them begin.
constexpr std::size_t items_alignment = 64;
// After so many values in a row without a slot it is looked for readers that use too many.
constexpr unsigned most_without_slot = 16;

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
  return {slot, SlotSizes{slot, 0}.are_large() ? large_slots : small_slots};
}

std::size_t SlotSizes::memory() const { return slots_at + slot * count; }

bool SlotSizes::are_large() const { return slot > large_slot; }

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
    const std::uint64_t number = begin();
    if (number == 0) return false;
    time_ = time;
    number_ = number;
    put(value, size, number);
    Steps::commit(words_, heads_[number % sizes_.count], number);
  }
  ring();
  return true;
}

// The number of the next value, into whose slot may be written now; 0: there is none. The slot of
// the newest value is not asked for, since readers may be on their way to it.
[[gnu::hot]] std::uint64_t SlotWriter::begin() {
  if (holds_.empty()) {
    Steps::begin(heads_[(number_ + 1) % sizes_.count], number_ + 1);
    return number_ + 1;
  }
  const std::span<const Holds::value_type> holds(holds_);
  for (std::uint64_t number = number_ + 1; number < number_ + sizes_.count; ++number) {
    const std::size_t slot = number % sizes_.count;
    const auto is_used = [&] {
      return std::ranges::any_of(holds, [&](const auto& one) { return one->has(slot); });
    };
    if (is_used() || !Steps::try_to_begin(heads_[slot], number, is_used)) continue;
    without_slot_ = 0;
    return number;
  }
  if (++without_slot_ >= most_without_slot) refuse_greedy();
  return 0;
}

void SlotWriter::refuse_greedy() {
  without_slot_ = 0;
  std::erase_if(holds_, [](const auto& holds) { return holds->count() > SlotHolds::most; });
}

void SlotWriter::add_holds(std::shared_ptr<const ServedHolds> holds) {
  const MutexLock lock(mutex_);
  holds_.push_back(std::move(holds));
}

void SlotWriter::remove_holds(const ServedHolds& holds) {
  const MutexLock lock(mutex_);
  std::erase_if(holds_, [&](const auto& other) { return other.get() == &holds; });
}

// What is in the head, and the bytes.
[[gnu::hot]] void SlotWriter::put(std::span<const Piece> value, std::size_t size,
                                  std::uint64_t number) {
  const std::size_t slot = number % sizes_.count;
  Head& head = heads_[slot];
  std::uint32_t run_count = 0;
  std::size_t begin = 0;
  if (sizes_.are_large()) {
    std::size_t at = 0;
    for (const Piece& piece : value) {
      if (piece.is_attached && piece.size >= large_array && run_count < Head::most_runs) {
        if (run_count == 0) begin = (items_alignment - at % items_alignment) % items_alignment;
        const SlotRun run{static_cast<std::uint32_t>(at), static_cast<std::uint32_t>(piece.size)};
        head.runs[run_count++].store(run.packed(), std::memory_order_relaxed);
      }
      at += piece.size;
    }
    if (begin + size > sizes_.slot) begin = 0;
  }
  head.size.store(size, std::memory_order_relaxed);
  head.begin.store(static_cast<std::uint32_t>(begin), std::memory_order_relaxed);
  head.run_count.store(run_count, std::memory_order_relaxed);
  head.published.store(as_nanoseconds(Clock::now()), std::memory_order_relaxed);
  std::byte* at = memory_.bytes() + slots_at + slot * sizes_.slot + begin;
  for (const Piece& piece : value) {
    if (piece.size != 0) std::memcpy(at, piece.data, piece.size);
    at += piece.size;
  }
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
    : memory_(std::make_shared<const platform::SharedMemory>(std::move(memory))),
      sizes_(sizes),
      id_(id),
      words_(*slot_place<const Words>(*memory_, words_at)),
      heads_(slot_place<const Head>(*memory_, heads_at)) {}

std::unique_ptr<SlotReader> SlotReader::open(const platform::Descriptor& handle,
                                             std::error_code& error) {
  constexpr std::size_t largest = slots_at + SlotSizes::largest_slot * most_slots;
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
  const std::byte* const bytes = memory_->bytes() + slots_at + slot * sizes_.slot;
  const auto found = [&](Steps::State state) {
    is_torn = state == Steps::State::later;
    return state == Steps::State::wrong ? Found::wrong : Found::nothing;
  };
  const Steps::State before = Steps::look(head, number, sizes_.count);
  if (before != Steps::State::whole) return found(before);
  value.displaced = {};
  value.slot = {};
  value.gapped = {};
  // A reader that uses a slot without need keeps it from others.
  if (holds_ && head.run_count.load(std::memory_order_relaxed) != 0) value.slot = use(slot, number);
  if (value.slot) {
    const Steps::State used = Steps::look_at_used(head, number, sizes_.count);
    if (used != Steps::State::whole) return found(used);
  }
  const Contents contents(head);
  const bool are_right = contents.are_right(sizes_);
  if (are_right && value.slot) copy_around(bytes, contents, value);
  if (are_right && !value.slot) copy(bytes, contents, value);
  const Steps::State after = Steps::look_again(head, number, sizes_.count);
  if (after != Steps::State::whole) return found(after);
  if (!are_right) return Found::wrong;
  const Time published{std::chrono::nanoseconds(contents.published)};
  value.published = std::clamp(published, Time(), Clock::now());
  seen_ = number;
  return Found::value;
}

void SlotReader::copy(const std::byte* slot, const Contents& contents, SlotValue& value) {
  std::byte* bytes = value.room.data();
  if (contents.size > value.room.size()) {
    Allocation made = allocate(contents.size);
    bytes = made.bytes;
    value.owner = std::move(made.owner);
  } else {
    value.owner = {};
  }
  std::memcpy(bytes, slot + contents.begin, contents.size);
  value.bytes = {bytes, static_cast<std::size_t>(contents.size)};
}

// Where the parts of a value are put that are not left in its slot, as far apart as there.
class SlotReader::Gapped final : public Memory {
 public:
  explicit Gapped(std::size_t slot_size)
      : size_(slot_size), bytes(platform::map_pages(slot_size)) {}

 private:
  ~Gapped() {
    if (bytes != nullptr) platform::unmap_pages(bytes, size_, 0);
  }
  void destroy() noexcept override { delete this; }

  const std::size_t size_;

 public:
  std::byte* const bytes;  ///< null where the system has none
  std::array<DisplacedItems, Head::most_runs> displaced{};
};

// All but the items of large arrays, which stay in the slot. In their place is what was there
// before, if anything: nobody looks at it.
void SlotReader::copy_around(const std::byte* slot, const Contents& contents, SlotValue& value) {
  const std::byte* const from = slot + contents.begin;
  std::byte* const to = gapped_->bytes + contents.begin;
  std::size_t at = 0;
  for (std::uint32_t i = 0; i < contents.run_count; ++i) {
    const SlotRun& run = contents.runs[i];
    std::memcpy(to + at, from + at, run.begin - at);
    gapped_->displaced[i] = {{to + run.begin, run.size}, from + run.begin};
    at = std::size_t{run.begin} + run.size;
  }
  std::memcpy(to + at, from + at, contents.size - at);
  value.owner = {};
  value.bytes = {to, static_cast<std::size_t>(contents.size)};
  value.displaced = std::span(gapped_->displaced).first(contents.run_count);
  value.gapped = gapped_memory_;
}

SlotReader::Contents::Contents(const Head& head)
    : size(head.size.load(std::memory_order_relaxed)),
      published(head.published.load(std::memory_order_relaxed)),
      begin(head.begin.load(std::memory_order_relaxed)),
      run_count(head.run_count.load(std::memory_order_relaxed)) {
  for (std::size_t i = 0; i < runs.size(); ++i) {
    runs[i] = SlotRun::unpack(head.runs[i].load(std::memory_order_relaxed));
  }
}

bool SlotReader::Contents::are_right(const SlotSizes& sizes) const {
  if (size > sizes.slot || begin > sizes.slot - size || run_count > runs.size()) return false;
  std::uint64_t at = 0;
  for (const SlotRun& run : std::span(runs).first(run_count)) {
    if (run.begin < at || run.begin > size || run.size > size - run.begin) return false;
    at = std::uint64_t{run.begin} + run.size;
  }
  return true;
}

// A slot, for as long as an array in it is there.
class SlotReader::Use final : public Memory {
 public:
  Use(std::shared_ptr<SlotHolds> holds, std::size_t slot,
      std::shared_ptr<const platform::SharedMemory> memory)
      : Memory(Memory::Use::read_only),
        holds_(std::move(holds)),
        slot_(slot),
        memory_(std::move(memory)) {}

 private:
  void destroy() noexcept override {
    holds_->release(slot_);
    delete this;
  }

  const std::shared_ptr<SlotHolds> holds_;
  const std::size_t slot_;
  const std::shared_ptr<const platform::SharedMemory> memory_;
};

// Empty when the value is to be copied.
MemoryRef SlotReader::use(std::size_t slot, std::uint64_t number) {
  if (!gapped_memory_.is_unique()) {
    gapped_ = new Gapped(sizes_.slot);
    gapped_memory_ = MemoryRef(gapped_);
  }
  if (gapped_->bytes == nullptr) return {};
  auto used = std::make_unique<Use>(holds_, slot, memory_);
  if (!holds_->hold(slot, number)) return {};
  return MemoryRef(used.release());
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
