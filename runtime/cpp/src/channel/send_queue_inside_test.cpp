// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <memory>
#include <string>
#include <string_view>
#include <thread>

#include "rr/options.hpp"
#include "runtime/cpp/src/channel/carrier.hpp"
#include "runtime/cpp/src/channel/connection_tap.hpp"
#include "runtime/cpp/src/channel/send_queue.hpp"
#include "runtime/cpp/src/platform/shared_memory.hpp"
#include "runtime/cpp/src/platform/sockets.hpp"

namespace rr::channel {
namespace {

// A socket that takes as much as the test lets it.
class FakeSocket final : public Carrier {
 public:
  std::size_t room = 1'000'000;
  bool is_broken = false;
  int calls = 0;
  std::string taken;

  [[nodiscard]] bool carries_messages() const override { return false; }
  std::ptrdiff_t receive(std::span<std::byte> /*room*/, bool /*may_block*/) override { return 0; }
  std::ptrdiff_t receive(Frame& /*message*/, bool /*may_block*/) override { return 0; }
  [[nodiscard]] bool has_received() const override { return false; }
  std::ptrdiff_t send(std::span<const platform::Buffer> pieces) override {
    ++calls;
    if (is_broken) return platform::broken;
    std::ptrdiff_t sent = 0;
    for (const platform::Buffer& piece : pieces) {
      const std::size_t size = std::min(room, piece.size);
      taken.append(reinterpret_cast<const char*>(piece.data), size);
      room -= size;
      sent += static_cast<std::ptrdiff_t>(size);
    }
    return sent;
  }
  [[nodiscard]] std::size_t unsent() const override { return 0; }
  bool flush() override { return !is_broken; }
  void wait_for_room(Time /*deadline*/) override {}
  void set_on_room(std::function<void()> /*on_room*/) override {}
  void end() override {}
};

class SendQueueTest : public ::testing::Test {
 protected:
  using Corked = SendQueue::Corked;
  using Sent = SendQueue::Sent;

  SendQueueTest() { queue_.set_carrier(&socket_); }

  // Any bytes will do for a message.
  static void put(Writer& writer, std::string_view text) {
    writer.reset(MessageVersion::v4);
    writer.prepend_bytes(text.data(), text.size());
  }
  Sent send(std::string_view text, Priority priority = Priority::usual) {
    Writer writer;
    put(writer, text);
    return queue_.send(writer, {.now = Time{}, .priority = priority});
  }
  Sent answer(std::string_view text) {
    Writer writer;
    put(writer, text);
    return queue_.send(writer, {.now = Time{}, .is_answer = true});
  }
  bool hold_back(std::string_view text, Priority priority = Priority::usual) {
    Writer writer;
    put(writer, text);
    return queue_.hold_back(writer, priority);
  }
  Corked cork(std::string_view text, unsigned expected) {
    Writer writer;
    put(writer, text);
    return queue_.cork(writer, expected);
  }
  std::string taken() { return std::exchange(socket_.taken, {}); }

  NodeOptions options_;
  ConnectionTap tap_{options_, false};
  FakeSocket socket_;
  SendQueue queue_{{.limit = 1000, .answer_limit = 100, .is_server = true}, tap_};
};

TEST_F(SendQueueTest, SendsAtOnceWhatTheSocketTakes) {
  EXPECT_EQ(send("one"), Sent::taken);
  EXPECT_EQ(taken(), "one");
  EXPECT_TRUE(queue_.is_empty());
  EXPECT_FALSE(queue_.has_unsent());
  EXPECT_EQ(queue_.waiting_bytes(), 0U);
}

// A socket that takes handles is local; the last message that goes there comes before the rest.
TEST_F(SendQueueTest, ChangesOverBehindALastMessage) {
  platform::Descriptor own;
  platform::Descriptor other;
  ASSERT_FALSE(platform::make_pair(own, other));
  SendQueue queue({.socket = own.get(), .limit = 1000}, tap_);
  Writer writer;
  put(writer, "last");
  if (!platform::has_shared_memory()) {
    EXPECT_FALSE(queue.change_over(writer, other, socket_));
    return;
  }
  EXPECT_TRUE(queue.change_over(writer, other, socket_));
  EXPECT_EQ(queue.carrier(), &socket_);
  put(writer, "more");
  EXPECT_EQ(queue.send(writer, {.now = Time{}}), Sent::taken);
  EXPECT_EQ(taken(), "more");
  EXPECT_EQ(queue.traffic().messages_sent, 2U);
  std::array<std::byte, 100> room;
  platform::Descriptor handle;
  EXPECT_EQ(platform::receive_with_handle(other.get(), room, handle), 4);
  EXPECT_TRUE(handle);

  // Not while something waits.
  socket_.room = 1;
  put(writer, "waits");
  EXPECT_EQ(queue.send(writer, {.now = Time{}}), Sent::first);
  put(writer, "last");
  EXPECT_FALSE(queue.change_over(writer, other, socket_));
}

TEST_F(SendQueueTest, TheFirstThatWaitsSaysSo) {
  socket_.room = 2;
  EXPECT_EQ(send("one"), Sent::first);
  EXPECT_EQ(send("two"), Sent::taken);
  EXPECT_EQ(queue_.waiting_bytes(), 4U);
  EXPECT_TRUE(queue_.has_unsent());
  EXPECT_EQ(taken(), "on");

  socket_.room = 1;
  EXPECT_TRUE(queue_.flush().has_rest);
  socket_.room = 100;
  const SendQueue::Flushed flushed = queue_.flush();
  EXPECT_FALSE(flushed.has_rest);
  EXPECT_FALSE(flushed.is_broken);
  EXPECT_EQ(taken(), "etwo");
  EXPECT_FALSE(queue_.has_unsent());
  EXPECT_EQ(send("three"), Sent::taken);
}

TEST_F(SendQueueTest, AnUrgentMessageOvertakesWhatHasNotBegun) {
  socket_.room = 1;
  send("begun");
  send("usual");
  send("urgent", Priority::urgent);
  socket_.room = 100;
  queue_.flush();
  EXPECT_EQ(taken(), "begunurgentusual");
}

TEST_F(SendQueueTest, NothingOvertakesAFixedMessage) {
  socket_.room = 1;
  send("begun");
  send("fixed", Priority::fixed);
  send("urgent", Priority::urgent);
  socket_.room = 100;
  queue_.flush();
  EXPECT_EQ(taken(), "begunfixedurgent");
}

TEST_F(SendQueueTest, OfAStreamTheNewestWaits) {
  socket_.room = 1;
  send("begun");
  const auto send_newest = [&](std::string_view text, std::int64_t time) {
    Writer writer;
    put(writer, text);
    const Newest newest{.stream = 1, .time = time};
    queue_.send(writer, {.now = Time{}, .newest = &newest});
  };
  send_newest("old", 1);
  send_newest("new", 3);
  send_newest("late", 2);
  socket_.room = 100;
  queue_.flush();
  EXPECT_EQ(taken(), "begunnew");
}

TEST_F(SendQueueTest, FarTooMuchBreaksTheConnection) {
  socket_.room = 0;
  EXPECT_EQ(send(std::string(900, 'x')), Sent::first);
  EXPECT_EQ(send(std::string(200, 'x')), Sent::broken);
}

TEST_F(SendQueueTest, ABrokenSocketBreaksTheConnection) {
  socket_.is_broken = true;
  EXPECT_EQ(send("one"), Sent::broken);
  socket_.is_broken = false;
  socket_.room = 0;
  send("two");
  socket_.is_broken = true;
  EXPECT_TRUE(queue_.flush().is_broken);
}

TEST_F(SendQueueTest, NothingIsSentAfterTheEnd) {
  socket_.room = 0;
  send("one");
  queue_.close();
  socket_.room = 100;
  EXPECT_EQ(send("two"), Sent::broken);
  EXPECT_FALSE(queue_.flush().has_rest);
  EXPECT_EQ(cork("three", 1), Corked::no);
  queue_.clear();
  EXPECT_TRUE(queue_.is_empty());
  EXPECT_EQ(taken(), "");
}

TEST_F(SendQueueTest, AnswersThatAreHeldBackLeaveTogether) {
  EXPECT_TRUE(hold_back("a"));
  EXPECT_TRUE(hold_back("b"));
  EXPECT_TRUE(hold_back("urgent", Priority::urgent));
  EXPECT_EQ(socket_.calls, 0);
  EXPECT_EQ(send("c"), Sent::taken);
  EXPECT_EQ(socket_.calls, 1);
  EXPECT_EQ(taken(), "urgentabc");
}

TEST_F(SendQueueTest, RequestsWaitWhileAnswersAreNotTaken) {
  socket_.room = 10;
  answer(std::string(90, 'a'));
  EXPECT_FALSE(queue_.check_answers());
  answer(std::string(90, 'b'));
  EXPECT_TRUE(queue_.check_answers());
  EXPECT_TRUE(queue_.do_answers_wait());

  socket_.room = 60;
  SendQueue::Flushed flushed = queue_.flush();
  EXPECT_TRUE(flushed.took_answers);
  EXPECT_FALSE(flushed.may_read_on);  // more than half of the limit waits
  socket_.room = 70;
  flushed = queue_.flush();
  EXPECT_TRUE(flushed.may_read_on);
  EXPECT_FALSE(queue_.do_answers_wait());
}

TEST_F(SendQueueTest, OtherMessagesDoNotMakeRequestsWait) {
  socket_.room = 0;
  send(std::string(300, 'e'));
  EXPECT_FALSE(queue_.check_answers());
}

TEST_F(SendQueueTest, PacketsLeaveRoomForAnswers) {
  socket_.room = 0;
  EXPECT_NO_THROW(queue_.check_room_for_packet(5000));  // nothing waits
  send(std::string(400, 'p'));
  EXPECT_NO_THROW(queue_.check_room_for_packet(100));
  try {
    queue_.check_room_for_packet(200);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::buffer_limit_violation);
  }
}

// What waits is charged, no more and no less.
TEST_F(SendQueueTest, ChargesTheOtherSideForWhatWaits) {
  const auto account = std::make_shared<Account>(std::make_shared<Pool>(10'000'000, 0), 10'000'000);
  queue_.set_account(account);
  send("sent");
  EXPECT_EQ(account->held(), 0U);
  socket_.room = 100;
  send(std::string(300, 'x'));
  EXPECT_EQ(account->held(), 200U);
  send(std::string(50, 'x'));
  EXPECT_EQ(account->held(), 250U);
  socket_.room = 220;
  queue_.flush();
  EXPECT_EQ(account->held(), 30U);
  queue_.close();
  queue_.clear();
  EXPECT_EQ(account->held(), 0U);
}

TEST_F(SendQueueTest, RefusesLargeMessagesBeyondTheAccount) {
  SendQueue queue({.limit = 10'000'000, .answer_limit = 100, .is_server = true}, tap_);
  queue.set_carrier(&socket_);
  queue.set_account(std::make_shared<Account>(std::make_shared<Pool>(10'000'000, 0), 1000));
  socket_.room = 0;
  const auto send_bytes = [&](std::size_t size, ErrorCode refusal) {
    Writer writer;
    put(writer, std::string(size, 'x'));
    return queue.send(writer, {.now = Time{}, .refusal = refusal});
  };
  send_bytes(900, ErrorCode::out_of_system_resource);
  // A small one tells of the refusal, so it may wait; a packet and a large one may not.
  EXPECT_EQ(send_bytes(200, ErrorCode::out_of_system_resource), Sent::taken);
  EXPECT_THROW(send_bytes(200, ErrorCode::buffer_limit_violation), Error);
  EXPECT_THROW(send_bytes(5000, ErrorCode::out_of_system_resource), Error);
  EXPECT_EQ(queue.waiting_bytes(), 1100U);
}

TEST_F(SendQueueTest, CallersThatAreExpectedLeaveTogether) {
  EXPECT_EQ(cork("alone", 0), Corked::no);
  EXPECT_EQ(cork("a", 7), Corked::first);
  EXPECT_EQ(cork("b", 6), Corked::joined);
  EXPECT_TRUE(queue_.has_gathered());
  EXPECT_EQ(queue_.waiting_bytes(), 2U);
  EXPECT_EQ(socket_.calls, 0);
  const std::atomic<unsigned> nobody{0};
  queue_.uncork(nobody);
  queue_.flush();
  EXPECT_EQ(socket_.calls, 1);
  EXPECT_EQ(taken(), "ab");
  EXPECT_FALSE(queue_.has_gathered());
}

// When half of those expected have called, the rest is not waited for.
TEST_F(SendQueueTest, HalfOfTheExpectedCallersAreEnough) {
  EXPECT_EQ(cork("a", 3), Corked::first);  // two are missing
  EXPECT_EQ(cork("b", 2), Corked::joined);
  EXPECT_EQ(cork("c", 1), Corked::no);
  EXPECT_EQ(send("c"), Sent::taken);  // with what the others have left
  EXPECT_EQ(taken(), "abc");
}

TEST_F(SendQueueTest, CallersDoNotWaitForOthersWhileTheSocketIsFull) {
  socket_.room = 1;
  send("begun");
  EXPECT_EQ(cork("a", 3), Corked::no);
}

// A thread that streams without a pause leaves its packets to the next flush.
TEST_F(SendQueueTest, PacketsThatFollowEachOtherLeaveTogether) {
  bool is_gathered = false;
  for (int i = 0; i < 1000 && !is_gathered; ++i) {
    Writer writer;
    put(writer, "p");
    is_gathered = queue_.stream(writer) == Sent::first;
  }
  ASSERT_TRUE(is_gathered);
  EXPECT_TRUE(queue_.has_gathered());
  const std::size_t sent = taken().size();
  queue_.flush();
  EXPECT_EQ(taken(), "p");
  EXPECT_GT(sent, 0U);
}

TEST_F(SendQueueTest, WhatWasGatheredGoesBeforeWhatIsSentLater) {
  EXPECT_EQ(cork("first", 5), Corked::first);
  EXPECT_EQ(send("second"), Sent::taken);
  EXPECT_EQ(taken(), "firstsecond");
  EXPECT_EQ(queue_.waiting_bytes(), 0U);
}

TEST_F(SendQueueTest, CountsWhatHasLeftOrWaits) {
  socket_.room = 3;
  send("one");
  Writer writer;
  for (const std::int64_t time : {1, 2}) {
    put(writer, "value");
    const Newest newest{.stream = 1, .time = time};
    queue_.send(writer, {.now = Time{} + Milliseconds(5), .newest = &newest});
  }
  put(writer, "packet");
  queue_.send(writer, {.now = Time{} + Milliseconds(7), .is_packet = true});
  const Traffic traffic = queue_.traffic();
  EXPECT_EQ(traffic.messages_sent, 4U);
  EXPECT_EQ(traffic.bytes_sent, 3U + 2 * 5U + 6U);
  EXPECT_EQ(traffic.wire_values, 2U);
  EXPECT_EQ(traffic.values_skipped, 1U);
  EXPECT_EQ(traffic.pipe_packets, 1U);
  EXPECT_EQ(queue_.last_sent(), Time{} + Milliseconds(7));
  EXPECT_EQ(cork("corked", 2), Corked::no) << "something waits";
  EXPECT_EQ(queue_.traffic().messages_sent, 4U);
}

TEST_F(SendQueueTest, CountsWhatWasGathered) {
  ASSERT_EQ(cork("corked", 2), Corked::first);
  EXPECT_EQ(queue_.traffic().messages_sent, 1U);
  EXPECT_EQ(queue_.traffic().bytes_sent, 6U);
  queue_.close();
  queue_.clear();
  EXPECT_FALSE(queue_.has_gathered());
  EXPECT_EQ(queue_.traffic().messages_sent, 1U) << "what was counted stays";
}

TEST_F(SendQueueTest, ManyAnswersAreWorthALook) {
  EXPECT_EQ(queue_.carrier(), &socket_);
  EXPECT_FALSE(queue_.has_many_answers());
  socket_.room = 0;
  answer(std::string(100, 'x'));
  EXPECT_FALSE(queue_.has_many_answers());
  answer("x");
  EXPECT_TRUE(queue_.has_many_answers());
  EXPECT_TRUE(queue_.check_answers());
}

}  // namespace
}  // namespace rr::channel
