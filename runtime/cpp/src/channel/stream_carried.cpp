// SPDX-License-Identifier: Apache-2.0
// What a connection receives through a carrier.
#include <cerrno>
#include <utility>

#include "rr/printable.hpp"
#include "runtime/cpp/src/channel/stream_connection.hpp"

namespace rr::channel {
namespace {

bool is_nothing_yet(std::ptrdiff_t size) {
  return size < 0 && (errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR);
}

}  // namespace

Carrier* StreamConnection::sending_carrier() {
  const std::lock_guard lock(sending_);
  return carrier_.get();
}

StreamConnection::Received StreamConnection::receive_carried(Scratch& scratch, bool may_block,
                                                             bool& is_full) {
  if (carrier_->carries_messages()) return receive_messages(scratch, may_block);
  const Received received = receive_bytes(scratch, may_block, is_full);
  // Words of its own: of a handshake, answers to pings.
  if (carrier_->unsent() != 0) flush();
  return received;
}

// All messages that are there.
StreamConnection::Received StreamConnection::receive_messages(Scratch& scratch, bool may_block) {
  Received result = Received::nothing;
  do {
    Frame frame;
    const std::ptrdiff_t size = carrier_->receive(frame, may_block);
    if (is_nothing_yet(size)) return result;
    if (size <= 0) {
      return fail_reading({ErrorCode::connection_error, "the other side closed the connection"});
    }
    last_received_.store(coarse_now(), std::memory_order_relaxed);
    may_block = false;
    result = Received::some;
    const std::size_t whole = message_size(frame.bytes, limits());
    if (whole == 0 || whole != frame.bytes.size() || !take(scratch, frame)) {
      return fail_reading(
          {ErrorCode::protocol_error, "the other side sent bytes that are no message"});
    }
  } while (carrier_->has_received());
  return result;
}

// All bytes that the carrier has: none are left where no event would tell of them.
StreamConnection::Received StreamConnection::receive_bytes(Scratch& scratch, bool may_block,
                                                           bool& is_full) {
  Received result = Received::nothing;
  do {
    if (!inbox_.may_grow()) return wait_for_memory();
    const std::span<std::byte> room = this->room(scratch);
    const std::ptrdiff_t size = carrier_->receive(room, may_block);
    if (is_nothing_yet(size)) return result;
    if (size <= 0) {
      const std::string failure = carrier_->failure();
      if (failure.empty()) {
        return fail_reading({ErrorCode::connection_error, "the other side closed the connection"});
      }
      if (options_->log) {
        options_->log(LogLevel::warning,
                      "a connection was refused, or has failed: " + printable(failure));
      }
      return fail_reading({ErrorCode::connection_error, failure});
    }
    last_received_.store(coarse_now(), std::memory_order_relaxed);
    may_block = false;
    is_full = true;  // the socket may have more
    if (!was_heard_ && is_layered_ && !is_proven_) note_peer();
    result = take_bytes(scratch, static_cast<std::size_t>(size));
    if (result != Received::some) return result;
  } while (carrier_->has_received());
  return result;
}

}  // namespace rr::channel
