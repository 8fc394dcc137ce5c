// SPDX-License-Identifier: Apache-2.0
// The rings of a connection in shared memory, whose other side may write anything to them: nothing
// is read or written beyond them, and what was not tampered with arrives as it was sent.
#include <algorithm>
#include <array>
#include <cstring>
#include <deque>
#include <span>

#include "runtime/cpp/fuzz/promise.hpp"
#include "runtime/cpp/src/channel/shared_ring.hpp"
#include "runtime/cpp/src/channel/shared_rings.hpp"

using rr::fuzz::promise;
using rr::fuzz::take_byte;

namespace {

using rr::channel::RingReader;
using rr::channel::RingWriter;
using rr::channel::SharedRing;
using rr::channel::SharedRings;

std::uint64_t take_number(std::span<const std::byte>& input) {
  std::uint64_t number = 0;
  const std::size_t size = std::min<std::size_t>(take_byte(input) % 9, input.size());
  std::memcpy(&number, input.data(), size);
  input = input.subspan(size);
  return number;
}

// One direction, with both of its ends.
class Direction {
 public:
  explicit Direction(const SharedRing& ring) : ring_(ring), writer_(ring), reader_(ring) {}

  void write(std::size_t size) {
    std::array<std::byte, 3000> bytes;
    for (std::byte& byte : bytes) byte = static_cast<std::byte>(++number_);
    number_ -= bytes.size();
    const std::array<rr::platform::Buffer, 2> pieces{
        rr::platform::Buffer{bytes.data(), std::min(size, bytes.size()) / 2},
        rr::platform::Buffer{bytes.data() + std::min(size, bytes.size()) / 2,
                             std::min(size, bytes.size()) - std::min(size, bytes.size()) / 2}};
    const std::ptrdiff_t written = writer_.write(pieces, 0, [](std::uint32_t) {});
    promise(written == rr::platform::broken ||
                static_cast<std::size_t>(written) <= std::min(size, bytes.size()),
            "no more is written than there is");
    promise(is_tampered_ || written >= 0, "a right index is believed");
    if (written > 0) {
      for (std::ptrdiff_t i = 0; i < written; ++i)
        expected_.push_back(bytes[static_cast<std::size_t>(i)]);
      number_ += static_cast<std::size_t>(written);
    }
    promise(is_tampered_ || expected_.size() <= ring_.size, "a ring holds no more than its size");
  }
  void read(std::size_t size) {
    std::array<std::byte, 5000> room;
    std::uint32_t wake = 0;
    const std::size_t most = std::clamp<std::size_t>(size, 1, room.size());
    const std::ptrdiff_t got = reader_.read(std::span(room).first(most), wake);
    promise(got == rr::platform::broken || got == rr::platform::nothing_now ||
                (got > 0 && static_cast<std::size_t>(got) <= most),
            "no more is read than there is room for");
    if (is_tampered_) return;
    promise(got > 0 ? static_cast<std::size_t>(got) <= expected_.size() : expected_.empty(),
            "what was written can be read");
    for (std::ptrdiff_t i = 0; i < got; ++i) {
      promise(room[static_cast<std::size_t>(i)] == expected_.front(),
              "bytes arrive in their order");
      expected_.pop_front();
    }
  }
  void tamper(std::span<const std::byte>& input) {
    is_tampered_ = true;
    auto& words = *ring_.words;
    switch (take_byte(input) % 5) {
      case 0:
        words.written = take_number(input);
        break;
      case 1:
        words.taken = take_number(input);
        break;
      case 2:
        words.reader = static_cast<std::uint32_t>(take_number(input));
        break;
      case 3:
        words.room = static_cast<std::uint32_t>(take_number(input));
        break;
      default:
        ring_.bytes[take_number(input) % ring_.size] ^= std::byte{1};
    }
  }
  void wait(std::uint8_t how) {
    if (how % 2 == 0) static_cast<void>(reader_.watch());
    if (how % 2 == 1) static_cast<void>(writer_.want_room());
    if (how % 3 == 0) reader_.run();
    if (how % 5 == 0) writer_.interrupt_reader();
  }

 private:
  const SharedRing ring_;
  RingWriter writer_;
  RingReader reader_;
  std::deque<std::byte> expected_;
  std::size_t number_ = 0;
  bool is_tampered_ = false;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::error_code error;
  rr::platform::Descriptor handle;
  std::span<const std::byte> input = rr::fuzz::input_of(data, size);
  const auto made = SharedRings::make(std::size_t{4096} << (take_byte(input) % 3), handle, error);
  promise(static_cast<bool>(made), "there is a memory");
  const auto opened = SharedRings::open(handle, error);
  promise(static_cast<bool>(opened) && opened.size() == made.size(), "the other side has it, too");
  Direction to_client(made.to_client());
  Direction to_server(opened.to_server());
  while (!input.empty()) {
    const std::uint8_t what = take_byte(input);
    Direction& direction = (what & 1) != 0 ? to_client : to_server;
    switch (what >> 1 & 7) {
      case 0:
      case 1:
      case 2:
        direction.write(take_number(input) % 4096);
        break;
      case 3:
      case 4:
      case 5:
        direction.read(take_number(input) % 8192);
        break;
      case 6:
        direction.wait(take_byte(input));
        break;
      default:
        direction.tamper(input);
    }
  }
  return 0;
}
