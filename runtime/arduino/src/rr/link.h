// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Arduino.h>
#include <stdint.h>

#include "protocol.h"
#include "status.h"
#include "values.h"

namespace rr {

/// What a host asks of a member.
struct Request {
  serial::Kind kind;
  uint8_t object;  ///< number of the object, 0 for the root
  uint8_t member;  ///< place in the object's definition, from 0
  Reader values;
};

/// A text in flash.
struct FlashText {
  const char* bytes;  ///< in PROGMEM
  uint16_t count;
};

/// What a board serves; all of it constant. Made by the generator.
struct Served {
  const FlashText* texts;  ///< in RAM: first what is served, then the definitions
  uint8_t textCount;
  const uint8_t* hash;  ///< in PROGMEM: 8 bytes
  /// Calls a member of the sketch. `service` is what the link was made with.
  Status (*handle)(void* service, Request& request, Writer& reply);
  /// Writes the value of a wire. False where there is none to send.
  bool (*writeWire)(void* service, uint8_t slot, Writer& body);
};

/// Bytes that stuffing adds to a frame in the memory of a link.
constexpr uint8_t stuffing = 2;

/// The memory of a link. The generator makes it, large enough for all members of the definition.
struct Memory {
  uint8_t* request;  ///< a whole frame from the host
  uint8_t* reply;    ///< a whole frame to the host, and `stuffing`
  uint8_t* out;      ///< one that the host did not ask for, and `stuffing`
  uint8_t* queue;    ///< events, packets and callbacks that wait
  uint8_t* flags;    ///< of each wire and pipe
  // Without the stuffing.
  uint8_t requestSize;
  uint8_t replySize;
  uint8_t outSize;
  uint8_t slots;  ///< wires and pipes
  uint16_t queueSize;
};

/// Reads what the request has, which must be all of it.
inline bool readValues(Reader&) { return true; }
template <class First, class... Rest>
bool readValues(Reader& reader, First& first, Rest&... rest) {
  return read(reader, first) && readValues(reader, rest...);
}
template <class... Values>
bool readAll(Request& request, Values&... values) {
  return readValues(request.values, values...) && request.values.isComplete();
}

/// Answers with a value if all went well.
template <class Value>
Status answer(Writer& reply, Status status, const Value& value) {
  if (status == Status::Ok) write(reply, value);
  return status;
}

/// The board's end of the serial protocol (docs/reference/serial-protocol.md). Nothing here waits: what
/// cannot be sent now is sent by a later poll().
class Link {
 public:
  Link(const Served& served, const Memory& memory, void* service);

  /// Begins to serve. `stream` has been started, and lives as long as the link.
  void begin(Stream& stream);
  /// Takes what has come, calls members, and sends what is to be sent. Call it from loop(), often:
  /// the serial port keeps 63 bytes only.
  void poll();
  /// Whether a host has begun a session.
  bool isConnected() const { return state_.session != 0; }

  /// Whether the host wants a wire or pipe.
  bool isOpen(uint8_t slot) const {
    return state_.session != 0 && (memory_.flags[slot] & openFlag) != 0;
  }
  /// Opens or closes one, as the host asked.
  Status setOpen(uint8_t slot, bool isOpen) {
    // What is opened gets the value that is there.
    memory_.flags[slot] = isOpen ? openFlag | changedFlag : 0;
    return Status::Ok;
  }
  /// That a wire has a new value, which is asked for when it can be sent.
  void markChanged(uint8_t slot) { memory_.flags[slot] |= changedFlag; }

  /// Begins an event, packet or callback, which is sent again until the host has it. Values are to
  /// be written then, and after them finish() to be called. False when there is no session.
  bool start(serial::Kind kind, uint8_t object, uint8_t member);
  Writer& values() { return pending_; }
  /// False when the values do not fit into what is left of the queue: nothing is sent.
  bool finish();

 private:
  static constexpr uint8_t openFlag = 1;
  static constexpr uint8_t changedFlag = 2;

  void receive(uint8_t byte);
  void handleFrame();
  void beginSession(const uint8_t* body);
  void handleRequest(serial::Kind kind);
  Status writeText(const uint8_t* body, Writer& reply);
  void answer(serial::Kind kind, uint8_t length);
  void sendOut(serial::Kind kind, uint8_t sequence, uint8_t length);
  void send();
  void chooseNext();
  void sendQueued();
  void sendWire();
  void removeQueued();

  const Served& served_;
  const Memory& memory_;
  void* const service_;
  Stream* stream_;
  Writer pending_;

  /// All zero at first, which costs less than to name each.
  struct State {
    serial::Kind pendingKind;
    uint16_t session;    ///< 0: none
    uint8_t sequence;    ///< of the last request
    const char* reason;  ///< in flash: why it was refused; may be null
    // Receiving.
    uint8_t received;  ///< bytes of the frame
    uint8_t block;     ///< bytes to come before the next zero
    bool isBroken;     ///< the frame is too long
    bool isStarted;    ///< something has come since the last zero
    // Sending.
    bool isPaced;  ///< the stream says how much it takes
    bool hasReply;
    bool isAnswering;  ///< what is being sent is the reply
    bool isQueuedSent;
    uint8_t outSequence;
    const uint8_t* sendAt;  ///< null: nothing is being sent
    uint16_t queueCount;    ///< bytes
    uint16_t queuedAt;      ///< when the first of the queue was last sent, in milliseconds
    uint16_t patience;      ///< until it is sent again
    uint8_t nextSlot;
  };
  State state_;
};

}  // namespace rr
