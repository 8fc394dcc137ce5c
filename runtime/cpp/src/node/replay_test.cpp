// SPDX-License-Identifier: Apache-2.0
// Recordings of connections that pass by, and recordings that are played to our own nodes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <future>
#include <initializer_list>
#include <limits>
#include <mutex>
#include <thread>

#include "rr/error.hpp"
#include "runtime/cpp/src/node/testing/all_members.hpp"
#include "runtime/cpp/src/node/testing/pair.hpp"
#include "runtime/cpp/src/node/testing/recordings.hpp"
#include "runtime/cpp/src/replay/cutter.hpp"
#include "runtime/cpp/src/replay/player.hpp"
#include "runtime/cpp/src/replay/proxy.hpp"

namespace rr::testing {
namespace {

using replay::play;
using replay::PlayOptions;
using replay::PlayReport;
using replay::Proxy;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::string all_of(const PlayReport& report) {
  std::string text;
  for (const replay::Difference& each : report.differences) {
    text += "#" + std::to_string(each.connection) + " " + each.text + "\n";
  }
  return text;
}

class Replaying : public ::testing::Test {
 protected:
  // What AllMembers::use does, as the client's node sees it.
  std::string record_all(const Offer& offer = {}) {
    const std::string path = folder_ / "all";
    const auto tap = std::make_shared<Recorder>(path);
    Node server({.name = "server", .server_offer = offer});
    Node client({.name = "client", .client_offer = offer, .tap = tap});
    AllMembers members(server);
    AllMembers::use(client, members.port());
    return path;
  }
  // What a client does with a counter.
  std::string record_counter(const std::function<void(CounterStub&)>& what,
                             std::shared_ptr<Counter> object = std::make_shared<Counter>()) {
    const std::string path = folder_ / "counter";
    Pair pair({}, {.tap = std::make_shared<Recorder>(path)}, std::move(object));
    auto counter = pair.connect();
    what(*counter);
    return path;
  }
  static PlayReport play_to(const std::string& recording, std::uint16_t port, bool is_fast = true) {
    PlayOptions options;
    options.service = replay::HostPort{"127.0.0.1", port};
    options.is_fast = is_fast;
    return play(recording, options);
  }

  RecordingFolder folder_;
};

TEST_F(Replaying, AProxyRecordsWhatTheNodesDo) {
  for (const int form : {2, 4, 5}) {
    const auto own = std::make_shared<Recorder>(folder_ / "own");
    const auto between = std::make_shared<Recorder>(folder_ / "between");
    const Offer offer{.message_v4 = form != 2, .string_table = form == 5};
    {
      Node server({.name = "server", .server_offer = offer});
      Node client({.name = "client", .client_offer = offer, .tap = own});
      AllMembers members(server);
      Proxy proxy(between, {"127.0.0.1", members.port()});
      AllMembers::use(client, static_cast<std::uint16_t>(proxy.port()));
      client.shutdown();
    }
    own->close();
    between->close();
    const Recorded node = read_recorded(folder_ / "own");
    const Recorded proxy = read_recorded(folder_ / "between");
    EXPECT_EQ(difference_of_messages(node, proxy), "");
    EXPECT_EQ(node.message_count, proxy.message_count);
    ASSERT_EQ(proxy.agreed.size(), AllMembers::connections);
    for (const auto& [number, agreed] : proxy.agreed) {
      EXPECT_EQ(agreed, node.agreed.at(number));
      EXPECT_EQ(proxy.opened.at(number).side, TapSide::between);
    }
    EXPECT_THAT(proxy.closed.at(1).reason, HasSubstr("closed the connection"));
    EXPECT_THAT(proxy.definitions, ::testing::Contains(std::string(rr_store_definition.text)));
  }
}

TEST_F(Replaying, AProxyEndsWithConnectionsOpenAndWithoutAService) {
  const auto tap = std::make_shared<Recorder>(folder_ / "between");
  Pair pair;
  auto proxy = std::make_unique<Proxy>(tap, replay::HostPort{"127.0.0.1", pair.port});
  auto counter = pair.client.connect<CounterStub>(
      "rr+tcp://127.0.0.1:" + std::to_string(proxy->port()) + "/?service=counter");
  EXPECT_EQ(counter->add(1, 2), 3);
  proxy.reset();
  EXPECT_EQ(error_of([&] { counter->add(1, 2); }).code(), ErrorCode::connection_error);
  std::mutex mutex;
  std::vector<std::string> said;
  Proxy lonely(tap, {"127.0.0.1", 1}, {.log = [&](const std::string& text) {
                 const std::lock_guard lock(mutex);
                 said.push_back(text);
               }});
  const std::string url =
      "rr+tcp://127.0.0.1:" + std::to_string(lonely.port()) + "/?service=counter";
  EXPECT_NE(error_of([&] { pair.client.connect<CounterStub>(url); }).code(), ErrorCode::none);
  EXPECT_TRUE(eventually([&] {
    const std::lock_guard lock(mutex);
    return !said.empty() && said.front().find("nobody listens") != std::string::npos;
  }));
  EXPECT_EQ(error_of([&] {
              Proxy(tap, {"127.0.0.1", 1}, {.port = lonely.port()});
            }).code(),
            ErrorCode::connection_error);
}

TEST_F(Replaying, MessagesAreCutOutOfAnyPieces) {
  const std::string path = record_counter([](CounterStub& counter) {
    counter.blob(100'000);
    counter.add(1, 2);
  });
  std::vector<std::vector<std::byte>> messages;
  for (const auto& [key, each] : read_recorded(path).messages) {
    messages.insert(messages.end(), each.begin(), each.end());
  }
  std::vector<std::byte> stream;
  for (const auto& message : messages) stream.insert(stream.end(), message.begin(), message.end());
  for (const auto piece : std::initializer_list<std::size_t>{1, 3, 10, 11, 100, 4096, 1'000'000}) {
    replay::Cutter cutter;
    std::vector<std::vector<std::byte>> cut;
    for (std::size_t at = 0; at < stream.size(); at += piece) {
      cutter.add(std::span(stream).subspan(at, std::min(piece, stream.size() - at)),
                 [&](std::span<const std::byte> message) {
                   cut.emplace_back(message.begin(), message.end());
                 });
    }
    EXPECT_EQ(cut, messages) << piece;
    EXPECT_EQ(cutter.begun(), 0U);
    EXPECT_FALSE(cutter.is_lost());
  }
  replay::Cutter cutter;
  const std::string other = "GET / HTTP/1.1";
  cutter.add(std::as_bytes(std::span(other.data(), other.size())),
             [](std::span<const std::byte>) { FAIL(); });
  EXPECT_TRUE(cutter.is_lost());
}

TEST_F(Replaying, TheClientsOfARecordingArePlayedToAService) {
  for (const int form : {2, 4, 5}) {
    const Offer offer{.message_v4 = form != 2, .string_table = form == 5};
    const std::string path = record_all(offer);
    Node server({.name = "another", .server_offer = offer});
    AllMembers members(server);
    const PlayReport report = play_to(path, members.port());
    EXPECT_EQ(all_of(report), "") << form;
    EXPECT_THAT(report.gaps, IsEmpty());
    EXPECT_GT(report.sent, 40U);
    EXPECT_GT(report.compared, 60U);
    EXPECT_EQ(report.left_out, 0U);
  }
}

TEST_F(Replaying, AtTheRecordedTimesToo) {
  const std::string path = record_counter([](CounterStub& counter) {
    counter.add(1, 2);
    std::this_thread::sleep_for(std::chrono::milliseconds(120));
    counter.add(3, 4);
  });
  Pair pair;
  const auto begun = std::chrono::steady_clock::now();
  EXPECT_EQ(all_of(play_to(path, pair.port, false)), "");
  EXPECT_GE(std::chrono::steady_clock::now() - begun, std::chrono::milliseconds(120));
}

TEST_F(Replaying, TheServiceOfARecordingIsPlayedToAClient) {
  const std::string path = record_all();
  std::promise<int> listening;
  PlayOptions options;
  options.is_fast = true;
  options.on_listening = [&](int port) { listening.set_value(port); };
  auto playing = std::async(std::launch::async, [&] { return play(path, options); });
  {
    Node client({.name = "another"});
    AllMembers::use(client, static_cast<std::uint16_t>(listening.get_future().get()));
  }
  const PlayReport report = playing.get();
  EXPECT_EQ(all_of(report), "");
  EXPECT_GT(report.sent, 60U);
  EXPECT_GT(report.compared, 40U);
}

class WrongCounter final : public Counter {
 public:
  double add(double a, double b) override { return a - b; }
  std::string echo(const std::string&) override {
    throw Error(ErrorCode::operation_failed, "no more");
  }
  void fire(std::int32_t count) override { Counter::fire(count + 1); }
};

TEST_F(Replaying, WhatDiffersIsNamed) {
  const std::string path = record_counter([](CounterStub& counter) {
    std::atomic<int> ticks = 0;
    Subscription ticked =
        counter.ticked().connect([&](std::int32_t, const std::string&) { ++ticks; });
    counter.add(5, 2);
    counter.echo("hello");
    counter.fire(1);
    ASSERT_TRUE(eventually([&] { return ticks == 1; }));
    counter.get_value();
  });
  Pair pair({}, {}, std::make_shared<WrongCounter>());
  const PlayReport report = play_to(path, pair.port);
  std::vector<std::string> texts;
  for (const replay::Difference& each : report.differences) texts.push_back(each.text);
  EXPECT_THAT(texts, ElementsAre(HasSubstr("FunctionCallRes counter.add id"),
                                 HasSubstr("FunctionCallRes counter.echo id"),
                                 HasSubstr("EventReq counter.ticked")));
  EXPECT_THAT(texts.front(), HasSubstr(": `return`: double 7 recorded, double 3 came"));
  EXPECT_THAT(texts[1], HasSubstr("error 0 recorded, 19 came"));
  EXPECT_THAT(texts[2], HasSubstr("came and is not recorded"));
}

TEST_F(Replaying, NumbersMayDifferByATolerance) {
  struct Drifting final : Counter {
    double get_value() override { return 2000.0 + drift; }
    double add(double a, double b) override { return a + b + drift; }
    double drift = 0;
  };
  const auto object = std::make_shared<Drifting>();
  const std::string path = record_counter(
      [](CounterStub& counter) {
        counter.get_value();
        counter.add(0.25, 0.25);
      },
      object);
  object->drift = 0.5;
  Pair pair({}, {}, object);
  const auto differences = [&](double tolerance, std::vector<std::string> ignored = {}) {
    PlayOptions options;
    options.service = replay::HostPort{"127.0.0.1", pair.port};
    options.is_fast = true;
    options.tolerance = tolerance;
    options.ignored = std::move(ignored);
    return play(path, options);
  };
  EXPECT_EQ(differences(0).differences.size(), 2U);
  const PlayReport some = differences(0.001);  // enough of 2000, and too little of 0.5
  EXPECT_THAT(all_of(some), HasSubstr("FunctionCallRes counter.add"));
  EXPECT_EQ(some.differences.size(), 1U);
  EXPECT_EQ(all_of(differences(0.5)), "");
  EXPECT_EQ(all_of(differences(std::numeric_limits<double>::max())), "");
  object->drift = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(differences(1e300).differences.size(), 2U) << "what is no number is near to none";
  // What is ignored is counted, request and answer, and nothing beside it.
  const PlayReport ignoring = differences(0, {"counter.add"});
  EXPECT_EQ(ignoring.differences.size(), 1U);
  EXPECT_GE(ignoring.ignored, 1U);
  EXPECT_EQ(differences(0, {"counter.ad", "counter.addition"}).differences.size(), 2U);
  EXPECT_EQ(all_of(differences(0, {"counter"})), "");
}

// Texts and integers have no tolerance.
TEST_F(Replaying, ATextMayNotDiffer) {
  struct Shouting final : Counter {
    std::string echo(const std::string& text) override { return text + "!"; }
  };
  const std::string path = record_counter([](CounterStub& counter) { counter.echo("a"); });
  Pair pair({}, {}, std::make_shared<Shouting>());
  PlayOptions options;
  options.service = replay::HostPort{"127.0.0.1", pair.port};
  options.is_fast = true;
  options.tolerance = 1000;
  EXPECT_EQ(play(path, options).differences.size(), 1U);
  options.ignored = {"counter.echo"};
  EXPECT_EQ(all_of(play(path, options)), "");
}

TEST_F(Replaying, ARecordingThatCannotBePlayedIsRefused) {
  PlayOptions options;
  options.service = replay::HostPort{"127.0.0.1", 1};
  EXPECT_EQ(error_of([&] { play(folder_ / "nowhere", options); }).code(), ErrorCode::io_error);
  { Recorder empty(folder_ / "empty"); }
  EXPECT_EQ(error_of([&] { play(folder_ / "empty", options); }).code(),
            ErrorCode::invalid_argument);
  const std::string path = record_counter([](CounterStub& counter) { counter.add(1, 2); });
  EXPECT_EQ(error_of([&] { play(path, options); }).code(), ErrorCode::connection_error);
}

TEST_F(Replaying, AddressesAreReadInEachForm) {
  EXPECT_EQ(replay::host_port_of("localhost:6000").port, 6000);
  EXPECT_EQ(replay::host_port_of("[::1]:6000").host, "::1");
  EXPECT_EQ(replay::host_port_of("rr+tcp://robot:6001/?service=arm").host, "robot");
  for (const char* text :
       {"", "robot", ":6000", "robot:", "robot:x", "[::1]", "rr+ws://robot:1/"}) {
    EXPECT_EQ(error_of([&] { replay::host_port_of(text); }).code(), ErrorCode::invalid_argument)
        << text;
  }
}

}  // namespace
}  // namespace rr::testing
