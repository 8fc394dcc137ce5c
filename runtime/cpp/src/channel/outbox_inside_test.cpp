// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/cpp/src/channel/outbox.hpp"
#include "runtime/cpp/src/channel/testing/socket_pair.hpp"

namespace rr::channel {
namespace {

// Any bytes will do for a message.
void put(Writer& writer, std::string_view text) {
  writer.reset(MessageVersion::v4);
  writer.prepend_bytes(text.data(), text.size());
}

class OutboxTest : public ::testing::Test {
 protected:
  void add(std::string_view text) {
    Writer writer;
    put(writer, text);
    outbox_.add(writer, 0);
  }
  void add_newest(std::uint64_t stream, std::int64_t time, std::string_view text) {
    Writer writer;
    put(writer, text);
    outbox_.add_newest(writer, stream, time);
  }
  // Sends as much as the socket takes, and returns what has arrived.
  std::string flush() {
    EXPECT_GE(outbox_.send(sockets_.other(), {}), 0);
    const std::vector<std::byte> bytes = sockets_.receive(10'000'000, 0);
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
  }

  Outbox outbox_;
  testing::SocketPair sockets_;
};

TEST_F(OutboxTest, ALaterMessageOfAStreamTakesThePlaceOfOneThatWaits) {
  add("<a>");
  add_newest(1, 10, "<one 10>");
  add("<b>");
  add_newest(2, 5, "<two 5>");
  add_newest(1, 11, "<one 11, longer>");
  add("<c>");
  add_newest(1, 9, "<one 9>");
  add_newest(2, 6, "<2>");
  EXPECT_EQ(outbox_.size(), std::string_view("<a><one 11, longer><b><2><c>").size());
  EXPECT_EQ(flush(), "<a><one 11, longer><b><2><c>");
  EXPECT_TRUE(outbox_.empty());
  EXPECT_EQ(outbox_.size(), 0U);
  add_newest(1, 1, "<one 1>");  // nothing waits any more
  EXPECT_EQ(flush(), "<one 1>");
}

TEST_F(OutboxTest, AMessageThatHasBegunToLeaveIsNotReplaced) {
  const std::string large(5'000'000, 'x');  // more than a socket takes
  add_newest(1, 1, large);
  std::string received = flush();
  ASSERT_LT(received.size(), large.size());
  add_newest(1, 2, "<2>");
  add_newest(1, 3, "<3>");
  while (!outbox_.empty()) received += flush();
  EXPECT_EQ(received, large + "<3>");
}

TEST_F(OutboxTest, AQueueThatNeverGetsEmptyStaysInOrder) {
  const std::string block(100'000, '.');
  std::string expected;
  std::string received;
  for (int i = 0; i < 300; ++i) {
    add(block);
    expected += block;
    add_newest(static_cast<std::uint64_t>(i), 1, "<old>");
    add_newest(static_cast<std::uint64_t>(i), 2, "<" + std::to_string(i) + ">");
    expected += "<" + std::to_string(i) + ">";
    if (i > 5) received += flush();
  }
  while (!outbox_.empty()) received += flush();
  EXPECT_EQ(received, expected);
}

}  // namespace
}  // namespace rr::channel
