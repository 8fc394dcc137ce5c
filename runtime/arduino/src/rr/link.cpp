// SPDX-License-Identifier: Apache-2.0
// What comes in: frames, sessions, requests.
#include "link.h"

#include "frame.h"

namespace rr {

using serial::Kind;

namespace {

// Places in a frame that has come.
constexpr uint8_t kindAt = 0;
constexpr uint8_t sequenceAt = 1;
constexpr uint8_t lengthAt = 2;
constexpr uint8_t bodyAt = 3;

/// At most as many bytes are taken by one poll(), so that the rest of loop() has its turn.
constexpr uint8_t bytesOfPoll = 64;

uint16_t wordAt(const uint8_t* bytes) {
  return static_cast<uint16_t>(bytes[0] | static_cast<uint16_t>(bytes[1]) << 8);
}
void putWord(uint8_t* bytes, uint16_t word) {
  bytes[0] = static_cast<uint8_t>(word & 0xFF);
  bytes[1] = static_cast<uint8_t>(word >> 8);
}

constexpr uint8_t helloLength = 7;
constexpr uint8_t textLength = 3;

}  // namespace

const char* refusalReason = nullptr;

Link::Link(const Served& served, const Memory& memory, void* service)
    : served_(served),
      memory_(memory),
      service_(service),
      stream_(nullptr),
      pending_(nullptr, 0),
      state_() {}

void Link::begin(Stream& stream) {
  stream_ = &stream;
  // What another stream has begun is over.
  memset(&state_, 0, sizeof state_);
  // Nothing waits to be sent yet, so a stream that says 0 does not say how much it takes at all.
  state_.isPaced = stream.availableForWrite() > 0;
  // The zero in front of the first frame. What is behind it waits until the stream takes it.
  stream.write(static_cast<uint8_t>(0));
  sendOut(Kind::Started, 0, 0);
}

void Link::poll() {
  for (uint8_t count = 0; count < bytesOfPoll && stream_->available() > 0; ++count) {
    receive(static_cast<uint8_t>(stream_->read()));
  }
  send();
}

void Link::receive(uint8_t byte) {
  if (byte == 0) {
    // A block that is cut off has lost bytes, or the zero is a damaged byte.
    if (state_.isStarted && state_.block == 0 && !state_.isBroken) handleFrame();
    state_.received = 0;
    state_.block = 0;
    state_.isBroken = false;
    state_.isStarted = false;
    return;
  }
  if (state_.block != 0) {
    --state_.block;
  } else {
    state_.block = static_cast<uint8_t>(byte - 1);
    byte = 0;
    if (!state_.isStarted) {
      state_.isStarted = true;
      return;
    }
  }
  if (state_.received == memory_.requestSize) {
    state_.isBroken = true;
  } else {
    memory_.request[state_.received++] = byte;
  }
}

void Link::handleFrame() {
  const uint8_t* const frame = memory_.request;
  if (state_.received < serial::frameOverhead) return;
  if (frame[lengthAt] != state_.received - serial::frameOverhead) return;
  if (crcOver(frame, state_.received) != 0) return;

  const Kind kind = static_cast<Kind>(frame[kindAt]);
  const uint8_t sequence = frame[sequenceAt];
  if (kind == Kind::Ack) {
    if (state_.isQueuedSent && sequence == state_.outSequence) removeQueued();
  } else if (kind == Kind::Hello) {
    if (frame[lengthAt] == helloLength) beginSession(frame + bodyAt);
  } else if (state_.session == 0) {
    state_.sequence = sequence;
    answer(Kind::NoSession, 0);
  } else if (sequence == state_.sequence) {
    // The answer has been lost, or is on its way.
    if (!state_.isAnswering) state_.hasReply = true;
  } else if (sequence == static_cast<uint8_t>(state_.sequence + 1)) {
    state_.sequence = sequence;
    handleRequest(kind);
  }
}

void Link::beginSession(const uint8_t* body) {
  if (body[0] != 'R' || body[1] != 'D') return;
  const uint16_t session = wordAt(body + 3);
  // A copy of the hello of this session that comes late must not begin it again.
  if (session == 0 || (session == state_.session && state_.sequence != 0)) return;
  if (body[2] == serial::protocolVersion) {
    state_.session = session;
    state_.patience = wordAt(body + 5);
    state_.queueCount = 0;
    state_.isQueuedSent = false;
    memset(memory_.flags, 0, memory_.slots);
  }
  state_.sequence = 0;
  uint8_t* const reply = memory_.reply + sentBodyAt;
  reply[0] = serial::protocolVersion;
  putWord(reply + 1, session);
  reply[3] = static_cast<uint8_t>(memory_.requestSize - serial::frameOverhead);
  reply[4] = static_cast<uint8_t>(memory_.replySize - serial::frameOverhead);
  reply[5] = served_.textCount;
  for (uint8_t index = 0; index < 8; ++index) {
    reply[6 + index] = pgm_read_byte(served_.hash + index);
  }
  answer(Kind::Reply, 14);
}

void Link::handleRequest(Kind kind) {
  const uint8_t* const body = memory_.request + bodyAt;
  const uint8_t length = memory_.request[lengthAt];
  Writer reply(memory_.reply + sentBodyAt,
               static_cast<uint8_t>(memory_.replySize - serial::frameOverhead));
  uint8_t member = 0;
  Status status = Status::Ok;
  if (kind == Kind::Text) {
    status = length == textLength ? writeText(body, reply) : Status::DataTypeMismatch;
  } else if (kind != Kind::Ping) {
    if (length >= 2) {
      member = body[1];
      reply.putByte(member);
      Request request = {kind, body[0], member, Reader(body + 2, static_cast<uint8_t>(length - 2))};
      refusalReason = nullptr;
      status = served_.handle(service_, request, reply);
      state_.reason = refusalReason;
    } else {
      status = Status::DataSerializationError;
    }
  }
  if (status == Status::Ok && !reply.isGood()) status = Status::DataSerializationError;
  if (status == Status::Ok) {
    answer(Kind::Reply, reply.count());
    return;
  }
  memory_.reply[sentBodyAt] = member;
  memory_.reply[sentBodyAt + 1] = static_cast<uint8_t>(status);
  memory_.reply[sentBodyAt + 2] = state_.reason == nullptr ? 0 : 1;
  answer(Kind::Error, 3);
}

Status Link::writeText(const uint8_t* body, Writer& reply) {
  const uint8_t number = body[0];
  uint16_t offset = wordAt(body + 1);
  FlashText text = {state_.reason, 0};
  if (number < served_.textCount) {
    text = served_.texts[number];
  } else if (number == serial::reasonText && text.bytes != nullptr) {
    text.count = static_cast<uint16_t>(strlen_P(text.bytes));
  } else {
    return Status::OutOfRange;
  }
  if (offset > text.count) return Status::OutOfRange;
  const uint16_t left = static_cast<uint16_t>(text.count - offset);
  uint8_t count = static_cast<uint8_t>(reply.room() - textLength);
  if (left < count) count = static_cast<uint8_t>(left);
  uint8_t* bytes = reply.skip(static_cast<uint8_t>(textLength + count));
  for (uint8_t index = 0; index < textLength; ++index) *bytes++ = body[index];
  for (; count != 0; --count) *bytes++ = pgm_read_byte(text.bytes + offset++);
  return Status::Ok;
}

void Link::sendWire() {
  for (uint8_t count = memory_.slots; count != 0; --count) {
    if (++state_.nextSlot >= memory_.slots) state_.nextSlot = 0;
    uint8_t& flags = memory_.flags[state_.nextSlot];
    if (flags != (openFlag | changedFlag)) continue;
    flags = openFlag;
    Writer body(memory_.out + sentBodyAt,
                static_cast<uint8_t>(memory_.outSize - serial::frameOverhead));
    if (!served_.writeWire(service_, state_.nextSlot, body) || !body.isGood()) continue;
    sendOut(Kind::WireValue, 0, body.count());
    return;
  }
}

}  // namespace rr
