// SPDX-License-Identifier: Apache-2.0
// What a connection receives through a carrier.
#include <system_error>
#include <utility>

#include "rr/printable.hpp"
#include "runtime/cpp/src/channel/logging.hpp"
#include "runtime/cpp/src/channel/stream_connection.hpp"
#include "runtime/cpp/src/channel/stream_sizes.hpp"
#include "runtime/cpp/src/channel/tls.hpp"

namespace rr::channel {
StreamConnection::Received StreamConnection::receive_carried(Scratch& scratch, bool may_block,
                                                             bool& is_full) {
  if (layers_.carrier()->carries_messages()) return receive_messages(scratch, may_block);
  const Received received = receive_bytes(scratch, may_block, is_full);
  // Words of its own: of a handshake, answers to pings.
  if (layers_.carrier()->unsent() != 0) flush();
  SharedCarrier* const shared = layers_.shared();
  if (shared != nullptr && shared->has_taken_bells() && sending_.has_unsent()) flush();
  return received;
}

// All messages that are there.
StreamConnection::Received StreamConnection::receive_messages(Scratch& scratch, bool may_block) {
  Received result = Received::nothing;
  Carrier* const carrier = layers_.carrier();
  do {
    Frame frame;
    const std::ptrdiff_t size = carrier->receive(frame, may_block);
    if (size == platform::nothing_now) return result;
    if (size <= 0) {
      return fail_reading({ErrorCode::connection_error, "the other side closed the connection"});
    }
    note_received();
    may_block = false;
    result = Received::some;
    const std::size_t whole = message_size(frame.bytes, limits());
    if (whole == 0 || whole != frame.bytes.size() || !take(scratch, frame)) {
      return fail_reading(
          {ErrorCode::protocol_error, "the other side sent bytes that are no message"});
    }
  } while (carrier->has_received());
  return result;
}

// All bytes that the carrier has: none are left where no event would tell of them.
StreamConnection::Received StreamConnection::receive_bytes(Scratch& scratch, bool may_block,
                                                           bool& is_full) {
  Received result = Received::nothing;
  do {
    if (!inbox_.may_grow()) return wait_for_memory();
    const std::span<std::byte> room = this->room(scratch);
    // Another one when the bytes before asked for a layer.
    Carrier* const carrier = layers_.carrier();
    const std::ptrdiff_t size = carrier->receive(room, may_block);
    if (size == platform::nothing_now) return result;
    if (size <= 0) {
      const std::string failure = carrier->failure();
      if (failure.empty()) {
        return fail_reading({ErrorCode::connection_error, "the other side closed the connection"});
      }
      if (Metrics* const metrics = keep_alive_.was_heard() ? nullptr : reactor_->metrics()) {
        metrics->count_failed_handshake();
      }
      log(*options_, LogLevel::warning,
          "a connection was refused, or has failed: " + printable(failure), remote_address_);
      return fail_reading({ErrorCode::connection_error, failure});
    }
    note_received();
    may_block = false;
    is_full = true;  // the socket may have more
    if (!keep_alive_.was_heard() && layers_.is_layered() && !layers_.is_proven()) note_peer();
    result = take_bytes(scratch, static_cast<std::size_t>(size));
    if (result != Received::some) return result;
  } while (layers_.carrier()->has_received());
  return result;
}

// What was received is for a layer, not for the inbox.
StreamConnection::Received StreamConnection::upgrade(Scratch& scratch, std::size_t size,
                                                     std::unique_ptr<Layer> layer) {
  layers_.add(std::move(layer), std::span(scratch.bytes).first(size));
  bool is_full = false;
  const Received received = receive_bytes(scratch, false, is_full);
  if (layers_.carrier()->unsent() != 0) flush();
  return received == Received::nothing ? Received::some : received;
}

// With the read lease: what the other side has proved to be, and will be looked at again for.
void StreamConnection::note_peer() {
  auto proof = layers_.take_proof();
  if (proof && terms_.tls) terms_.tls->watch(shared_from_this(), std::move(proof));
}

// Shared memory

// What a client may ask for: once, and before it has a session.
bool StreamConnection::may_share() const {
  return terms_.shares_memory && role_ == Role::server && layers_.carrier() == nullptr &&
         !is_authorised_.load(std::memory_order_relaxed);
}

// Null when there is no memory for it, or the client's account has no room.
std::unique_ptr<SharedCarrier> StreamConnection::make_shared_carrier(Descriptor& handle) {
  Charge charge(account_);
  if (!charge.add(SharedRings::memory_size(shared_ring_size))) return nullptr;
  std::error_code error;
  SharedRings rings = SharedRings::make(shared_ring_size, handle, error);
  if (!rings) return nullptr;
  return std::make_unique<SharedCarrier>(std::move(rings), true, socket_.get(), options_->spin,
                                         std::move(charge));
}

// The answer is the last message that goes by the socket. With the read lease.
void StreamConnection::share_memory(Writer& answer, const Descriptor& handle,
                                    std::unique_ptr<SharedCarrier> carrier) {
  if (!sending_.change_over(answer, handle, *carrier)) {
    close({ErrorCode::protocol_error, "the other side does not take the memory it has asked for"});
    return;
  }
  layers_.share(std::move(carrier));
  const MutexLock lock(mutex_);
  watch_.use_bell(sending_.has_unsent());
}

bool StreamConnection::shares_slots() const {
  const SharedCarrier* const shared = layers_.shared();
  return shared != nullptr && shared->has_slots();
}

bool StreamConnection::pass_memory(const platform::Descriptor& handle) {
  SharedCarrier* const shared = layers_.shared();
  return shared != nullptr && !is_closed() && shared->pass_memory(handle);
}

std::shared_ptr<SlotReader> StreamConnection::take_slots(std::uint64_t id,
                                                         std::optional<std::uint32_t> holds) {
  SharedCarrier* const shared = layers_.shared();
  return shared == nullptr ? nullptr : shared->take_slots(id, holds);
}

std::shared_ptr<PipeRingReader> StreamConnection::take_ring(const PipeRingStart& start) {
  SharedCarrier* const shared = layers_.shared();
  return shared == nullptr ? nullptr : shared->take_ring(start);
}

std::shared_ptr<ServedHolds> StreamConnection::draw_holds() {
  SharedCarrier* const shared = layers_.shared();
  return shared == nullptr ? nullptr : shared->draw_holds();
}

// Bytes that came together with the request did not come through the memory.
StreamConnection::Received StreamConnection::begin_sharing() {
  layers_.forget_sharing();
  if (inbox_.is_assembling() || !inbox_.kept().empty() || layers_.has_bytes_behind()) {
    return fail_reading(
        {ErrorCode::protocol_error, "the other side speaks before it shares memory"});
  }
  return Received::some;
}

// What follows on the connection is TLS. Bytes that came together with the request in clear are not
// taken for something that was said inside.
StreamConnection::Received StreamConnection::begin_tls() {
  layers_.forget_tls();
  keep_alive_.set_heard(false);  // so that the handshake has its time limit too
  const Carrier* const carrier = layers_.carrier();
  const bool has_more = inbox_.is_assembling() || !inbox_.kept().empty() ||
                        (carrier != nullptr && carrier->has_received()) ||
                        layers_.has_bytes_behind();
  if (has_more || !sending_.is_empty()) {
    return fail_reading({ErrorCode::protocol_error, "the other side speaks before it uses TLS"});
  }
  try {
    layers_.begin_tls();
  } catch (const Error& error) {
    return fail_reading(error);
  }
  return Received::some;
}

}  // namespace rr::channel
