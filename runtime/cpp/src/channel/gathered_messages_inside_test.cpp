// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cstddef>
#include <string>
#include <string_view>

#include "runtime/cpp/src/channel/gathered_messages.hpp"

namespace rr::channel {
namespace {

// Any bytes will do for a message.
void put_text(Writer& writer, std::string_view text) {
  writer.reset(MessageVersion::v4);
  writer.prepend_bytes(text.data(), text.size());
}
std::string bytes_of(Writer& writer) {
  std::string bytes;
  for (const Piece& piece : writer.pieces()) {
    bytes.append(reinterpret_cast<const char*>(piece.data), piece.size);
  }
  return bytes;
}

TEST(GatheredMessages, LeaveAsOnePiece) {
  GatheredMessages gathered;
  Writer writer;
  EXPECT_TRUE(gathered.empty());
  put_text(writer, "one");
  const std::string one = bytes_of(writer);
  gathered.add(writer);
  put_text(writer, "two");
  const std::string both = one + bytes_of(writer);
  gathered.add(writer);
  gathered.note_packet();
  EXPECT_FALSE(gathered.empty());
  EXPECT_EQ(gathered.bytes(), both.size());
  const GatheredMessages::Taken taken = gathered.take();
  ASSERT_EQ(taken.size, both.size());
  EXPECT_EQ(std::string(reinterpret_cast<const char*>(taken.memory.bytes), taken.size), both);
  EXPECT_TRUE(gathered.empty());
  EXPECT_EQ(gathered.bytes(), 0U);
  EXPECT_EQ(gathered.take().size, 0U);
}

TEST(GatheredMessages, CountWhatWasGatheredEver) {
  GatheredMessages gathered;
  Writer writer;
  put_text(writer, "one");
  const std::size_t size = writer.size();
  for (int i = 0; i < 3; ++i) {
    gathered.add(writer);
    if (i != 0) gathered.note_packet();
    gathered.take();
  }
  EXPECT_EQ(gathered.message_count(), 3U);
  EXPECT_EQ(gathered.byte_count(), 3 * size);
  EXPECT_EQ(gathered.packet_count(), 2U);
}

TEST(GatheredMessages, HaveRoomForOnePieceOfMemory) {
  GatheredMessages gathered;
  EXPECT_TRUE(gathered.has_room_for(GatheredMessages::capacity));
  EXPECT_FALSE(gathered.has_room_for(GatheredMessages::capacity + 1));
  Writer writer;
  put_text(writer, std::string(10'000, 'x'));
  std::size_t count = 0;
  for (; gathered.has_room_for(writer.size()); ++count) gathered.add(writer);
  EXPECT_EQ(count, 6U);
  EXPECT_TRUE(gathered.has_room_for(GatheredMessages::capacity - gathered.bytes()));
  EXPECT_FALSE(gathered.has_room_for(GatheredMessages::capacity - gathered.bytes() + 1));
}

}  // namespace
}  // namespace rr::channel
