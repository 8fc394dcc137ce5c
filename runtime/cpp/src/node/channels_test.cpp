// SPDX-License-Identifier: Apache-2.0
// What holds for every channel, and how clients that are slow are kept from others.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sched.h>

#include <chrono>
#include <fstream>
#include <thread>
#include <vector>

#include "rr/channel.hpp"
#include "rr/intra.hpp"
#include "runtime/cpp/src/node/testing/pair.hpp"
#include "runtime/cpp/src/node/testing/process_state.hpp"
#include "runtime/cpp/src/node/testing/raw_socket.hpp"

namespace rr::testing {
namespace {

using Clock = std::chrono::steady_clock;

class EachChannel : public ::testing::TestWithParam<const char*> {
 protected:
  EachChannel() {
    service = server.register_service("counter", object);
    place = listen_by_channel(server, port, GetParam());
  }
  Client<CounterStub> connect() { return client.connect<CounterStub>(place + "service=counter"); }

  std::shared_ptr<Counter> object = std::make_shared<Counter>();
  Node server{with_channel({.name = "each.server"}, GetParam())};
  Node client{with_channel({.name = "each.client"}, GetParam())};
  Service service;
  std::uint16_t port = 0;
  std::string place;
};
INSTANTIATE_TEST_SUITE_P(Channels, EachChannel,
                         ::testing::Values("tcp", "local", "intra", "ws", "tls", "wss"),
                         [](const auto& test) { return std::string(test.param); });

TEST_P(EachChannel, CarriesCalls) {
  const auto counter = connect();
  EXPECT_EQ(counter->add(1.25, 2.5), 3.75);
  EXPECT_EQ(counter->echo("text"), "text");
}

TEST_P(EachChannel, CarriesLargeMessagesInBothDirections) {
  const auto counter = connect();
  std::string text(3'000'000, 'x');
  for (std::size_t i = 0; i < text.size(); ++i) text[i] = static_cast<char>('a' + i % 23);
  EXPECT_EQ(counter->echo(text), text);
}

TEST_P(EachChannel, CarriesTheCallsOfManyThreads) {
  const auto counter = connect();
  std::vector<std::thread> threads;
  std::atomic<int> right{0};
  for (int i = 0; i < 4; ++i) {
    threads.emplace_back([&, i] {
      for (int k = 0; k < 100; ++k) {
        if (counter->add(i, k) == i + k) ++right;
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(right, 400);
}

TEST_P(EachChannel, TellsBothSidesOfTheEnd) {
  auto counter = connect();
  counter->reset();
  ASSERT_EQ(service->clients().size(), 1U);
  counter.close();
  EXPECT_TRUE(eventually([&] { return service->clients().empty(); }));
  auto other = connect();
  server.shutdown();
  EXPECT_NE(error_of([&] { other->reset(); }).code(), ErrorCode::none);
}

TEST_P(EachChannel, FindsNoNodeThatIsNotThere) {
  const std::string other = place.substr(0, place.find('?')) +
                            "?nodeid=11111111-2222-3333-4444-555555555555&service=counter";
  const Error error = error_of([&] { client.connect<CounterStub>(other); });
  EXPECT_TRUE(error.code() == ErrorCode::node_not_found ||
              error.code() == ErrorCode::connection_error)
      << error.message();
}

// In a network of its own, whose system gives out these ports only. Needs root.
TEST(Ports, ThatAreAnyAreNeverTheSharedOne) {
  bool is_alone = false;
  std::uint16_t port = 0;
  Error none(ErrorCode::none, "");
  std::thread([&] {
    const auto give_out = [](const char* ports) {
      std::ofstream range("/proc/sys/net/ipv4/ip_local_port_range");
      return static_cast<bool>(range << ports << std::flush);
    };
    is_alone = unshare(CLONE_NEWNET) == 0 && give_out("48653 48654");
    if (!is_alone) return;
    {
      Node node;
      port = node.listen_tcp(0, "*");
      none = error_of([&] { node.listen_tcp(0, "*"); });
    }
  }).join();
  if (!is_alone) GTEST_SKIP() << "may not make a network";
  EXPECT_EQ(port, 48654);
  EXPECT_EQ(none.code(), ErrorCode::connection_error);
}

TEST(Intra, FindsNodesByNameInTheirSpaceOnly) {
  const auto space = std::make_shared<IntraSpace>();
  Node server({.name = "intra.node", .intra = space});
  server.register_service("counter", std::make_shared<Counter>());
  server.listen("rr+intra://");
  ASSERT_EQ(space->nodes().size(), 1U);
  EXPECT_EQ(space->nodes().front().name, "intra.node");
  Node inside({.intra = space});
  const std::string url = "rr+intra:///?nodename=intra.node&service=counter";
  EXPECT_EQ(inside.connect<CounterStub>(url)->add(1, 2), 3);
  Node outside;
  EXPECT_EQ(error_of([&] { outside.connect<CounterStub>(url); }).code(), ErrorCode::node_not_found);
  server.shutdown();
  EXPECT_TRUE(space->nodes().empty());
}

TEST(Channels, OnesOwnMayNotTakeOurSchemes) {
  const auto space = std::make_shared<IntraSpace>();
  const auto channel = space->channel(NodeId::random(), "x");
  const Error error = error_of([&] { Node node({.channels = {{"rr+tcp", channel}}}); });
  EXPECT_EQ(error.code(), ErrorCode::invalid_argument);
  EXPECT_THAT(error.message(), ::testing::HasSubstr("rr+tcp"));
}

TEST(Channels, OnesOwnIsUsedByItsScheme) {
  const auto space = std::make_shared<IntraSpace>();
  const NodeId id = NodeId::random();
  Node server({.name = "own", .id = id, .channels = {{"test+own", space->channel(id, "own")}}});
  server.register_service("counter", std::make_shared<Counter>());
  server.listen("test+own://");
  const NodeId other = NodeId::random();
  Node client({.id = other, .channels = {{"test+own", space->channel(other, "")}}});
  EXPECT_EQ(client.connect<CounterStub>("test+own:///?nodename=own&service=counter")->add(1, 2), 3);
}

// What slow and silent clients do not hold up.
TEST(Handshakes, AThousandSlowOnesDoNotHoldUpAClient) {
  Pair pair({.first_message_timeout = std::chrono::seconds(30)});
  std::vector<RawSocket> slow;
  for (int i = 0; i < 1000; ++i) slow.emplace_back(pair.port);
  // Messages, web sockets in their request and behind it, TLS.
  const std::string request =
      "GET / HTTP/1.1\r\nHost: here\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
      "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\n\r\n";
  for (std::size_t i = 1; i < slow.size(); i += 4) slow[i].send(request);
  const std::string_view begins[] = {"RRAC", "\x82\xfe\x01\x01", "GET ", "\x16\x03\x01\x02"};
  Node client;
  const std::string place = "://127.0.0.1:" + std::to_string(pair.port) + "/?service=counter";
  for (std::size_t byte = 0; byte < 4; ++byte) {
    for (std::size_t i = 0; i < slow.size(); ++i) slow[i].send(begins[i % 4].substr(byte, 1));
    for (const char* scheme : {"rr+tcp", "rr+ws"}) {
      const auto begin = Clock::now();
      const auto counter = client.connect<CounterStub>(scheme + place);
      EXPECT_EQ(counter->add(1, 2), 3);
      EXPECT_LT(Clock::now() - begin, std::chrono::seconds(slowness())) << scheme;
    }
  }
}

TEST(Handshakes, OfOneByteAtATimeEndInTime) {
  Pair pair({.first_message_timeout = std::chrono::milliseconds(300)});
  const RawSocket slow(pair.port);
  const auto begin = Clock::now();
  std::thread writer([&] {
    for (int i = 0; i < 20; ++i) {
      slow.send("G");
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
  });
  EXPECT_EQ(slow.receive_all().find("101"), std::string::npos);
  EXPECT_LT(Clock::now() - begin, std::chrono::seconds(10));
  writer.join();
}

}  // namespace
}  // namespace rr::testing
