// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "rr/reader.hpp"
#include "runtime/cpp/src/channel/outbox.hpp"
#include "runtime/cpp/src/channel/testing/socket_pair.hpp"

namespace rr::channel {
namespace {

using ::testing::ElementsAre;

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

// Messages with a name to know them by, and a filling that may be kept instead of copied.
class UrgentTest : public OutboxTest {
 protected:
  static void write(Writer& writer, std::string_view name, std::size_t filling = 0) {
    writer.reset(MessageVersion::v4);
    if (filling != 0) {
      Allocation memory = allocate(filling);
      std::memset(memory.bytes, 'x', filling);
      writer.prepend_array({memory.bytes, filling}, memory.owner);
      writer.element("f", ElementType::uint8, {}, static_cast<std::uint32_t>(filling), 0);
    }
    writer.entry({.type = EntryType::event_req, .member = name}, filling == 0 ? 0 : 1, 0);
    writer.message({}, 1);
  }
  void add_message(std::string_view name, std::size_t filling = 0) {
    Writer writer;
    write(writer, name, filling);
    outbox_.add(writer, 0);
  }
  void add_urgent(std::string_view name, std::size_t filling = 0) {
    Writer writer;
    write(writer, name, filling);
    outbox_.add_urgent(writer);
  }
  // As many small messages as streams leave behind, in one piece of memory.
  void add_streamed(int count) {
    std::vector<std::byte> bytes;
    for (int i = 0; i < count; ++i) {
      Writer writer;
      write(writer, "s" + std::to_string(i));
      const std::vector<std::byte> one = writer.copy();
      bytes.insert(bytes.end(), one.begin(), one.end());
    }
    Allocation memory = allocate(bytes.size());
    std::memcpy(memory.bytes, bytes.data(), bytes.size());
    outbox_.add(std::move(memory), bytes.size());
  }
  // Sends what the socket takes, which leaves some, and keeps it for names().
  void begin() {
    received_ += flush();
    ASSERT_FALSE(outbox_.empty());
  }
  // The names of the messages, all of which must be whole.
  std::vector<std::string> names() {
    while (!outbox_.empty()) received_ += flush();
    EXPECT_EQ(outbox_.size(), 0U);
    std::vector<std::string> result;
    std::span bytes(reinterpret_cast<const std::byte*>(received_.data()), received_.size());
    while (!bytes.empty()) {
      const std::size_t size = message_size(bytes, {});
      const auto message = std::make_unique<Message>();
      Entry entry;
      if (size == 0 || size > bytes.size() ||
          !read_message(bytes.first(size), {}, false, *message, entry)) {
        result.emplace_back("broken");
        break;
      }
      result.emplace_back(entry.member);
      bytes = bytes.subspan(size);
    }
    return result;
  }

  std::string received_;
};

TEST_F(UrgentTest, MessagesOvertakeWhatWaitsAndNotEachOther) {
  add_message("a");
  add_message("b", 100'000);
  add_urgent("1");
  add_urgent("2", 100'000);
  add_message("c");
  add_urgent("3");
  EXPECT_THAT(names(), ElementsAre("1", "2", "3", "a", "b", "c"));
}

TEST_F(UrgentTest, MessagesWaitForTheEndOfOneThatHasBegun) {
  add_message("a", 5'000'000);
  add_message("b");
  begin();
  add_urgent("1");
  add_urgent("2");
  EXPECT_THAT(names(), ElementsAre("a", "1", "2", "b"));
}

TEST_F(UrgentTest, MessagesWaitForTheRestOfOneThatWasSentWithoutWaiting) {
  Writer writer;
  write(writer, "a", 5'000'000);
  const std::ptrdiff_t sent = outbox_.send(sockets_.other(), writer.pieces());
  ASSERT_GT(sent, 0);
  outbox_.add(writer, static_cast<std::size_t>(sent));
  add_message("b");
  add_urgent("1");
  EXPECT_THAT(names(), ElementsAre("a", "1", "b"));
}

TEST_F(UrgentTest, MessagesPassBetweenThoseThatWereQueuedTogether) {
  constexpr int count = 20'000;  // more than a socket takes
  add_streamed(count);
  begin();
  add_urgent("1");
  add_urgent("2");
  const std::vector<std::string> order = names();
  ASSERT_EQ(order.size(), count + 2U);
  const auto first = std::find(order.begin(), order.end(), "1");
  ASSERT_LT(first - order.begin(), count);
  EXPECT_EQ(*(first + 1), "2");
  std::vector<std::string> others(order.begin(), first);
  others.insert(others.end(), first + 2, order.end());
  for (int i = 0; i < count; ++i)
    ASSERT_EQ(others[static_cast<std::size_t>(i)], "s" + std::to_string(i));
}

TEST_F(UrgentTest, MessagesStayBehindWhatKeepsItsPlace) {
  add_message("a");
  add_message("kept");
  outbox_.fix_order();
  add_message("b");
  add_urgent("1");
  add_message("c");
  add_urgent("2");
  EXPECT_THAT(names(), ElementsAre("a", "kept", "1", "2", "b", "c"));
}

TEST_F(UrgentTest, MessagesDoNotDisturbThoseThatAreReplaced) {
  const auto newest = [&](std::int64_t time, std::string_view name, std::size_t filling) {
    Writer writer;
    write(writer, name, filling);
    outbox_.add_newest(writer, 1, time);
  };
  add_message("a");
  newest(1, "value 1", 0);
  add_message("kept");
  outbox_.fix_order();
  newest(2, "value 2", 3000);
  add_urgent("1");
  newest(3, "value 3", 10);
  add_message("b");
  add_urgent("2");
  newest(4, "value 4", 5000);
  EXPECT_THAT(names(), ElementsAre("a", "value 4", "kept", "1", "2", "b"));
}

TEST_F(UrgentTest, MessagesOfManyRoundsStayWhole) {
  std::size_t ordinary = 0;
  for (int i = 0; i < 200; ++i) {
    add_message("o", static_cast<std::size_t>(i % 7) * 20'000);
    add_message("o");
    ordinary += 2;
    if (i % 3 == 0) add_urgent("u", i % 2 == 0 ? 50'000 : 0);
    if (i % 5 == 0) received_ += flush();
  }
  const std::vector<std::string> order = names();
  EXPECT_EQ(static_cast<std::size_t>(std::count(order.begin(), order.end(), "o")), ordinary);
  EXPECT_EQ(std::count(order.begin(), order.end(), "u"), 67);
}

TEST_F(OutboxTest, ForgetsWhatWaits) {
  add("one");
  add_newest(1, 1, "two");
  outbox_.clear();
  EXPECT_TRUE(outbox_.empty());
  EXPECT_EQ(outbox_.size(), 0U);
  add("three");
  EXPECT_EQ(flush(), "three");
}

}  // namespace
}  // namespace rr::channel
