// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/channel/outbox.hpp"

#include <sys/socket.h>
#include <sys/uio.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

namespace rr::channel {
namespace {

// New segments are as large as what waits already, within these bounds.
constexpr std::size_t smallest_segment = 4096;
constexpr std::size_t largest_segment = 64 * 1024;
constexpr std::size_t pieces_at_once = 64;

iovec as_iovec(const std::byte* data, std::size_t size) {
  return {const_cast<std::byte*>(data), size};
}

// Sends without blocking. 0 when the socket takes nothing now, -1 when it is broken.
std::ptrdiff_t send_pieces(int socket, std::span<iovec> pieces) {
  msghdr message{};
  message.msg_iov = pieces.data();
  message.msg_iovlen = pieces.size();
  while (true) {
    const ssize_t sent = sendmsg(socket, &message, MSG_DONTWAIT | MSG_NOSIGNAL);
    if (sent >= 0) return sent;
    if (errno == EAGAIN || errno == EWOULDBLOCK) return 0;
    if (errno != EINTR) return -1;
  }
}

}  // namespace

void Outbox::add(std::span<const std::byte> bytes) {
  if (bytes.empty()) return;
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
  Allocation memory = allocate(capacity);
  std::memcpy(memory.bytes, bytes.data(), bytes.size());
  segments_.push_back(
      {std::move(memory.owner), memory.bytes, bytes.size(), capacity - bytes.size()});
}

void Outbox::add(Allocation memory, std::size_t size) {
  segments_.push_back({std::move(memory.owner), memory.bytes, size, 0});
  size_ += size;
}

void Outbox::add(Writer& message, std::size_t sent) {
  for (const Piece& piece : message.pieces()) {
    const std::size_t skipped = std::min(sent, piece.size);
    sent -= skipped;
    const std::span rest(piece.data + skipped, piece.size - skipped);
    if (rest.empty()) continue;
    if (MemoryRef owner = message.owner(piece)) {
      segments_.push_back({std::move(owner), rest.data(), rest.size(), 0});
      size_ += rest.size();
    } else {
      add(rest);
    }
  }
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
  fill(segments_[old->segment], message);
  return {&old->mark, true};
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

std::ptrdiff_t Outbox::send(int socket, std::span<const Piece> more) {
  if (empty() && more.size() == 1) {  // nearly always
    const ssize_t sent = ::send(socket, more[0].data, more[0].size, MSG_DONTWAIT | MSG_NOSIGNAL);
    if (sent == static_cast<ssize_t>(more[0].size)) return sent;
    if (sent >= 0 || errno == EAGAIN || errno == EWOULDBLOCK) return std::max<ssize_t>(sent, 0);
    if (errno != EINTR) return -1;
  }
  std::size_t more_sent = 0;
  while (true) {
    std::array<iovec, pieces_at_once> pieces;
    std::size_t count = 0;
    std::size_t wanted = 0;
    const auto add_piece = [&](const std::byte* data, std::size_t size) {
      pieces[count++] = as_iovec(data, size);
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
    const std::ptrdiff_t result = send_pieces(socket, std::span(pieces.data(), count));
    if (result < 0) return -1;
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
  while (bytes != 0) {
    Segment& segment = segments_[first_];
    const std::size_t dropped = std::min(bytes, segment.size);
    segment.data += dropped;
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
}

}  // namespace rr::channel
