// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/client/pipe_end.hpp"

#include <new>
#include <string>
#include <utility>

#include "rr/error.hpp"
#include "rr/type.hpp"
#include "runtime/cpp/src/client/pipes.hpp"
#include "runtime/cpp/src/client/session.hpp"

namespace rr::client {
namespace {

using channel::PipeRingReader;
using endpoint::RingWish;

// After the client was too slow for the ring it gets messages for so long.
constexpr std::chrono::seconds time_without_ring{1};
// Packets that are taken in one turn of a thread.
constexpr int packets_in_a_turn = 256;
// The same before the end: as many as the queue of an end takes.
constexpr int packets_at_the_end = 65'536;

constexpr Parameter again_parameters[] = {parameter<std::int32_t>("index"),
                                          {endpoint::ring_again_element, &type_of<std::uint32_t>}};

// A client for whose request there was no good answer gets messages.
class AskedRing final : public Completion {
 public:
  void* result() override { return nullptr; }
  void succeed() override {}
  void fail(std::exception_ptr /*error*/) override {}
};

}  // namespace

RingWish ClientPipeEnd::wish(const channel::Connection& connection, const Member& member) {
  const bool has_packets = (member.access & writeonly) == 0;
  return has_packets && connection.shares_slots() ? RingWish::ring : RingWish::messages;
}

std::shared_ptr<Pipes> ClientPipeEnd::pipes() const {
  return std::static_pointer_cast<Pipes>(side());
}

void ClientPipeEnd::take_answer(Decoder& decoder, const Entry& entry) {
  const auto side = pipes();
  if (side && side->connection().shares_slots()) set_ring(decoder, entry);
}

// What the service has answered to a request for a ring. With the read lease.
void ClientPipeEnd::set_ring(Decoder& decoder, const Entry& entry) {
  const auto side = pipes();
  const channel::PipeRingStart start = endpoint::find_ring(decoder, entry);
  if (!side || start.id == 0) return;
  auto ring = side->connection().take_ring(start);
  if (!ring) {
    ask_soon(RingWish::messages);
    return;
  }
  use_numbers();
  const MutexLock lock(ring_mutex_);
  ring_ = std::move(ring);
  next_ = static_cast<std::uint32_t>(start.number);
  is_due_ = false;
  is_reading_ring_.store(true, std::memory_order_release);
}

void ClientPipeEnd::drop_ring() {
  is_reading_ring_.store(false, std::memory_order_release);
  ring_.reset();
}

// What follows comes by messages.
void ClientPipeEnd::leave_ring() {
  drop_ring();
  left_at_ = channel::coarse_now();
  wants_ring_ = true;
}

void ClientPipeEnd::stop_reading() {
  const MutexLock lock(ring_mutex_);
  drop_ring();
}

void ClientPipeEnd::take_notice() { drain({.asks = is_listening(), .is_here = true}); }

void ClientPipeEnd::take_rest() {
  drain({.is_last = true});
  stop_reading();
}

// Reading

[[gnu::hot]] void ClientPipeEnd::drain(Draining how) {
  const auto side = pipes();
  if (!side) return;
  const auto types = side->types();
  bool has_taken = false;
  for (int left = how.is_last ? packets_at_the_end : packets_in_a_turn; left != 0; --left) {
    const Read read = read_one(*types, how.asks);
    if (read == Read::nothing) {
      if (has_taken && !how.is_here && is_listening()) deliver_soon();
      return;
    }
    if (read == Read::wrong) {
      side->connection().close({ErrorCode::protocol_error,
                                "the other side has written into the memory of the pipe `" +
                                    std::string(identity.member->name) + "` what cannot be there"});
      return;
    }
    has_taken = true;
    if (how.is_here) deliver();
    if (read == Read::full) {
      side->close(*this, false);
      return;
    }
  }
  if (!how.is_last) go_on();
}

// A thread that had much to read gives others their turn.
void ClientPipeEnd::go_on() {
  core()->reactor().post([self = std::static_pointer_cast<ClientPipeEnd>(shared_from_this())] {
    self->drain({.asks = self->is_listening(), .is_here = true});
  });
}

[[gnu::hot]] ClientPipeEnd::Read ClientPipeEnd::read_one(const TypeRegistry& types, bool asks) {
  channel::RingPacket packet;
  const MutexLock lock(ring_mutex_);
  while (ring_) {
    // Messages of before may still be on their way to here: few packets are kept for earlier ones.
    if (!is_due_ && !has_come_up_to(next_)) return Read::nothing;
    is_due_ = true;
    PipeRingReader::Found found = PipeRingReader::Found::nothing;
    try {
      found = ring_->read(packet);
    } catch (const std::bad_alloc&) {
      ask_soon(RingWish::messages);  // it may be had later, whichever way it comes
      return Read::nothing;
    }
    switch (found) {
      case PipeRingReader::Found::packet:
        return take(packet, types) ? Read::packet : Read::full;
      case PipeRingReader::Found::wrong:
        drop_ring();
        return Read::wrong;
      case PipeRingReader::Found::late:
        leave_ring();
        return Read::nothing;
      case PipeRingReader::Found::nothing:
        if (ring_->is_at_end()) {
          leave_ring();
          return Read::nothing;
        }
        if (!asks || ring_->ask()) return Read::nothing;
        break;
    }
  }
  return Read::nothing;
}

// False when the end is to be closed. One of another type is dropped, as one in a message.
bool ClientPipeEnd::take(const channel::RingPacket& packet, const TypeRegistry& types) {
  const std::uint32_t number = next_++;
  std::shared_ptr<void> value = identity.holding->make();
  Decoder decoder(MessageVersion::v4, nullptr, packet.owner, &types);
  ElementReader elements(decoder, packet.bytes, 1);
  Element element;
  if (!elements.next(element) || element.name != "packet" ||
      !identity.member->type->read(decoder, element, value.get())) {
    return true;
  }
  return accept(number, std::move(value), packet.bytes.size());
}

// Asking

void ClientPipeEnd::note_packet() {
  if (is_reading_ring_.load(std::memory_order_acquire)) {
    drain({.asks = is_listening(), .is_here = true});
  }
  if (!wants_ring_.load(std::memory_order_relaxed)) return;
  {
    const MutexLock lock(ring_mutex_);
    if (channel::coarse_now() - left_at_ < time_without_ring) return;
    if (!wants_ring_.exchange(false)) return;
  }
  ask(RingWish::ring);
}

void ClientPipeEnd::ask(RingWish wish) {
  const auto side = pipes();
  if (!side) return;
  const auto asked = static_cast<std::uint32_t>(wish);
  const void* const values[] = {&identity.index, &asked};
  const auto self = std::static_pointer_cast<ClientPipeEnd>(shared_from_this());
  try {
    side->session().start(
        {EntryType::pipe_connect_req, identity.path, identity.member->name, again_parameters,
         values},
        [self](Decoder& decoder, const Message&, const Entry& entry) {
          self->set_ring(decoder, entry);
          self->go_on();
        },
        std::chrono::milliseconds(0), std::make_shared<AskedRing>());
  } catch (const Error&) {
    // The session has ended.
  }
}

void ClientPipeEnd::ask_soon(RingWish wish) {
  core()->reactor().post([self = std::static_pointer_cast<ClientPipeEnd>(shared_from_this()),
                          wish] { self->ask(wish); });
}

}  // namespace rr::client
