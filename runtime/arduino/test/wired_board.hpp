// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Robdef.h>

#include <cstdint>
#include <deque>
#include <string>
#include <vector>

/// For tests: a board of which everything is seen, and the host's end of its line.
namespace rr::testing {

/// Both directions of a line, as the board's sketch sees it.
class Line : public Stream {
 public:
  int available() override { return static_cast<int>(to_board.size()); }
  int read() override;
  size_t write(uint8_t byte) override;
  int availableForWrite() override { return room; }

  std::deque<uint8_t> to_board;
  std::vector<uint8_t> from_board;
  int room = 64;  ///< what the board's port says it takes; 0: it does not say
};

/// A frame without its stuffing.
struct Frame {
  serial::Kind kind{};
  uint8_t sequence = 0;
  std::vector<uint8_t> body{};

  bool operator==(const Frame&) const = default;
};

/// As it goes over the line, the zeros around it too.
std::vector<uint8_t> stuffed(const Frame& frame);
/// The good frames in what was sent.
std::vector<Frame> frames_in(const std::vector<uint8_t>& bytes);
/// Bytes, of numbers and texts.
std::vector<uint8_t> bytes_of(std::initializer_list<int> numbers);

/// Has, all in the root: 0 property double, 1 function of two uint8 that gives their sum, 2 event,
/// 3 wire uint16 (slot 0), 4 pipe uint8 (slot 1), 5 callback.
class WiredBoard {
 public:
  WiredBoard();
  /// What the board says to these bytes. Time passes as tests say.
  std::vector<Frame> say(const std::vector<uint8_t>& bytes);
  std::vector<Frame> say(const Frame& frame) { return say(stuffed(frame)); }
  std::vector<Frame> listen() { return say(std::vector<uint8_t>{}); }
  void hello(uint16_t session = 7);
  /// As a reset does.
  void reset();

  Line line;
  double property = 0;
  uint16_t wire = 0;
  bool has_wire = true;
  int calls = 0;
  std::vector<int> packets{};

 private:
  static Status handle(void* self, Request& request, Writer& reply);
  static bool write_wire(void* self, uint8_t slot, Writer& body);

  std::uint8_t request_[64]{};
  std::uint8_t reply_[64 + stuffing]{};
  std::uint8_t out_[37 + stuffing]{};
  std::uint8_t queue_[40]{};
  std::uint8_t flags_[2]{};
  FlashText texts_[2];
  Served served_;
  Memory memory_;

 public:
  Link link;
};

/// What millis() gives.
extern uint32_t now;

}  // namespace rr::testing
