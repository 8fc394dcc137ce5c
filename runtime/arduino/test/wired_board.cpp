// SPDX-License-Identifier: Apache-2.0
#include "runtime/arduino/test/wired_board.hpp"

#include <new>

uint32_t millis() { return rr::testing::now; }

namespace rr::testing {

uint32_t now = 0;

namespace {

constexpr char first_text[] = "board example.b.Board";
constexpr char second_text[] =
    "service example.b\nobject Board\n# long enough for two pieces at the least, as it is\nend\n";
constexpr std::uint8_t hash[8] = {1, 2, 3, 4, 5, 6, 7, 8};

std::uint16_t crc_over(const std::vector<std::uint8_t>& bytes) {
  std::uint16_t crc = serial::crcStart;
  for (const std::uint8_t byte : bytes) crc = serial::crcOf(crc, byte);
  return crc;
}

/// Nothing for what is no good frame.
std::vector<Frame> unstuffed(const std::vector<std::uint8_t>& bytes) {
  std::vector<std::uint8_t> content;
  for (std::size_t at = 0; at < bytes.size();) {
    const std::size_t end = at + bytes[at];
    if (end > bytes.size()) return {};
    content.insert(content.end(), bytes.begin() + static_cast<std::ptrdiff_t>(at) + 1,
                   bytes.begin() + static_cast<std::ptrdiff_t>(end));
    at = end;
    if (at < bytes.size()) content.push_back(0);
  }
  if (content.size() < serial::frameOverhead || crc_over(content) != 0) return {};
  if (content[2] != content.size() - serial::frameOverhead) return {};
  return {Frame{static_cast<serial::Kind>(content[0]), content[1],
                std::vector<std::uint8_t>(content.begin() + 3, content.end() - 2)}};
}

}  // namespace

int Line::read() {
  const int byte = to_board.front();
  to_board.pop_front();
  return byte;
}

size_t Line::write(uint8_t byte) {
  from_board.push_back(byte);
  return 1;
}

std::vector<uint8_t> stuffed(const Frame& frame) {
  std::vector<uint8_t> content{static_cast<uint8_t>(frame.kind), frame.sequence,
                               static_cast<uint8_t>(frame.body.size())};
  content.insert(content.end(), frame.body.begin(), frame.body.end());
  const std::uint16_t crc = crc_over(content);
  content.push_back(static_cast<uint8_t>(crc >> 8));
  content.push_back(static_cast<uint8_t>(crc & 0xFF));
  std::vector<uint8_t> bytes{0};
  std::size_t code = bytes.size();
  bytes.push_back(1);
  for (const uint8_t byte : content) {
    if (byte == 0) {
      code = bytes.size();
      bytes.push_back(1);
    } else {
      bytes.push_back(byte);
      ++bytes[code];
    }
  }
  bytes.push_back(0);
  return bytes;
}

std::vector<Frame> frames_in(const std::vector<uint8_t>& bytes) {
  std::vector<Frame> frames;
  std::vector<uint8_t> piece;
  for (const uint8_t byte : bytes) {
    if (byte != 0) {
      piece.push_back(byte);
      continue;
    }
    for (const Frame& frame : unstuffed(piece)) frames.push_back(frame);
    piece.clear();
  }
  return frames;
}

std::vector<uint8_t> bytes_of(std::initializer_list<int> numbers) {
  std::vector<uint8_t> bytes;
  for (const int number : numbers) bytes.push_back(static_cast<uint8_t>(number));
  return bytes;
}

WiredBoard::WiredBoard()
    : texts_{{first_text, sizeof first_text - 1}, {second_text, sizeof second_text - 1}},
      served_{texts_, 2, hash, &WiredBoard::handle, &WiredBoard::write_wire},
      memory_{request_, reply_, out_, queue_, flags_, 64, 64, 37, 2, sizeof queue_},
      link(served_, memory_, this) {
  link.begin(line);
  (void)listen();
}

std::vector<Frame> WiredBoard::say(const std::vector<uint8_t>& bytes) {
  line.from_board.clear();
  line.to_board.insert(line.to_board.end(), bytes.begin(), bytes.end());
  do {
    link.poll();
  } while (!line.to_board.empty());
  for (int count = 0; count < 40; ++count) link.poll();
  return frames_in(line.from_board);
}

void WiredBoard::hello(uint16_t session) {
  (void)say({serial::Kind::Hello, 0,
             bytes_of({'R', 'D', serial::protocolVersion, session & 0xFF, session >> 8, 50, 0})});
}

void WiredBoard::reset() {
  link.~Link();
  new (&link) Link(served_, memory_, this);
  link.begin(line);
}

Status WiredBoard::handle(void* self, Request& request, Writer& reply) {
  WiredBoard& board = *static_cast<WiredBoard*>(self);
  if (request.object != 0) return Status::ObjectNotFound;
  ++board.calls;
  using serial::Kind;
  if (request.member == 0 && request.kind == Kind::Get) {
    write(reply, board.property);
    return Status::Ok;
  }
  if (request.member == 0 && request.kind == Kind::Set) {
    double value = 0;
    if (!read(request.values, value) || !request.values.isComplete()) {
      return Status::DataTypeMismatch;
    }
    board.property = value;
    return Status::Ok;
  }
  if (request.member == 1 && request.kind == Kind::Call) {
    uint8_t a = 0;
    uint8_t b = 0;
    if (!read(request.values, a) || !read(request.values, b) || !request.values.isComplete()) {
      return Status::DataTypeMismatch;
    }
    if (a + b > 255) {
      return refuse(Status::OutOfRange,
                    F("the sum is more than 255, which is the most that a uint8 holds"));
    }
    write(reply, static_cast<uint8_t>(a + b));
    return Status::Ok;
  }
  const bool opens = request.kind == Kind::Open;
  if ((opens || request.kind == Kind::Close) && (request.member == 3 || request.member == 4)) {
    return board.link.setOpen(static_cast<uint8_t>(request.member - 3), opens);
  }
  if (request.member == 4 && request.kind == Kind::Packet) {
    uint8_t packet = 0;
    if (!read(request.values, packet)) return Status::DataTypeMismatch;
    board.packets.push_back(packet);
    return Status::Ok;
  }
  return Status::MemberNotFound;
}

bool WiredBoard::write_wire(void* self, uint8_t slot, Writer& body) {
  const WiredBoard& board = *static_cast<WiredBoard*>(self);
  if (slot != 0 || !board.has_wire) return false;
  body.putByte(0);
  body.putByte(3);
  return write(body, board.wire);
}

}  // namespace rr::testing
