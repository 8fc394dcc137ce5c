// SPDX-License-Identifier: Apache-2.0
// What comes in: frames, sessions, requests.
#include "link.h"

namespace rr {

using serial::Kind;

namespace {

// Places in a frame.
constexpr uint8_t kindAt = 0;
constexpr uint8_t sequenceAt = 1;
constexpr uint8_t lengthAt = 2;
constexpr uint8_t bodyAt = 3;

/// At most as many bytes are taken by one poll(), so that the rest of loop() has its turn.
constexpr uint8_t bytesOfPoll = 64;

bool bitOf(const uint8_t* bits, uint8_t index) {
  return (bits[index >> 3] & (1 << (index & 7))) != 0;
}
void setBit(uint8_t* bits, uint8_t index, bool value) {
  const uint8_t mask = static_cast<uint8_t>(1 << (index & 7));
  uint8_t& place = bits[index >> 3];
  place = static_cast<uint8_t>(value ? place | mask : place & ~mask);
}

}  // namespace

Link::Link(const Served& served, const Memory& memory, void* service)
    : served_(served),
      memory_(memory),
      service_(service),
      stream_(nullptr),
      pending_(nullptr, 0),
      pendingKind_(Kind::Event),
      session_(0),
      sequence_(0),
      received_(0),
      block_(0),
      isBroken_(false),
      isStarted_(false),
      phase_(Phase::Idle),
      isPaced_(false),
      hasReply_(false),
      isAnswering_(false),
      isQueuedSent_(false),
      outSequence_(0),
      run_(0),
      sendLeft_(0),
      sendAt_(nullptr),
      queueCount_(0),
      queuedAt_(0),
      patience_(100),
      nextSlot_(0) {}

void Link::begin(Stream& stream) {
  stream_ = &stream;
  // Nothing waits to be sent yet, so a stream that says 0 does not say how much it takes at all.
  isPaced_ = stream.availableForWrite() > 0;
  finishFrame(memory_.out, Kind::Started, 0, 0);
  startSending(memory_.out);
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
    if (isStarted_ && block_ == 0 && !isBroken_) handleFrame();
    forgetReceived();
  } else if (block_ != 0) {
    append(byte);
    --block_;
  } else {
    if (isStarted_) append(0);
    isStarted_ = true;
    block_ = static_cast<uint8_t>(byte - 1);
  }
}

void Link::append(uint8_t byte) {
  if (received_ == memory_.requestSize) {
    isBroken_ = true;
  } else {
    memory_.request[received_++] = byte;
  }
}

void Link::forgetReceived() {
  received_ = 0;
  block_ = 0;
  isBroken_ = false;
  isStarted_ = false;
}

void Link::handleFrame() {
  const uint8_t* const frame = memory_.request;
  if (received_ < serial::frameOverhead) return;
  if (frame[lengthAt] != received_ - serial::frameOverhead) return;
  uint16_t crc = serial::crcStart;
  for (uint8_t index = 0; index < received_; ++index) crc = serial::crcOf(crc, frame[index]);
  if (crc != 0) return;

  const Kind kind = static_cast<Kind>(frame[kindAt]);
  const uint8_t sequence = frame[sequenceAt];
  if (kind == Kind::Ack) {
    if (isQueuedSent_ && sequence == outSequence_) removeQueued();
  } else if (kind == Kind::Hello) {
    beginSession(Reader(frame + bodyAt, frame[lengthAt]));
  } else if (session_ == 0) {
    sequence_ = sequence;
    answer(Kind::NoSession, 0);
  } else if (sequence == sequence_) {
    // The answer has been lost, or is on its way.
    if (!isAnswering_) hasReply_ = true;
  } else if (sequence == static_cast<uint8_t>(sequence_ + 1)) {
    sequence_ = sequence;
    handleRequest(kind);
  }
}

void Link::beginSession(Reader body) {
  uint8_t mark[2] = {0, 0};
  uint8_t version = 0;
  uint16_t session = 0;
  uint16_t patience = 0;
  if (!body.take(mark, 1) || !body.take(mark + 1, 1) || mark[0] != 'R' || mark[1] != 'D') return;
  if (!read(body, version) || !read(body, session) || !read(body, patience)) return;
  if (session == 0) return;
  // A copy of the hello of this session that comes late must not begin it again.
  if (session == session_ && sequence_ != 0) return;
  if (version == serial::protocolVersion) {
    session_ = session;
    patience_ = patience;
    queueCount_ = 0;
    isQueuedSent_ = false;
    for (uint8_t slot = 0; slot < memory_.slots; ++slot) setBit(memory_.open, slot, false);
  }
  sequence_ = 0;
  Writer reply(memory_.reply + bodyAt,
               static_cast<uint8_t>(memory_.replySize - serial::frameOverhead));
  write(reply, serial::protocolVersion);
  write(reply, session);
  reply.putByte(static_cast<uint8_t>(memory_.requestSize - serial::frameOverhead));
  reply.putByte(static_cast<uint8_t>(memory_.replySize - serial::frameOverhead));
  reply.putByte(served_.textCount);
  for (uint8_t index = 0; index < 8; ++index) reply.putByte(pgm_read_byte(served_.hash + index));
  answer(Kind::Reply, reply.count());
}

void Link::handleRequest(Kind kind) {
  Reader body(memory_.request + bodyAt, memory_.request[lengthAt]);
  Writer reply(memory_.reply + bodyAt,
               static_cast<uint8_t>(memory_.replySize - serial::frameOverhead));
  uint8_t object = 0;
  uint8_t member = 0;
  Status status = Status::Ok;
  if (kind == Kind::Text) {
    status = writeText(body, reply);
  } else if (kind != Kind::Ping) {
    if (read(body, object) && read(body, member)) {
      reply.putByte(member);
      Request request = {kind, object, member, body};
      status = served_.handle(service_, request, reply);
    } else {
      status = Status::DataSerializationError;
    }
  }
  if (status == Status::Ok && !reply.isGood()) status = Status::DataSerializationError;
  if (status == Status::Ok) {
    answer(Kind::Reply, reply.count());
    return;
  }
  reply.clear();
  reply.putByte(member);
  reply.putByte(static_cast<uint8_t>(status));
  answer(Kind::Error, reply.count());
}

Status Link::writeText(Reader body, Writer& reply) {
  uint8_t number = 0;
  uint16_t offset = 0;
  if (!read(body, number) || !read(body, offset)) return Status::DataSerializationError;
  if (number >= served_.textCount) return Status::OutOfRange;
  const FlashText& text = served_.texts[number];
  if (offset > text.count) return Status::OutOfRange;
  write(reply, number);
  write(reply, offset);
  uint16_t left = static_cast<uint16_t>(text.count - offset);
  if (left > reply.room()) left = reply.room();
  while (left-- != 0) reply.putByte(pgm_read_byte(text.bytes + offset++));
  return Status::Ok;
}

bool Link::isOpen(uint8_t slot) const { return session_ != 0 && bitOf(memory_.open, slot); }

Status Link::setOpen(uint8_t slot, bool isOpen) {
  setBit(memory_.open, slot, isOpen);
  setBit(memory_.changed, slot, isOpen);
  return Status::Ok;
}

void Link::markChanged(uint8_t slot) { setBit(memory_.changed, slot, true); }

void Link::sendWire() {
  for (uint8_t count = 0; count < memory_.slots; ++count) {
    const uint8_t slot = nextSlot_;
    nextSlot_ = static_cast<uint8_t>(slot + 1 == memory_.slots ? 0 : slot + 1);
    if (!isOpen(slot) || !bitOf(memory_.changed, slot)) continue;
    setBit(memory_.changed, slot, false);
    Writer body(memory_.out + bodyAt,
                static_cast<uint8_t>(memory_.outSize - serial::frameOverhead));
    if (!served_.writeWire(service_, slot, body) || !body.isGood()) continue;
    finishFrame(memory_.out, Kind::WireValue, 0, body.count());
    startSending(memory_.out);
    return;
  }
}

}  // namespace rr
