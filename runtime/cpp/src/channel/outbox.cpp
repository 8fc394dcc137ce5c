// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/channel/outbox.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <iterator>
#include <limits>
#include <utility>

#include "rr/reader.hpp"
#include "runtime/cpp/src/channel/carrier.hpp"
#include "runtime/cpp/src/platform/sockets.hpp"

namespace rr::channel {
namespace {

// New segments are as large as what waits already, within these bounds.
constexpr std::size_t smallest_segment = 4096;
constexpr std::size_t largest_segment = 64 * 1024;
constexpr std::size_t pieces_at_once = 64;
// Messages were checked before they came here.
constexpr Limits any_size{.message_size = std::numeric_limits<std::uint32_t>::max()};

// Of what is sent: how much the socket takes now, or platform::broken.
std::ptrdiff_t taken(std::ptrdiff_t sent) { return sent == platform::nothing_now ? 0 : sent; }

}  // namespace

// A part of a message whose next one begins `lead` bytes on, or, for none, whole messages.
void Outbox::append(std::span<const std::byte> bytes, std::size_t lead) {
  const std::size_t waiting = std::exchange(size_, size_ + bytes.size());
  if (!empty() && !segments_.back().is_alone && segments_.back().room >= bytes.size()) {
    Segment& last = segments_.back();
    std::memcpy(const_cast<std::byte*>(last.data) + last.size, bytes.data(), bytes.size());
    last.size += bytes.size();
    last.room -= bytes.size();
    return;
  }
  const std::size_t capacity =
      std::max(std::clamp(waiting, smallest_segment, largest_segment), bytes.size());
  segments_.push_back(copied(bytes, capacity, lead));
}

Outbox::Segment Outbox::copied(std::span<const std::byte> bytes, std::size_t capacity,
                               std::size_t lead) {
  Allocation memory = allocate(capacity);
  std::memcpy(memory.bytes, bytes.data(), bytes.size());
  Segment segment;
  segment.owner = std::move(memory.owner);
  segment.data = memory.bytes;
  segment.size = bytes.size();
  segment.room = capacity - bytes.size();
  segment.lead = lead;
  return segment;
}

Outbox::Segment Outbox::kept(MemoryRef owner, std::span<const std::byte> bytes, std::size_t lead) {
  Segment segment;
  segment.owner = std::move(owner);
  segment.data = bytes.data();
  segment.size = bytes.size();
  segment.lead = lead;
  return segment;
}

void Outbox::add(Allocation memory, std::size_t size) {
  segments_.push_back(kept(std::move(memory.owner), {memory.bytes, size}, 0));
  size_ += size;
}

void Outbox::add(Writer& message, std::size_t sent) {
  std::size_t left = message.size();  // of the message, from the piece on
  for (const Piece& piece : message.pieces()) {
    const std::size_t skipped = std::min(sent, piece.size);
    sent -= skipped;
    left -= skipped;
    const std::span rest(piece.data + skipped, piece.size - skipped);
    if (rest.empty()) continue;
    const std::size_t lead = left == message.size() ? 0 : left;
    left -= rest.size();
    if (MemoryRef owner = message.owner(piece)) {
      segments_.push_back(kept(std::move(owner), rest, lead));
      size_ += rest.size();
    } else {
      append(rest, lead);
    }
  }
}

// The position is that of a message, so no segment that may be replaced is cut.
void Outbox::add_urgent(Writer& message) {
  const std::size_t offset = std::max(fixed_, rest_of_begun());
  const std::size_t place = split(offset);
  std::vector<Segment> added;
  std::size_t left = message.size();
  for (const Piece& piece : message.pieces()) {
    const std::size_t lead = left == message.size() ? 0 : left;
    const std::span bytes(piece.data, piece.size);
    MemoryRef owner = message.owner(piece);
    added.push_back(owner ? kept(std::move(owner), bytes, lead) : copied(bytes, piece.size, lead));
    left -= piece.size;
  }
  for (Replaceable& item : replaceable_) {
    if (item.segment >= place) item.segment += added.size();
  }
  segments_.insert(segments_.begin() + static_cast<std::ptrdiff_t>(place),
                   std::make_move_iterator(added.begin()), std::make_move_iterator(added.end()));
  size_ += message.size();
  fixed_ = offset + message.size();
}

// How many of the bytes that wait belong to a message of which others have been sent. Found by
// reading the sizes of the messages in the first segment, of which nothing is gone yet.
std::size_t Outbox::rest_of_begun() const {
  if (empty()) return 0;
  const Segment& segment = segments_[first_];
  const std::span all(segment.data - segment.sent, segment.sent + segment.size);
  std::size_t at = segment.lead;
  while (at < segment.sent) {
    const std::size_t size = message_size(all.subspan(at), any_size);
    if (size == 0) return size_;  // not what we know: nothing is overtaken
    at += size;
  }
  return at - segment.sent;
}

// Makes a segment begin so many bytes on in what waits; returns its place.
std::size_t Outbox::split(std::size_t offset) {
  std::size_t place = first_;
  while (place < segments_.size() && offset >= segments_[place].size) {
    offset -= segments_[place++].size;
  }
  if (offset == 0) return place;
  Segment& first = segments_[place];
  Segment second = kept(first.owner, {first.data + offset, first.size - offset}, 0);
  second.room = std::exchange(first.room, 0);
  first.size = offset;
  ++place;
  for (Replaceable& item : replaceable_) {
    if (item.segment >= place) ++item.segment;
  }
  segments_.insert(segments_.begin() + static_cast<std::ptrdiff_t>(place), std::move(second));
  return place;
}

Outbox::Queued Outbox::add_newest(Writer& message, std::uint64_t stream, std::int64_t time) {
  Replaceable* const old = find(stream);
  if (old == nullptr) {
    segments_.emplace_back().is_alone = true;
    fill(segments_.back(), message);
    replaceable_.push_back({stream, time, segments_.size() - 1});
    return {&replaceable_.back().mark, false};
  }
  if (time <= old->time) return {};
  old->time = time;
  const bool is_fixed = fixed_ != 0 && offset_of(old->segment) < fixed_;
  if (is_fixed) fixed_ -= segments_[old->segment].size;
  fill(segments_[old->segment], message);
  if (is_fixed) fixed_ += message.size();
  return {&old->mark, true};
}

// Bytes that wait before a segment.
std::size_t Outbox::offset_of(std::size_t segment) const {
  std::size_t offset = 0;
  for (std::size_t i = first_; i < segment; ++i) offset += segments_[i].size;
  return offset;
}

// What waits of a stream; null when there is nothing that may be replaced. Forgets on the way what
// has been sent.
Outbox::Replaceable* Outbox::find(std::uint64_t stream) {
  for (std::size_t i = 0; i < replaceable_.size();) {
    Replaceable& item = replaceable_[i];
    if (item.segment < first_ || segments_[item.segment].is_begun) {
      item = replaceable_.back();
      replaceable_.pop_back();
    } else if (item.stream == stream) {
      return &item;
    } else {
      ++i;
    }
  }
  return nullptr;
}

void Outbox::fill(Segment& segment, Writer& message) {
  const std::size_t capacity = segment.size + segment.room;
  size_ += message.size() - segment.size;
  if (capacity < message.size()) {
    Allocation memory = allocate(message.size());
    segment.owner = std::move(memory.owner);
    segment.data = memory.bytes;
    segment.room = 0;
  } else {
    segment.room = capacity - message.size();
  }
  segment.size = message.size();
  auto* at = const_cast<std::byte*>(segment.data);
  for (const Piece& piece : message.pieces()) {
    std::memcpy(at, piece.data, piece.size);
    at += piece.size;
  }
}

[[gnu::hot]] std::ptrdiff_t Outbox::send(int socket, std::span<const Piece> more,
                                         Carrier* carrier) {
  if (empty() && more.size() == 1 && carrier == nullptr) {  // nearly always
    return taken(platform::send(socket, {more[0].data, more[0].size}));
  }
  std::size_t more_sent = 0;
  while (true) {
    std::array<platform::Buffer, pieces_at_once> pieces;
    std::size_t count = 0;
    std::size_t wanted = 0;
    const auto add_piece = [&](const std::byte* data, std::size_t size) {
      pieces[count++] = {data, size};
      wanted += size;
    };
    for (std::size_t i = first_; i < segments_.size() && count < pieces.size(); ++i) {
      add_piece(segments_[i].data, segments_[i].size);
    }
    const std::size_t own = wanted;
    std::size_t skipped = more_sent;
    for (const Piece& piece : more) {
      if (count == pieces.size()) break;
      const std::size_t skip = std::min(skipped, piece.size);
      skipped -= skip;
      if (skip != piece.size) add_piece(piece.data + skip, piece.size - skip);
    }
    if (count == 0) break;
    const std::span used(pieces.data(), count);
    const std::ptrdiff_t result =
        carrier == nullptr ? taken(platform::send_gathered(socket, used)) : carrier->send(used);
    if (result < 0) return platform::broken;
    const auto sent = static_cast<std::size_t>(result);
    drop(std::min(sent, own));
    more_sent += sent - std::min(sent, own);
    if (sent != wanted) break;
    if (count != pieces.size()) break;  // that was all
  }
  return static_cast<std::ptrdiff_t>(more_sent);
}

void Outbox::drop(std::size_t bytes) {
  size_ -= bytes;
  fixed_ -= std::min(fixed_, bytes);
  while (bytes != 0) {
    Segment& segment = segments_[first_];
    const std::size_t dropped = std::min(bytes, segment.size);
    segment.data += dropped;
    segment.sent += dropped;
    segment.size -= dropped;
    bytes -= dropped;
    segment.is_begun = true;
    if (segment.size != 0) break;
    segment.owner = MemoryRef();
    ++first_;
  }
  if (empty()) {
    clear();
  } else {
    compact();
  }
}

// A queue that never gets empty is not to grow for ever.
void Outbox::compact() {
  constexpr std::size_t worthwhile = 64;
  if (first_ < worthwhile || first_ < segments_.size() / 2) return;
  std::erase_if(replaceable_, [&](const Replaceable& item) { return item.segment < first_; });
  for (Replaceable& item : replaceable_) item.segment -= first_;
  segments_.erase(segments_.begin(), segments_.begin() + static_cast<std::ptrdiff_t>(first_));
  first_ = 0;
}

void Outbox::clear() {
  std::vector<Segment>().swap(segments_);
  std::vector<Replaceable>().swap(replaceable_);
  first_ = 0;
  size_ = 0;
  fixed_ = 0;
}

}  // namespace rr::channel
