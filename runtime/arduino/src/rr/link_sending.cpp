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
  finishFrame(memory_.reply, kind, sequence_, length);
  // An older answer that is on its way is cut off by the zero in front of this one.
  if (isAnswering_) phase_ = Phase::Idle;
  isAnswering_ = false;
  hasReply_ = true;
}

bool Link::start(Kind kind, uint8_t object, uint8_t member) {
  if (session_ == 0 || queueCount_ + entryOverhead > memory_.queueSize) return false;
  const uint16_t room = static_cast<uint16_t>(memory_.queueSize - queueCount_ - entryOverhead);
  const uint8_t limit = static_cast<uint8_t>(memory_.outSize - serial::frameOverhead);
  pending_ = Writer(memory_.queue + queueCount_ + entryOverhead,
                    room < limit ? static_cast<uint8_t>(room) : limit);
  pendingKind_ = kind;
  pending_.putByte(object);
  pending_.putByte(member);
  // Whose call it belongs to: the host knows by its number.
  if (kind == Kind::Ask) pending_.putByte(sequence_);
  return true;
}

bool Link::finish() {
  if (!pending_.isGood()) return false;
  memory_.queue[queueCount_] = pending_.count();
  memory_.queue[queueCount_ + 1] = static_cast<uint8_t>(pendingKind_);
  queueCount_ = static_cast<uint16_t>(queueCount_ + entryOverhead + pending_.count());
  return true;
}

void Link::removeQueued() {
  const uint16_t size = static_cast<uint16_t>(memory_.queue[0] + entryOverhead);
  queueCount_ = static_cast<uint16_t>(queueCount_ - size);
  memmove(memory_.queue, memory_.queue + size, queueCount_);
  isQueuedSent_ = false;
}

void Link::sendQueued() {
  const uint8_t length = memory_.queue[0];
  memcpy(memory_.out + 3, memory_.queue + entryOverhead, length);
  if (!isQueuedSent_) ++outSequence_;
  isQueuedSent_ = true;
  queuedAt_ = static_cast<uint16_t>(millis());
  finishFrame(memory_.out, static_cast<Kind>(memory_.queue[1]), outSequence_, length);
  startSending(memory_.out);
}

void Link::chooseNext() {
  isAnswering_ = false;
  if (hasReply_) {
    hasReply_ = false;
    isAnswering_ = true;
    startSending(memory_.reply);
    return;
  }
  if (queueCount_ != 0) {
    const uint16_t age = static_cast<uint16_t>(static_cast<uint16_t>(millis()) - queuedAt_);
    if (!isQueuedSent_ || age >= patience_) {
      sendQueued();
      return;
    }
  }
  sendWire();
}

void Link::startSending(const uint8_t* frame) {
  sendAt_ = frame;
  sendLeft_ = static_cast<uint8_t>(frame[2] + serial::frameOverhead);
  phase_ = Phase::Lead;
}

void Link::send() {
  int room = isPaced_ ? stream_->availableForWrite() : blindBytes;
  while (room-- > 0) {
    if (phase_ == Phase::Idle) chooseNext();
    if (phase_ == Phase::Idle) return;
    stream_->write(nextByte());
  }
}

uint8_t Link::nextByte() {
  switch (phase_) {
    case Phase::Code:
      run_ = 0;
      while (run_ < sendLeft_ && sendAt_[run_] != 0) ++run_;
      phase_ = Phase::Data;
      {
        const uint8_t code = static_cast<uint8_t>(run_ + 1);
        if (run_ == 0) afterBlock();
        return code;
      }
    case Phase::Data: {
      const uint8_t byte = *sendAt_++;
      --sendLeft_;
      if (--run_ == 0) afterBlock();
      return byte;
    }
    case Phase::Trail:
      phase_ = Phase::Idle;
      return 0;
    default:
      phase_ = Phase::Code;
      return 0;
  }
}

void Link::afterBlock() {
  if (sendLeft_ == 0) {
    phase_ = Phase::Trail;
    return;
  }
  // The zero itself is not sent.
  ++sendAt_;
  --sendLeft_;
  phase_ = Phase::Code;
}

}  // namespace rr
