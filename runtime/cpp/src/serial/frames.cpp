// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/serial/frames.hpp"

#include <optional>

namespace rr::serial {
namespace {

constexpr std::size_t longest_content = bodyLimit + frameOverhead;

std::uint16_t crc_over(std::span<const std::uint8_t> bytes) {
  std::uint16_t crc = crcStart;
  for (const std::uint8_t byte : bytes) crc = crcOf(crc, byte);
  return crc;
}

/// Nothing where blocks and bytes do not fit together.
std::optional<std::vector<std::uint8_t>> unstuff(std::span<const std::uint8_t> piece) {
  std::vector<std::uint8_t> content;
  while (!piece.empty()) {
    const std::size_t block = piece.front();
    if (block > piece.size()) return std::nullopt;
    content.insert(content.end(), piece.begin() + 1,
                   piece.begin() + static_cast<std::ptrdiff_t>(block));
    piece = piece.subspan(block);
    if (!piece.empty()) content.push_back(0);
  }
  return content;
}

std::optional<Frame> read_frame(std::span<const std::uint8_t> piece) {
  const auto content = unstuff(piece);
  if (!content || content->size() < frameOverhead || content->size() > longest_content) {
    return std::nullopt;
  }
  if ((*content)[2] != content->size() - frameOverhead || crc_over(*content) != 0) {
    return std::nullopt;
  }
  return Frame{
      static_cast<Kind>((*content)[0]), (*content)[1], {content->begin() + 3, content->end() - 2}};
}

}  // namespace

std::vector<std::uint8_t> stuff(const Frame& frame) {
  std::vector<std::uint8_t> content{static_cast<std::uint8_t>(frame.kind), frame.sequence,
                                    static_cast<std::uint8_t>(frame.body.size())};
  content.insert(content.end(), frame.body.begin(), frame.body.end());
  const std::uint16_t crc = crc_over(content);
  content.push_back(static_cast<std::uint8_t>(crc >> 8));
  content.push_back(static_cast<std::uint8_t>(crc & 0xFF));
  std::vector<std::uint8_t> bytes{0, 1};
  std::size_t code = 1;
  for (const std::uint8_t byte : content) {
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

void FrameFinder::take(std::span<const std::uint8_t> bytes,
                       const std::function<void(const Frame&)>& use) {
  for (const std::uint8_t byte : bytes) {
    if (byte != 0) {
      // One more than the longest is enough to know that it is none.
      if (piece_.size() <= longest_content + 1) piece_.push_back(byte);
      continue;
    }
    if (piece_.empty()) continue;
    const std::optional<Frame> frame = read_frame(piece_);
    piece_.clear();
    if (frame) {
      use(*frame);
    } else {
      ++dropped_;
    }
  }
}

}  // namespace rr::serial
