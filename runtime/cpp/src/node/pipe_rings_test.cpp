// SPDX-License-Identifier: Apache-2.0
// Pipes whose packets come through a ring in shared memory: what clients get, in which order, and
// how memories come and go.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <boost/asio/use_future.hpp>
#include <chrono>
#include <map>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "rr/async.hpp"
#include "rr/tap.hpp"
#include "runtime/cpp/src/node/testing/guarded.hpp"
#include "runtime/cpp/src/node/testing/pipe_boards.hpp"
#include "runtime/cpp/src/node/testing/pipe_rings_rig.hpp"

namespace rr::testing {
namespace {

using std::chrono_literals::operator""ms;
using boost::asio::use_future;
using ::testing::ElementsAre;

// Of 1,000 bytes, the first of which are the number.
Array<std::uint8_t> blob_of(int number, std::size_t size = 1000) {
  Array<std::uint8_t> blob(size);
  const std::span<std::uint8_t> bytes = blob.mutate();
  std::ranges::fill(bytes, static_cast<std::uint8_t>(number));
  std::memcpy(bytes.data(), &number, sizeof number);
  return blob;
}

// -1 for bytes that do not belong together.
int number_of(const Array<std::uint8_t>& blob) {
  int number = 0;
  std::memcpy(&number, blob.data(), sizeof number);
  const auto rest = std::span(blob.data(), blob.size()).subspan(sizeof number);
  const bool is_whole = std::ranges::all_of(
      rest, [&](std::uint8_t byte) { return byte == static_cast<std::uint8_t>(number); });
  return is_whole ? number : -1;
}

void expect_blobs(PipeEndpoint<Array<std::uint8_t>>& end, int first, int last) {
  for (int number = first; number <= last; ++number) {
    const auto packet = end.receive_for(plenty);
    ASSERT_TRUE(packet) << number;
    ASSERT_EQ(number_of(*packet), number);
  }
}

TEST_F(PipeRings, AllReadersShareOneMemory) {
  serve(options());
  auto ends = connect_numbers(8);
  EXPECT_EQ(rings_served(), 1U);
  EXPECT_EQ(rings_read(), 8U);
  send(1, 1000);
  for (Numbers& end : ends) expect_numbers(end, 1, 1000);
  for (Numbers& end : ends) end.close();
  EXPECT_TRUE(eventually([&] { return object_->numbers().endpoint_count() == 0; }));
  EXPECT_EQ(rings_served(), 0U);
}

TEST_F(PipeRings, APacketIsThereWhenItHasBeenSent) {
  serve(options());
  auto end = connect_numbers();
  EXPECT_EQ(end.available(), 0U);
  for (int number = 1; number <= 100; ++number) {
    send(number, number);
    EXPECT_EQ(end.available(), 1U);
    EXPECT_EQ(end.peek(), number);
    ASSERT_EQ(end.try_receive(), number);
  }
}

TEST_F(PipeRings, AFunctionGetsAllPacketsInOrder) {
  serve(options());
  auto end = connect_numbers();
  send(1, 10);
  Log<double> log;
  const Subscription subscription = end.on_packet([&](double number) { log.add(number); });
  send(11, 500);
  EXPECT_TRUE(eventually([&] { return log.size() == 500; })) << log.size();
  send(501, 501);
  EXPECT_TRUE(eventually([&] { return log.size() == 501; }));
  const auto numbers = log.items();
  for (std::size_t i = 0; i < numbers.size(); ++i)
    ASSERT_EQ(numbers[i], static_cast<double>(i + 1));
}

TEST_F(PipeRings, AReceiveThatWaitsGetsTheNextPacket) {
  serve(options());
  auto end = connect_numbers();
  for (int number = 1; number <= 20; ++number) {
    auto received = end.async_receive(use_future);
    send(number, number);
    EXPECT_EQ(received.get(), number);
  }
}

TEST_F(PipeRings, AFunctionMayReceiveAndClose) {
  serve(options());
  auto end = connect_numbers();
  std::atomic<bool> is_closed{false};
  end.on_closed([&] { is_closed = true; });
  std::atomic<double> second{0};
  const Subscription subscription = end.on_packet([&](double number) {
    if (number != 1) return;
    if (const auto next = end.try_receive()) second = *next;
    end.close();
  });
  send(1, 2);
  EXPECT_TRUE(eventually([&] { return is_closed.load(); }));
  EXPECT_TRUE(eventually([&] { return rings_served() == 0; }));
}

TEST_F(PipeRings, AreNotUsedWhereOneSideDoesNotShareMemory) {
  serve(options());
  auto end = connect(options(false))->numbers().connect();
  send(1, 3);
  expect_numbers(end, 1, 3);
  EXPECT_TRUE(mappings().empty());
}

TEST_F(PipeRings, AreNotUsedByANodeWithATap) {
  NodeOptions tapped = options();
  tapped.tap = std::make_shared<Recorder>(run_ + ".rrtape");
  serve(options());
  auto end = connect(tapped)->numbers().connect();
  send(1, 3);
  expect_numbers(end, 1, 3);
  EXPECT_EQ(rings_served(), 0U);
}

TEST_F(PipeRings, APipeThatIsUnreliableLosesNothingThere) {
  serve(options());
  auto& board = connect(options());
  auto lossy = board->lossy().connect();
  ASSERT_TRUE(lossy.is_unreliable());
  EXPECT_EQ(rings_served(), 1U);
  for (int number = 1; number <= 500; ++number) object_->lossy().send(number);
  for (int number = 1; number <= 500; ++number) ASSERT_EQ(lossy.receive_for(plenty), number);
}

TEST_F(PipeRings, OthersGetMessages) {
  serve(options());
  auto shared = connect_numbers();
  auto other = connect(options(false))->numbers().connect();
  send(1, 300);
  expect_numbers(shared, 1, 300);
  expect_numbers(other, 1, 300);
  EXPECT_EQ(rings_read(), 1U);
}

TEST_F(PipeRings, AClientMayHaveSeveralEnds) {
  serve(options());
  auto& board = connect(options());
  auto first = board->numbers().connect();
  auto second = board->numbers().connect();
  send(1, 100);
  expect_numbers(first, 1, 100);
  first.close();
  send(101, 200);
  expect_numbers(second, 1, 200);
}

// More than a ring has room for, before a client reads any of it.
TEST_F(PipeRings, AReaderThatIsSlowGetsTheRestByMessages) {
  serve(options());
  auto slow = connect(options())->blobs().connect();
  auto quick = connect(options())->blobs().connect();
  constexpr int count = 2000;
  std::thread sender([&] {
    for (int number = 1; number <= count; ++number) {
      ASSERT_TRUE(object_->blobs().wait_sent(plenty));
      object_->blobs().send(blob_of(number));
    }
  });
  expect_blobs(quick, 1, count);
  sender.join();
  expect_blobs(slow, 1, count);
  EXPECT_EQ(slow.lost_count(), 0U);
}

TEST_F(PipeRings, AReaderThatWasSlowComesBack) {
  serve(options());
  auto slow = connect(options())->blobs().connect();
  auto quick = connect(options())->blobs().connect();
  int number = 0;
  for (; number < 600; ++number) {
    object_->blobs().send(blob_of(number + 1));
    expect_blobs(quick, number + 1, number + 1);
  }
  expect_blobs(slow, 1, number);
  EXPECT_TRUE(eventually([] { return rings_read() == 1; })) << "it was too slow";
  EXPECT_TRUE(eventually([&] {
    object_->blobs().send(blob_of(++number));
    expect_blobs(quick, number, number);
    expect_blobs(slow, number, number);
    return rings_read() == 2;
  }));
  for (int more = 0; more < 100; ++more) {
    object_->blobs().send(blob_of(++number));
    expect_blobs(quick, number, number);
    expect_blobs(slow, number, number);
  }
}

TEST_F(PipeRings, APacketThatIsTooLargeComesByAMessage) {
  serve(options());
  auto one = connect(options())->blobs().connect();
  auto two = connect(options())->blobs().connect();
  constexpr std::size_t large = 300'000;
  for (int number = 1; number <= 9; ++number) {
    object_->blobs().send(blob_of(number, number % 3 == 0 ? large : 1000));
  }
  expect_blobs(one, 1, 9);
  expect_blobs(two, 1, 9);
  // The next ring has room for such packets.
  int number = 9;
  EXPECT_TRUE(eventually([&] {
    object_->blobs().send(blob_of(++number));
    expect_blobs(one, number, number);
    expect_blobs(two, number, number);
    return rings_read() == 2;
  }));
  for (int more = 0; more < 50; ++more) {
    object_->blobs().send(blob_of(++number, large));
    expect_blobs(one, number, number);
    expect_blobs(two, number, number);
  }
  EXPECT_EQ(rings_read(), 2U);
}

// Other clients cannot read what is sent to one alone.
TEST_F(PipeRings, APacketForOneClientComesByAMessage) {
  serve(options());
  auto one = connect_numbers();
  auto two = connect_numbers();
  send(1, 50);
  const std::uint32_t client = object_->numbers().endpoints().at(0).client();
  const std::uint32_t number = object_->numbers().endpoints().at(0).send(-1);
  EXPECT_EQ(number, 51U);
  send(51, 100);
  Numbers& other = object_->numbers().endpoints().at(0).client() == client ? two : one;
  Numbers& it = &other == &two ? one : two;
  // The order of connecting is that of the list, within one node.
  const bool is_first = it.receive_for(plenty) == 1;
  ASSERT_TRUE(is_first);
  for (int i = 2; i <= 50; ++i) ASSERT_EQ(it.receive_for(plenty), i);
  const auto next = it.receive_for(plenty);
  if (next == -1) {
    expect_numbers(it, 51, 100);
    expect_numbers(other, 1, 100);
  } else {
    ASSERT_EQ(next, 51);
    expect_numbers(it, 52, 100);
    expect_numbers(other, 1, 50);
    expect_numbers(other, -1, -1);
    expect_numbers(other, 51, 100);
  }
  EXPECT_EQ(rings_read(), 1U);
}

TEST_F(PipeRings, AMemoryThatManyHaveReadIsReplaced) {
  serve(options());
  auto stays = connect_numbers();
  const std::vector<std::uint64_t> first = published_ids(3);
  auto& board = connect(options());
  int number = 0;
  EXPECT_TRUE(eventually([&] {
    for (int i = 0; i < 100; ++i) board->numbers().connect().close();
    ++number;
    send(number, number);
    expect_numbers(stays, number, number);
    const std::vector<std::uint64_t> now = published_ids(3);
    return now.size() == 1 && now != first;
  }));
  // The service has it before the client has read the answer.
  EXPECT_TRUE(eventually([] { return rings_read() == 1; }));
  send(number + 1, number + 100);
  expect_numbers(stays, number + 1, number + 100);
}

TEST_F(PipeRings, WhatIsSentBeforeTheAnswerComesFirst) {
  serve(options());
  object_->numbers().on_connect([&](PipeEndpoint<double> end) {
    end.send(1);
    end.send(2);
  });
  auto end = connect_numbers();
  send(3, 100);
  expect_numbers(end, 1, 100);
  EXPECT_EQ(rings_read(), 1U);
}

TEST_F(PipeRings, PacketsThatAreAcknowledgedComeByMessages) {
  serve(options());
  auto end = connect_numbers();
  send(1, 10);
  auto served = object_->numbers().endpoints().at(0);
  Log<std::uint32_t> acknowledged;
  served.on_acknowledged([&](std::uint32_t number) { acknowledged.add(number); });
  served.ask_for_acknowledgements();
  send(11, 13);
  expect_numbers(end, 1, 13);
  EXPECT_TRUE(eventually([&] { return acknowledged.size() == 3; }));
  EXPECT_THAT(acknowledged.items(), ElementsAre(11, 12, 13));
}

TEST_F(PipeRings, AreNotUsedByAPipeWithALimitOfItsBacklog) {
  serve(options());
  auto before = connect_numbers();
  send(1, 10);
  object_->numbers().set_backlog_limit(1000);
  EXPECT_EQ(rings_served(), 0U);
  auto after = connect_numbers();
  EXPECT_EQ(rings_served(), 0U);
  send(11, 20);
  expect_numbers(before, 1, 20);
  expect_numbers(after, 11, 20);
}

TEST_F(PipeRings, WhatWasSentBeforeAnEndWasClosedIsThere) {
  serve(options());
  auto end = connect_numbers();
  auto other = connect_numbers();
  send(1, 100);
  for (auto& served : object_->numbers().endpoints()) served.close();
  EXPECT_TRUE(eventually([&] { return !end.is_open() && !other.is_open(); }));
  expect_numbers(end, 1, 100);
  expect_numbers(other, 1, 100);
  EXPECT_EQ(rings_served(), 0U);
}

TEST_F(PipeRings, WhatWasSentBeforeTheSessionEndedIsThere) {
  serve(options());
  auto end = connect_numbers();
  send(1, 100);
  server_->shutdown();
  EXPECT_TRUE(eventually([&] { return !end.is_open(); }));
  expect_numbers(end, 1, 100);
}

TEST_F(PipeRings, SubscriptionsReadThem) {
  serve(options());
  Node node(options());
  auto subscription = node.subscribe(url());
  subscription.use_types<PipeBoardStub>();
  auto numbers = subscription.subscribe_pipe<double>("numbers");
  EXPECT_TRUE(eventually([&] { return object_->numbers().endpoint_count() == 1; }));
  send(1, 200);
  for (int number = 1; number <= 200; ++number) {
    const auto packet = numbers.receive_for(plenty);
    ASSERT_TRUE(packet);
    ASSERT_EQ(packet->packet, number);
  }
  EXPECT_EQ(rings_read(), 1U);
}

// Each client gets what each thread sends in its order, and nothing twice.
TEST_F(PipeRings, ManyThreadsSendToClientsOfAllPaces) {
  serve(options());
  constexpr int threads = 3;
  constexpr int each = 3000;
  struct Reader {
    PipeEndpoint<Array<std::uint8_t>> end;
    std::chrono::microseconds pause;
    std::map<int, int> seen{};  // of each thread
    bool is_right = true;
  };
  std::vector<Reader> readers;
  for (const int pause : {0, 0, 20, 100}) {
    readers.push_back({connect(options())->blobs().connect(), std::chrono::microseconds(pause)});
  }
  std::vector<std::thread> all;
  for (Reader& reader : readers) {
    all.emplace_back([&reader] {
      for (int i = 0; i < threads * each; ++i) {
        const auto packet = reader.end.receive_for(plenty);
        const int number = packet ? number_of(*packet) : -1;
        reader.is_right =
            reader.is_right && number > 0 && reader.seen[number / 100'000]++ == number % 100'000;
        if (!packet) return;
        if (reader.pause.count() != 0) std::this_thread::sleep_for(reader.pause);
      }
    });
  }
  for (int thread = 1; thread <= threads; ++thread) {
    all.emplace_back([this, thread] {
      for (int i = 0; i < each; ++i) {
        if (!object_->blobs().wait_sent(plenty)) return;
        object_->blobs().send(blob_of(thread * 100'000 + i));
      }
    });
  }
  for (std::thread& thread : all) thread.join();
  for (const Reader& reader : readers) {
    EXPECT_TRUE(reader.is_right);
    for (int thread = 1; thread <= threads; ++thread) EXPECT_EQ(reader.seen.at(thread), each);
  }
}

TEST_F(PipeRings, ClientsComeAndGoWhilePacketsAreSent) {
  serve(options());
  std::atomic<bool> is_over{false};
  std::thread sender([&] {
    for (int number = 1; !is_over; ++number) {
      if (!object_->numbers().wait_sent(plenty)) return;
      object_->numbers().send(number);
    }
  });
  for (int round = 0; round < 50; ++round) {
    Node node(options());
    auto board = node.connect<PipeBoardStub>(url());
    auto end = board->numbers().connect();
    const auto first = end.receive_for(plenty);
    ASSERT_TRUE(first);
    for (int i = 1; i < 200; ++i) ASSERT_EQ(end.receive_for(plenty), *first + i);
    if (round % 2 == 0) end.close();
  }
  is_over = true;
  sender.join();
}

// Rights

ConnectOptions as_user(const std::string& name) {
  ConnectOptions options;
  options.username = name;
  options.credentials["password"] = VarValue(name);
  return options;
}

// A client that has left has the old memory still, and must not see what is sent afterwards.
TEST_F(PipeRings, AClientThatLeavesAServiceWithUsersKeepsTheOldMemoryOnly) {
  serve(options(), {.users = std::make_shared<KnownUsers>(),
                    .rights = std::make_shared<Rights>("allow user:* path board.** access *\n")});
  auto alice = connect(options(), as_user("alice"))->numbers().connect();
  auto bob = connect(options(), as_user("bob"))->numbers().connect();
  send(1, 10);
  const auto before = published_ids(3);
  ASSERT_EQ(before.size(), 1U);
  bob.close();
  EXPECT_EQ(rings_served(), 0U);
  int number = 10;
  EXPECT_TRUE(eventually([&] {
    ++number;
    send(number, number);
    return rings_served() == 1;
  }));
  EXPECT_NE(published_ids(3), before);
  expect_numbers(alice, 1, number);
}

TEST_F(PipeRings, NewRulesMakeNewMemories) {
  serve(options());
  auto end = connect_numbers();
  send(1, 10);
  service_->set_rights(std::make_shared<Rights>("allow anyone path board.** access *\n"));
  EXPECT_EQ(rings_served(), 0U);
  send(11, 20);
  expect_numbers(end, 1, 20);
}

}  // namespace
}  // namespace rr::testing
