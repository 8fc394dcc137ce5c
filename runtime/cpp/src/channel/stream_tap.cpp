// SPDX-License-Identifier: Apache-2.0
// What a connection tells the tap of its node.
#include "runtime/cpp/src/channel/stream_connection.hpp"

namespace rr::channel {
void StreamConnection::open_tap() {
  const bool is_client = role_ == Role::client;
  const std::string own = url_of(local_address(socket_.get()));
  const std::string remote = url_of(channel::remote_address(socket_.get()));
  tap_number_ = tap_->opened({.side = is_client ? TapSide::client : TapSide::service,
                              .client_url = is_client ? own : remote,
                              .service_url = is_client ? remote : own});
}

std::uint64_t StreamConnection::tell_tap(bool is_own, std::span<const Piece> message) const {
  const bool is_request = is_own == (role_ == Role::client);
  return tap_->message(tap_number_, is_request ? Direction::to_service : Direction::to_client,
                       message);
}

void StreamConnection::tell_handshake(std::span<const std::byte> request,
                                      std::span<const std::byte> answer) {
  if (tap_ == nullptr) return;
  const Piece sent{request.data(), request.size()};
  const Piece received{answer.data(), answer.size()};
  tell_tap(true, {&sent, 1});
  tell_tap(false, {&received, 1});
}

// Under sending_. What streams have left behind goes first, and nothing comes in between: the tap
// hears of messages in the order in which they leave.
std::uint64_t StreamConnection::take_streamed_and_tell(Writer& message) {
  const std::lock_guard lock(streaming_);
  move_streamed();
  return tell_tap(true, message.pieces());
}

// Under sending_. A message that waits where another one of its stream did is told as such; one
// that is older than that is not sent.
void StreamConnection::queue_newest_and_tell(Writer& message, const Newest& newest) {
  const std::lock_guard lock(streaming_);
  move_streamed();
  const Outbox::Queued queued = outbox_.add_newest(message, newest.stream, newest.time);
  if (queued.mark == nullptr) return;
  if (queued.is_replacement) tap_->replaced(tap_number_, *queued.mark);
  *queued.mark = tell_tap(true, message.pieces());
}

}  // namespace rr::channel
