// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/service/ring_readers.hpp"

#include <algorithm>
#include <atomic>
#include <new>
#include <system_error>

#include "runtime/cpp/src/service/counted_memory.hpp"

namespace rr::service {
namespace {

using Steps = channel::PipeRingWriter::Steps;

// Never 0, which is in unused words.
std::uint64_t next_turn() {
  static std::atomic<std::uint64_t> turns{0};
  return turns.fetch_add(1, std::memory_order_relaxed) + 1;
}

}  // namespace

std::size_t RingReaders::find(const PipeEnd::State& end) const {
  const auto found = std::ranges::find_if(
      readers_, [&](const Reader& reader) { return reader.end.get() == &end; });
  return static_cast<std::size_t>(found - readers_.begin());
}

bool RingReaders::has_restricted() const {
  return std::ranges::any_of(readers_, [](const Reader& reader) { return reader.is_restricted; });
}

bool RingReaders::make(const std::shared_ptr<channel::SlotBudget>& of_node) {
  const auto size = channel::PipeRingSize::for_packet(largest_);
  if (size.ring == 0) return false;
  is_used_up_ = false;
  ring_ = make_counted<channel::PipeRingWriter>(of_node, size.memory(), size);
  return ring_ != nullptr;
}

std::shared_ptr<channel::PipeRingWriter> RingReaders::add(Joining joining,
                                                          channel::PipeRingStart& start) {
  if (!ring_ && !make(joining.of_node)) return nullptr;
  channel::SlotShare share(joining.of_session, ring_->size().memory());
  const auto number = share.is_drawn() ? ring_->admit() : std::nullopt;
  if (!number) {
    if (readers_.empty()) ring_.reset();
    // With many readers at once, memories would be replaced without end.
    is_used_up_ = share.is_drawn() && readers_.size() <= channel::pipe_ring_readers / 2;
    return nullptr;
  }
  const std::uint64_t turn = next_turn();
  start = {.id = ring_->id(),
           .position = ring_->position(),
           .place = joining.holds->place(),
           .turn = turn,
           .reader = *number};
  readers_.push_back({std::move(joining.end), joining.is_restricted, turn, *number,
                      ring_->position(), ring_->count(), 0, std::move(share),
                      std::move(joining.holds)});
  return ring_;
}

[[gnu::hot]] bool RingReaders::put(std::span<const std::byte> packet, Ends& notified) {
  largest_ = std::max(largest_, packet.size());
  if (is_used_up_ || !ring_->size().fits(packet.size())) {
    leave_all();
    return false;
  }
  make_room(packet.size());
  if (readers_.empty()) return false;
  ring_->put(packet);
  for (Reader& reader : readers_) {
    const std::uint64_t asked = Steps::asked(reader.holds->words(), reader.turn);
    if (asked == reader.answered) continue;
    reader.answered = asked;
    notified.push_back(reader.end);
  }
  return true;
}

// Those that are furthest behind leave, and what all others have read is given up.
[[gnu::hot]] void RingReaders::make_room(std::size_t size) {
  const std::uint64_t needed = ring_->must_give_up(size);
  if (needed == 0) return;
  std::uint64_t kept_from = ring_->position();
  for (std::size_t place = readers_.size(); place-- != 0;) {
    Reader& reader = readers_[place];
    update(reader);
    if (reader.position < needed) {
      take_out(place);
    } else {
      kept_from = std::min(kept_from, reader.position);
    }
  }
  if (ring_) ring_->give_up(kept_from);
}

// What a client says is taken for what may be.
void RingReaders::update(Reader& reader) const {
  const std::uint64_t cursor = Steps::cursor(reader.holds->words(), reader.turn);
  if (cursor > reader.position && ring_->has(cursor)) reader.position = cursor;
}

endpoint::MissedPackets RingReaders::missed_by(const Reader& reader) const {
  endpoint::MissedPackets missed;
  const std::uint64_t all = ring_->count() - reader.joined;
  try {
    const bool is_right =
        ring_->for_each_from(reader.position, [&](Allocation packet, std::size_t size) {
          missed.packets.push_back({std::move(packet.owner), packet.bytes, size});
        });
    missed.is_lost = !is_right || missed.packets.size() > all;
  } catch (const std::bad_alloc&) {
    missed.is_lost = true;
  }
  if (missed.is_lost) missed.packets.clear();
  missed.read = all - missed.packets.size();
  return missed;
}

void RingReaders::take_out(std::size_t place) {
  Reader& reader = readers_[place];
  update(reader);
  ring_->dismiss(reader.number);
  missed_.emplace_back(reader.end.get(), missed_by(reader));
  left_.push_back(std::move(reader.end));
  readers_.erase(readers_.begin() + static_cast<std::ptrdiff_t>(place));
  if (readers_.empty()) ring_.reset();
}

void RingReaders::leave(const PipeEnd::State& end) {
  const std::size_t place = find(end);
  if (place != readers_.size()) take_out(place);
}

void RingReaders::leave_all() {
  while (!readers_.empty()) take_out(readers_.size() - 1);
}

endpoint::MissedPackets RingReaders::take_missed(const PipeEnd::State& end) {
  leave(end);
  const auto found =
      std::ranges::find_if(missed_, [&](const Missed& missed) { return missed.first == &end; });
  if (found == missed_.end()) return {};
  endpoint::MissedPackets missed = std::move(found->second);
  missed_.erase(found);
  return missed;
}

void RingReaders::forget(const PipeEnd::State& end) {
  std::erase_if(missed_, [&](const Missed& missed) { return missed.first == &end; });
  const std::size_t place = find(end);
  if (place == readers_.size()) return;
  ring_->dismiss(readers_[place].number);
  readers_.erase(readers_.begin() + static_cast<std::ptrdiff_t>(place));
  if (readers_.empty()) ring_.reset();
}

}  // namespace rr::service
