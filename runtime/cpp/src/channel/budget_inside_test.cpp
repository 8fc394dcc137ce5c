// SPDX-License-Identifier: Apache-2.0
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>

#include <algorithm>
#include <list>
#include <mutex>
#include <span>
#include <thread>
#include <vector>

#include "runtime/cpp/src/channel/testing/accepting.hpp"
#include "runtime/cpp/src/codec/large_block.hpp"
#include "runtime/cpp/src/node/testing/gate.hpp"

namespace rr::channel {
namespace {

using rr::testing::Accepting;
using rr::testing::comes_true;
using rr::testing::Gate;
using rr::testing::message_of;
using rr::testing::SocketPair;
using rr::testing::TestReceiver;
using std::chrono_literals::operator""ms;
using std::chrono_literals::operator""s;
using ::testing::Contains;
using ::testing::HasSubstr;

constexpr std::size_t kib = 1024;
constexpr std::size_t mebibyte = 1024 * kib;

// What a sender can get rid of while the other side does not read: the buffers of the sockets, and
// what was read; waits up to a second for more room.
std::size_t send_until_full(const SocketPair& sockets, std::span<const std::byte> message,
                            std::size_t most) {
  std::size_t sent = 0;
  while (sent < most) {
    std::span<const std::byte> rest = message;
    while (!rest.empty()) {
      if (!sockets.may_send(500)) return sent;
      const ssize_t now = ::send(sockets.own(), rest.data(), rest.size(), MSG_DONTWAIT);
      if (now <= 0) break;
      sent += static_cast<std::size_t>(now);
      rest = rest.subspan(static_cast<std::size_t>(now));
    }
  }
  return sent;
}

TEST(Budgets, AMessageIsChargedAsItsBytesComeUntilItHasBeenHandled) {
  Gate gate;
  Accepting accepting({.budget = {.before_session = 1'500 * kib}},
                      [&](Connection&, const Entry&, const MemoryRef&) { gate.pass(); });
  SocketPair peer;
  accepting.accept(peer);
  const auto message = message_of(EntryType::property_set_req, 500'000);
  const std::span bytes(message);
  peer.send(bytes.first(100'000));
  EXPECT_TRUE(comes_true([&] { return accepting.strangers_hold() >= 100'000; }));
  std::this_thread::sleep_for(50ms);
  EXPECT_LE(accepting.strangers_hold(), 300'000U);  // not what was announced
  peer.send(bytes.subspan(100'000));
  ASSERT_TRUE(gate.has_entered());
  EXPECT_GE(accepting.strangers_hold(), message.size());
  gate.open();
  EXPECT_TRUE(comes_true([&] { return accepting.strangers_hold() == 0; }));
  EXPECT_EQ(accepting.receiver().handled, 1U);
}

TEST(Budgets, AMessageIsChargedAtOnceWhileMostOfThePoolIsFree) {
  Accepting accepting;
  SocketPair peer;
  accepting.accept(peer);
  const auto message = message_of(EntryType::property_set_req, 500'000);
  peer.send(std::span(message).first(100'000));
  EXPECT_TRUE(comes_true([&] { return accepting.strangers_hold() >= message.size(); }));
}

TEST(Budgets, BlocksThatHaveBeenUsedAreNotTakenForWhatIsChargedAsItComes) {
  Accepting accepting({.budget = {.before_session = 1'500 * kib}});
  SocketPair peer;
  accepting.accept(peer);
  const auto message = message_of(EntryType::property_set_req, 500'000);
  codec::give_back_large_block(codec::take_large_block(message.size() + 16));
  peer.send(std::span(message).first(100'000));
  EXPECT_TRUE(comes_true([&] { return accepting.strangers_hold() >= 100'000; }));
  EXPECT_GE(codec::spare_block_bytes(), message.size());
}

// Giving blocks back takes milliseconds; whoever finds no room need not wait for that.
TEST(Budgets, SpareBlocksOfAFullPoolGoOnAnotherThread) {
  const auto reactor = std::make_shared<Reactor>(4);
  reactor->start();
  const Pools pools = make_pools({.budget = {.before_session = 64 * kib}});
  watch_pools(pools, reactor);
  codec::give_back_large_block(codec::take_large_block(mebibyte));
  ASSERT_GE(codec::spare_block_bytes(), mebibyte);
  const auto account = std::make_shared<Account>(pools.before_session, no_limit);
  Charge charge(account);
  EXPECT_FALSE(charge.add(mebibyte));
  EXPECT_TRUE(comes_true([] { return codec::spare_block_bytes() == 0; }));
  reactor->stop();
}

TEST(Budgets, WhatAHandlerKeepsIsNotChargedAfterwards) {
  std::mutex mutex;
  std::vector<MemoryRef> kept;
  Accepting accepting({}, [&](Connection&, const Entry&, const MemoryRef& owner) {
    const std::lock_guard lock(mutex);
    kept.push_back(owner);
  });
  SocketPair peer;
  accepting.accept(peer);
  for (int i = 0; i < 20; ++i) peer.send(message_of(EntryType::property_set_req, 400'000));
  EXPECT_TRUE(comes_true([&] { return accepting.receiver().handled == 20; }));
  EXPECT_TRUE(comes_true([&] { return accepting.strangers_hold() == 0; }));
}

TEST(Budgets, StrangersThatDoNotFinishTheirMessagesHoldNoMoreThanTheirPool) {
  constexpr std::size_t limit = 2 * mebibyte;
  constexpr std::size_t count = 60;
  Accepting accepting({.budget = {.before_session = limit, .patience = 300ms}});
  std::list<SocketPair> peers(count);
  const auto message = message_of(EntryType::property_set_req, 500'000);
  for (SocketPair& peer : peers) {
    accepting.accept(peer);
    send_until_full(peer, std::span(message).first(8'000), 8'000);
  }
  std::size_t most = 0;
  for (SocketPair& peer : peers) {
    [[maybe_unused]] const auto sent =
        ::send(peer.own(), message.data(), 150'000, MSG_DONTWAIT | MSG_NOSIGNAL);
    most = std::max(most, accepting.strangers_hold());
  }
  const auto is_closed = [&](std::size_t i) { return accepting.receiver(i).is_closed.load(); };
  EXPECT_TRUE(comes_true([&] {
    most = std::max(most, accepting.strangers_hold());
    std::size_t closed = 0;
    for (std::size_t i = 0; i < count; ++i) closed += is_closed(i) ? 1U : 0U;
    return closed > 0;
  }));
  EXPECT_LE(most, limit + count * 8 * kib);
  EXPECT_THAT(accepting.warnings(), Contains(HasSubstr("does not fit")));
  for (std::size_t i = 0; i < count; ++i) {
    if (!is_closed(i)) continue;
    EXPECT_EQ(accepting.receiver(i).code(), ErrorCode::out_of_system_resource);
  }
  peers.clear();  // they leave
  EXPECT_TRUE(comes_true([&] { return accepting.strangers_hold() == 0; }));
}

TEST(Budgets, AMessageGoesOnWhenOthersHaveGivenTheirMemoryBack) {
  Accepting accepting({.budget = {.before_session = 500 * kib}});
  SocketPair first;
  SocketPair second;
  accepting.accept(first);
  accepting.accept(second);
  const auto message = message_of(EntryType::property_set_req, 300'000);
  first.send(std::span(message).first(290'000));
  EXPECT_TRUE(comes_true([&] { return accepting.strangers_hold() >= 290'000; }));
  const std::jthread sender([&] { second.send(message); });
  std::this_thread::sleep_for(100ms);
  EXPECT_EQ(accepting.receiver(1).handled, 0U);
  first.send(std::span(message).subspan(290'000));
  EXPECT_TRUE(comes_true([&] { return accepting.receiver(1).handled == 1U; }));
  EXPECT_TRUE(comes_true([&] { return accepting.receiver(0).handled == 1U; }));
  EXPECT_TRUE(comes_true([&] { return accepting.strangers_hold() == 0; }));
}

TEST(Budgets, AMessageThatComesTooSlowlyEndsItsConnection) {
  Accepting accepting({.message_timeout = 200ms});
  SocketPair slow;
  SocketPair other;
  accepting.accept(slow);
  accepting.accept(other);
  const auto message = message_of(EntryType::property_set_req, 20'000);
  const auto begin = Clock::now();
  // A byte from time to time is no progress.
  for (std::size_t sent = 0; !accepting.receiver(0).is_closed && sent < 2'000; ++sent) {
    [[maybe_unused]] const auto size =
        ::send(slow.own(), message.data() + sent, 1, MSG_DONTWAIT | MSG_NOSIGNAL);
    std::this_thread::sleep_for(10ms);
  }
  EXPECT_TRUE(accepting.receiver(0).is_closed);
  EXPECT_EQ(accepting.receiver(0).code(), ErrorCode::operation_timeout);
  EXPECT_GE(Clock::now() - begin, 450ms);  // 200 ms, and 305 ms for 20,000 bytes
  EXPECT_THAT(accepting.warnings(), Contains(HasSubstr("did not come in time")));
  other.send(message);
  EXPECT_TRUE(comes_true([&] { return accepting.receiver(1).handled == 1U; }));
}

TEST(Budgets, MessagesThatWaitAreChargedUntilTheyHaveBeenHandled) {
  Gate gate;
  Accepting accepting({}, [&](Connection&, const Entry&, const MemoryRef&) { gate.pass(); });
  SocketPair peer;
  accepting.accept(peer);
  accepting.connection().set_authorised(true);
  peer.send(message_of(EntryType::property_set_req));
  ASSERT_TRUE(gate.has_entered());
  EXPECT_EQ(accepting.sessions_hold(), 0U);  // it is handled where it was received
  for (int i = 0; i < 50; ++i) peer.send(message_of(EntryType::property_set_req, 1'000));
  EXPECT_TRUE(comes_true([&] { return accepting.sessions_hold() >= 50'000; }));
  gate.open();
  EXPECT_TRUE(comes_true([&] { return accepting.receiver().handled == 51; }));
  EXPECT_TRUE(comes_true([&] { return accepting.sessions_hold() == 0; }));
}

// A handler waits for its client; what comes meanwhile waits behind a second one that is slow.
TEST(Budgets, AServiceThatWaitsForItsClientReadsNoMoreThanMayWait) {
  Gate gate;
  Accepting* accepting = nullptr;
  Accepting made({.request_queue_limit = mebibyte},
                 [&](Connection&, const Entry& entry, const MemoryRef&) {
                   if (entry.type == EntryType::function_call_req) {
                     accepting->receiver().wait_for_answer();
                   } else {
                     gate.pass();
                   }
                 });
  accepting = &made;
  SocketPair peer;
  made.accept(peer).set_authorised(true);
  peer.send(message_of(EntryType::function_call_req));
  const auto request = message_of(EntryType::property_set_req, 100'000);
  const std::size_t sent = send_until_full(peer, request, 40 * mebibyte);
  EXPECT_GE(sent, mebibyte);
  EXPECT_LE(sent, 4 * mebibyte);  // what may wait, one message and the buffers of the system
  EXPECT_LE(made.sessions_hold(), 3 * mebibyte);
  EXPECT_FALSE(made.receiver().was_answered);
  gate.open();
  // What was cut off is the rest of one message.
  const std::size_t whole = sent / request.size();
  peer.send(std::span(request).subspan(sent % request.size()));
  peer.send(message_of(EntryType::callback_call_ret));
  EXPECT_TRUE(comes_true([&] { return made.receiver().handled >= whole + 1; }));
  EXPECT_TRUE(comes_true([&] { return made.receiver().was_answered.load(); }));
  EXPECT_TRUE(comes_true([&] { return made.sessions_hold() == 0; }));
}

// Answers

void answer(Connection& connection, std::size_t size) {
  Writer writer;
  writer.reset(MessageVersion::v2);
  const std::size_t end = writer.position();
  const std::string filling(size, 'y');
  writer.string_element("filling", filling);
  writer.entry({.type = EntryType::property_get_res}, 1, end);
  writer.message({}, 1);
  connection.reply(writer);
}

TEST(Budgets, RequestsWaitUntilTheirClientTakesTheAnswersBefore) {
  constexpr unsigned count = 64;
  Accepting accepting({}, [](Connection& connection, const Entry&, const MemoryRef&) {
    answer(connection, 512 * kib);
  });
  SocketPair peer;
  accepting.accept(peer).set_authorised(true);
  for (unsigned i = 0; i < count; ++i) peer.send(message_of(EntryType::property_get_req, 100));
  EXPECT_TRUE(comes_true([&] { return accepting.receiver().handled >= 3; }));
  std::this_thread::sleep_for(200ms);
  EXPECT_LE(accepting.receiver().handled, 6U);
  EXPECT_LE(accepting.sessions_hold(), 3 * mebibyte);
  for (unsigned i = 0; i < count; ++i) {
    ASSERT_GE(peer.receive_message(10'000).size(), 512 * kib) << i;
  }
  EXPECT_TRUE(comes_true([&] { return accepting.receiver().handled == count; }));
  EXPECT_TRUE(comes_true([&] { return accepting.sessions_hold() == 0; }));
}

TEST(Budgets, AnAnswerThatNobodyTakesIsRefusedWhenThePoolIsFull) {
  std::atomic<int> refused{0};
  Accepting accepting({.budget = {.sessions = 4 * mebibyte}},
                      [&](Connection& connection, const Entry&, const MemoryRef&) {
                        try {
                          answer(connection, 900 * kib);
                        } catch (const Error& error) {
                          EXPECT_EQ(error.code(), ErrorCode::out_of_system_resource);
                          ++refused;
                          answer(connection, 100);  // one that says so
                        }
                      });
  constexpr unsigned count = 20;
  std::list<SocketPair> peers(count);
  for (SocketPair& peer : peers) {
    accepting.accept(peer).set_authorised(true);
    peer.send(message_of(EntryType::property_get_req));
  }
  EXPECT_TRUE(comes_true([&] {
    unsigned handled = 0;
    for (unsigned i = 0; i < count; ++i) handled += accepting.receiver(i).handled;
    return handled == count;
  }));
  EXPECT_GT(refused, 5);
  EXPECT_LE(accepting.sessions_hold(), 4 * mebibyte + std::size_t{count} * 64 * kib);
  // Each gets one or the other.
  for (SocketPair& peer : peers) EXPECT_FALSE(peer.receive_message(10'000).empty());
  EXPECT_TRUE(comes_true([&] { return accepting.sessions_hold() == 0; }));
}

TEST(Budgets, StreamsOfAFullPoolSayThatTheirBufferIsFull) {
  Accepting accepting({.budget = {.sessions = mebibyte}});
  SocketPair peer;
  Connection& connection = accepting.accept(peer);
  connection.set_authorised(true);
  ErrorCode code = ErrorCode::none;
  for (int i = 0; i < 1'000 && code == ErrorCode::none; ++i) {
    Writer writer;
    writer.reset(MessageVersion::v2);
    const std::size_t end = writer.position();
    writer.string_element("filling", std::string(10'000, 'z'));
    writer.entry({.type = EntryType::pipe_packet}, 1, end);
    writer.message({}, 1);
    try {
      connection.stream(writer);
    } catch (const Error& error) {
      code = error.code();
    }
  }
  EXPECT_EQ(code, ErrorCode::buffer_limit_violation);
  EXPECT_LE(accepting.sessions_hold(), mebibyte + 192 * kib);
  EXPECT_FALSE(connection.is_closed());
}

TEST(Budgets, WhatWaitsToBeSentIsGivenBackWhenTheConnectionEnds) {
  Accepting accepting({}, [](Connection& connection, const Entry&, const MemoryRef&) {
    answer(connection, 8 * mebibyte);
  });
  {
    SocketPair peer;
    accepting.accept(peer).set_authorised(true);
    peer.send(message_of(EntryType::property_get_req));
    EXPECT_TRUE(comes_true([&] { return accepting.sessions_hold() >= 7 * mebibyte; }));
  }
  EXPECT_TRUE(comes_true([&] { return accepting.sessions_hold() == 0; }));
}

// The departed

TEST(Departed, WhatTheyHaveAskedForIsNotHandledAnyMore) {
  Gate gate;
  Accepting accepting({}, [&](Connection&, const Entry&, const MemoryRef&) { gate.pass(); });
  {
    SocketPair peer;
    accepting.accept(peer);
    std::vector<std::byte> all;
    for (int i = 0; i < 100; ++i) {
      const auto message = message_of(EntryType::property_set_req, 100);
      all.insert(all.end(), message.begin(), message.end());
    }
    peer.send(all);  // some are received together with the first, others after it
    ASSERT_TRUE(gate.has_entered());
    peer.send(all);
  }
  EXPECT_TRUE(comes_true([&] { return accepting.connection().is_closed(); }));
  EXPECT_TRUE(comes_true([&] { return accepting.strangers_hold() == 0; }));
  EXPECT_FALSE(accepting.receiver().is_closed);  // a handler still runs
  gate.open();
  EXPECT_TRUE(comes_true([&] { return accepting.receiver().is_closed.load(); }));
  EXPECT_EQ(accepting.receiver().handled, 1U);
  EXPECT_EQ(accepting.receiver().handled_when_closed, 1U);
}

TEST(Departed, AreNoticedWhileTheyAreNotRead) {
  Gate gate;
  Accepting accepting({.request_queue_limit = 50 * kib},
                      [&](Connection&, const Entry&, const MemoryRef&) { gate.pass(); });
  {
    SocketPair peer;
    accepting.accept(peer);
    send_until_full(peer, message_of(EntryType::property_set_req, 10'000), mebibyte);
    ASSERT_TRUE(gate.has_entered());
  }
  EXPECT_TRUE(comes_true([&] { return accepting.connection().is_closed(); }));
  // What is left is what the handler has that runs.
  EXPECT_TRUE(comes_true([&] { return accepting.strangers_hold() <= 32 * kib; }))
      << accepting.strangers_hold();
  gate.open();
  EXPECT_TRUE(comes_true([&] { return accepting.receiver().is_closed.load(); }));
  EXPECT_EQ(accepting.receiver().handled, 1U);
  EXPECT_EQ(accepting.strangers_hold(), 0U);
}

// The size of messages, and the pool

TEST(Authorised, MessagesAreLargeForAsLongAsTheClientIs) {
  Accepting accepting({.size_before_connect = 64 * kib});
  const auto large = message_of(EntryType::property_set_req, 100'000);
  SocketPair peer;
  Connection& connection = accepting.accept(peer);
  connection.set_authorised(true);
  peer.send(large);
  EXPECT_TRUE(comes_true([&] { return accepting.receiver().handled == 1; }));
  connection.set_authorised(false);
  send_until_full(peer, large, 1);
  EXPECT_TRUE(comes_true([&] { return accepting.receiver().is_closed.load(); }));
  EXPECT_EQ(accepting.receiver().code(), ErrorCode::protocol_error);
  EXPECT_EQ(accepting.receiver().handled, 1U);
}

TEST(Authorised, WhatIsHeldCountsInThePoolOfSessionsForAsLongAsTheClientIs) {
  Accepting accepting;
  SocketPair peer;
  Connection& connection = accepting.accept(peer);
  const auto message = message_of(EntryType::property_set_req, 400'000);
  peer.send(std::span(message).first(200'000));
  EXPECT_TRUE(comes_true([&] { return accepting.strangers_hold() >= 200'000; }));
  connection.set_authorised(true);
  EXPECT_EQ(accepting.strangers_hold(), 0U);
  EXPECT_GE(accepting.sessions_hold(), 200'000U);
  connection.set_authorised(false);
  EXPECT_EQ(accepting.sessions_hold(), 0U);
  EXPECT_GE(accepting.strangers_hold(), 200'000U);
}

}  // namespace
}  // namespace rr::channel
