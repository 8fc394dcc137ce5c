// SPDX-License-Identifier: Apache-2.0
// What goes out: replies, what waits in the queue, values of wires; stuffed while it is sent.
#include "link.h"

namespace rr {

using serial::Kind;

namespace {

/// Bytes of an entry of the queue before its body: length and kind.
constexpr uint8_t entryOverhead = 2;
/// How many bytes one poll() gives to a stream that does not say how many it takes.
constexpr uint8_t blindBytes = 8;

}  // namespace

void Link::finishFrame(uint8_t* frame, Kind kind, uint8_t sequence, uint8_t length) {
  frame[0] = static_cast<uint8_t>(kind);
  frame[1] = sequence;
  frame[2] = length;
  uint16_t crc = serial::crcStart;
  const uint8_t end = static_cast<uint8_t>(length + 3);
  for (uint8_t index = 0; index < end; ++index) crc = serial::crcOf(crc, frame[index]);
  frame[end] = static_cast<uint8_t>(crc >> 8);
  frame[end + 1] = static_cast<uint8_t>(crc & 0xFF);
}

void Link::answer(Kind kind, uint8_t length) {
  finishFrame(memory_.reply, kind, state_.sequence, length);
  // An older answer that is on its way is cut off by the zero in front of this one.
  if (state_.isAnswering) state_.phase = Phase::Idle;
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
  memcpy(memory_.out + 3, memory_.queue + entryOverhead, length);
  if (!state_.isQueuedSent) ++state_.outSequence;
  state_.isQueuedSent = true;
  state_.queuedAt = static_cast<uint16_t>(millis());
  finishFrame(memory_.out, static_cast<Kind>(memory_.queue[1]), state_.outSequence, length);
  startSending(memory_.out);
}

void Link::chooseNext() {
  state_.isAnswering = false;
  if (state_.hasReply) {
    state_.hasReply = false;
    state_.isAnswering = true;
    startSending(memory_.reply);
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

void Link::startSending(const uint8_t* frame) {
  state_.sendAt = frame;
  state_.sendLeft = static_cast<uint8_t>(frame[2] + serial::frameOverhead);
  state_.phase = Phase::Lead;
}

void Link::send() {
  int room = state_.isPaced ? stream_->availableForWrite() : blindBytes;
  while (room-- > 0) {
    if (state_.phase == Phase::Idle) chooseNext();
    if (state_.phase == Phase::Idle) return;
    stream_->write(nextByte());
  }
}

uint8_t Link::nextByte() {
  switch (state_.phase) {
    case Phase::Code:
      state_.run = 0;
      while (state_.run < state_.sendLeft && state_.sendAt[state_.run] != 0) ++state_.run;
      state_.phase = Phase::Data;
      {
        const uint8_t code = static_cast<uint8_t>(state_.run + 1);
        if (state_.run == 0) afterBlock();
        return code;
      }
    case Phase::Data: {
      const uint8_t byte = *state_.sendAt++;
      --state_.sendLeft;
      if (--state_.run == 0) afterBlock();
      return byte;
    }
    case Phase::Trail:
      state_.phase = Phase::Idle;
      return 0;
    default:
      state_.phase = Phase::Code;
      return 0;
  }
}

void Link::afterBlock() {
  if (state_.sendLeft == 0) {
    state_.phase = Phase::Trail;
    return;
  }
  // The zero itself is not sent.
  ++state_.sendAt;
  --state_.sendLeft;
  state_.phase = Phase::Code;
}

}  // namespace rr
