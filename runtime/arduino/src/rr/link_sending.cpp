// SPDX-License-Identifier: Apache-2.0
// What goes out: replies, what waits in the queue, values of wires.
#include "frame.h"
#include "link.h"

namespace rr {

using serial::Kind;

namespace {

/// Bytes of an entry of the queue before its body: length and kind.
constexpr uint8_t entryOverhead = 2;
/// How many bytes one poll() gives to a stream that does not say how many it takes.
constexpr uint8_t blindBytes = 8;

}  // namespace

void Link::sendOut(Kind kind, uint8_t sequence, uint8_t length) {
  finishFrame(memory_.out, kind, sequence, length);
  state_.sendAt = memory_.out;
}

void Link::answer(Kind kind, uint8_t length) {
  finishFrame(memory_.reply, kind, state_.sequence, length);
  // An older answer that is on its way is cut off by the zero in front of this one.
  if (state_.isAnswering) state_.sendAt = nullptr;
  state_.isAnswering = false;
  state_.hasReply = true;
}

bool Link::start(Kind kind, uint8_t object, uint8_t member) {
  if (state_.session == 0 || state_.queueCount + entryOverhead > memory_.queueSize) return false;
  const uint16_t room =
      static_cast<uint16_t>(memory_.queueSize - state_.queueCount - entryOverhead);
  const uint8_t limit = static_cast<uint8_t>(memory_.outSize - serial::frameOverhead);
  pending_ = Writer(memory_.queue + state_.queueCount + entryOverhead,
                    room < limit ? static_cast<uint8_t>(room) : limit);
  state_.pendingKind = kind;
  pending_.putByte(object);
  pending_.putByte(member);
  // Whose call it belongs to: the host knows by its number.
  if (kind == Kind::Ask) pending_.putByte(state_.sequence);
  return true;
}

bool Link::finish() {
  if (!pending_.isGood()) return false;
  memory_.queue[state_.queueCount] = pending_.count();
  memory_.queue[state_.queueCount + 1] = static_cast<uint8_t>(state_.pendingKind);
  state_.queueCount = static_cast<uint16_t>(state_.queueCount + entryOverhead + pending_.count());
  return true;
}

void Link::removeQueued() {
  const uint16_t size = static_cast<uint16_t>(memory_.queue[0] + entryOverhead);
  state_.queueCount = static_cast<uint16_t>(state_.queueCount - size);
  memmove(memory_.queue, memory_.queue + size, state_.queueCount);
  state_.isQueuedSent = false;
}

void Link::sendQueued() {
  const uint8_t length = memory_.queue[0];
  memcpy(memory_.out + sentBodyAt, memory_.queue + entryOverhead, length);
  if (!state_.isQueuedSent) ++state_.outSequence;
  state_.isQueuedSent = true;
  state_.queuedAt = static_cast<uint16_t>(millis());
  sendOut(static_cast<Kind>(memory_.queue[1]), state_.outSequence, length);
}

void Link::chooseNext() {
  state_.isAnswering = state_.hasReply;
  if (state_.hasReply) {
    state_.hasReply = false;
    state_.sendAt = memory_.reply;
    return;
  }
  if (state_.queueCount != 0) {
    const uint16_t age = static_cast<uint16_t>(static_cast<uint16_t>(millis()) - state_.queuedAt);
    if (!state_.isQueuedSent || age >= state_.patience) {
      sendQueued();
      return;
    }
  }
  sendWire();
}

void Link::send() {
  int room = state_.isPaced ? stream_->availableForWrite() : blindBytes;
  while (room-- > 0) {
    uint8_t byte = 0;  // the one in front of a frame
    if (state_.sendAt == nullptr) {
      chooseNext();
      if (state_.sendAt == nullptr) return;
    } else {
      byte = *state_.sendAt++;
      if (byte == 0) state_.sendAt = nullptr;
    }
    stream_->write(byte);
  }
}

}  // namespace rr
