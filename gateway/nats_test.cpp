// SPDX-License-Identifier: Apache-2.0
// What NATS needs besides what all brokers do: retained messages, expiry, lives.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <memory>
#include <set>
#include <string>
#include <thread>

#include "gateway/fleet_query.hpp"
#include "gateway/kept_stream.hpp"
#include "gateway/nats_carrier.hpp"
#include "gateway/nats_link.hpp"
#include "gateway/properties.hpp"
#include "gateway/testing/listener.hpp"
#include "gateway/testing/nats_server.hpp"
#include "rr/error.hpp"

namespace rr::gateway {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::comes_true;
using testing::Listener;
using testing::NatsServer;

constexpr NatsLimits quick{.beat = milliseconds(100), .silence = milliseconds(700)};
const std::string life_topic = "rr/hall/r1/$life";

Message retained(const std::string& topic, const std::string& text) {
  Message message{topic, bytes_of(text)};
  message.retained = true;
  return message;
}

/// A connection that keeps what it hears.
struct Peer {
  Peer(const NatsServer& server, const std::vector<std::string>& filters, Message life = {},
       const NatsLimits& limits = quick)
      : carrier(make_nats_carrier({server.url(false)}, limits)) {
    for (const std::string& filter : filters) carrier->subscribe(filter);
    carrier->start(listener, std::move(life));
    EXPECT_TRUE(listener.connected.wait_for(1))
        << (listener.reasons.size() > 0 ? listener.reasons.items()[0] : "no reason");
  }
  ~Peer() { carrier->stop({}); }
  void publish(const Message& message) {
    EXPECT_TRUE(comes_true([&] { return carrier->publish(message) == Published::taken; }));
  }
  /// Texts of what has arrived; `*` marks what was retained.
  [[nodiscard]] std::vector<std::string> texts() const {
    std::vector<std::string> all;
    for (const Message& message : listener.messages.items()) {
      all.push_back(text_of(message.payload) + (message.retained ? "*" : ""));
    }
    return all;
  }

  Listener listener;
  std::unique_ptr<Carrier> carrier;
};

class Nats : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!has_nats() || NatsServer::program().empty()) {
      GTEST_SKIP() << "libnats or nats-server is not installed";
    }
    server.configure({});
    server.start();
  }
  /// What a new reader of a topic gets first.
  [[nodiscard]] std::string newest(const std::string& topic) const {
    // What is retained comes before what the reader itself sends.
    Peer reader(server, {topic, "echo"});
    reader.publish({"echo", bytes_of("nothing")});
    EXPECT_TRUE(reader.listener.messages.wait_for(1));
    return reader.texts()[0];
  }

  NatsServer server;
};

TEST_F(Nats, RetainsTheNewestOfEachTopic) {
  Peer writer(server, {});
  Peer reader(server, {"rr/hall/#"});
  for (const char* text : {"1", "2", "3"}) writer.publish(retained("rr/hall/a", text));
  writer.publish(retained("rr/hall/b.c", "4"));
  writer.publish({"rr/hall/d", bytes_of("5")});
  // Older values may be left out on the way to the stream, and there.
  ASSERT_TRUE(comes_true([&] {
    const auto all = reader.texts();
    return std::ranges::count(all, "3") + std::ranges::count(all, "4") +
               std::ranges::count(all, "5") >=
           3;
  }));
  EXPECT_EQ(newest("rr/hall/a"), "3*");
  Peer later(server, {"rr/hall/#", "rr/other/#"});
  ASSERT_TRUE(later.listener.messages.wait_for(2));
  EXPECT_THAT(later.texts(), ::testing::UnorderedElementsAre("3*", "4*"));
  // A filter that is added later has them, too.
  Peer last(server, {});
  last.carrier->subscribe("rr/hall/+");
  ASSERT_TRUE(last.listener.messages.wait_for(2));
  EXPECT_THAT(last.texts(), ::testing::UnorderedElementsAre("3*", "4*"));
}

// A gateway that asks for a node looks at nothing before that.
TEST_F(Nats, WhatIsRetainedComesAfterTheConnection) {
  struct Order final : CarrierHandler {
    void on_message(Message message) override { words.add(text_of(message.payload)); }
    void on_connected() override { words.add("connected"); }
    void on_disconnected(const std::string&) override {}
    void on_room() override {}
    void on_refused(const Refusal&) override {}
    testing::Kept<std::string> words;
  } order;
  Peer writer(server, {});
  writer.publish(retained(life_topic, "up"));
  ASSERT_TRUE(comes_true([&] { return newest(life_topic) == "up*"; }));
  const auto carrier = make_nats_carrier({server.url(false)}, quick);
  carrier->subscribe(life_topic);
  carrier->start(order, {});
  ASSERT_TRUE(order.words.wait_for(2));
  EXPECT_THAT(order.words.items(), ::testing::ElementsAre("connected", "up"));
  carrier->stop({});
}

TEST_F(Nats, RetainsOnlyBelowItsTopics) {
  Peer writer(server, {});
  EXPECT_EQ(writer.carrier->publish(retained("elsewhere/a", "1")), Published::refused);
}

TEST_F(Nats, WhatHasExpiredIsNotDelivered) {
  Peer writer(server, {});
  Message wire = retained("rr/hall/r1/arm/force", "1");
  wire.expiry = seconds(1);
  writer.publish(wire);
  Message other = retained("rr/hall/r1/arm/torque", "2");
  other.expiry = seconds(1'000);
  writer.publish(other);
  ASSERT_TRUE(comes_true([&] { return newest("rr/hall/r1/arm/torque") == "2*"; }));
  EXPECT_TRUE(comes_true([&] { return newest("rr/hall/r1/arm/force") == "nothing"; }));
  EXPECT_EQ(newest("rr/hall/r1/arm/torque"), "2*");
}

TEST_F(Nats, WhatIsTooLargeIsRefused) {
  Peer writer(server, {});
  EXPECT_EQ(writer.carrier->publish({"a", Bytes(2'000'000)}), Published::refused);
  Message headers{"a", {}};
  headers.properties = {{"reason", std::string(2'000'000, 'x')}};
  EXPECT_EQ(writer.carrier->publish(headers), Published::refused);
  EXPECT_EQ(writer.carrier->publish({"a", Bytes(1'000'000)}), Published::taken);
}

// What the server has confirmed it has after any signal.
TEST_F(Nats, RetainedMessagesOutliveAServerThatIsKilled) {
  Peer writer(server, {});
  Peer reader(server, {"rr/hall/#"});
  for (int round = 0; round < 5; ++round) {
    const std::string text = "of " + std::to_string(round);
    for (int topic = 0; topic < 50; ++topic) {
      writer.publish(retained("rr/hall/" + std::to_string(topic), text));
    }
    // It publishes them once it has stored them.
    ASSERT_TRUE(comes_true([&] {
      std::set<std::string> topics;
      for (const Message& message : reader.listener.messages.items()) {
        if (text_of(message.payload) == text) topics.insert(message.topic);
      }
      return topics.size() == 50;
    }));
    server.kill();
    server.start();
    Peer after(server, {"rr/hall/#"});
    ASSERT_TRUE(after.listener.messages.wait_for(50));
    EXPECT_THAT(after.texts(),
                ::testing::AllOf(::testing::SizeIs(50), ::testing::Each(text + "*")));
  }
}

// The newest is repeated until the server has it.
TEST_F(Nats, ARetainedMessageIsRepeatedUntilItIsStored) {
  Peer writer(server, {});
  for (int round = 0; round < 5; ++round) {
    const std::string text = "of " + std::to_string(round);
    server.kill();
    server.start();
    writer.publish(retained("rr/hall/a", text));
    EXPECT_TRUE(comes_true([&] { return newest("rr/hall/a") == text + "*"; }));
  }
}

TEST_F(Nats, ALifeThatBeatsIsNotLost) {
  Peer reader(server, {life_topic});
  Peer living(server, {}, retained(life_topic, "lost"));
  living.publish(retained(life_topic, "up"));
  ASSERT_TRUE(reader.listener.messages.wait_for(1));
  std::this_thread::sleep_for(milliseconds(1'500));
  // Perhaps twice, when the stream has just been made.
  EXPECT_THAT(reader.texts(), ::testing::Each("up"));
  // A reader that comes later sees it as it is.
  EXPECT_EQ(newest(life_topic), "up*");
}

TEST_F(Nats, ALifeThatEndsIsNotLost) {
  Peer reader(server, {life_topic});
  {
    Peer living(server, {}, retained(life_topic, "lost"));
    living.publish(retained(life_topic, "up"));
    ASSERT_TRUE(reader.listener.messages.wait_for(1));
    living.carrier->stop(retained(life_topic, "ended"));
  }
  ASSERT_TRUE(comes_true([&] { return reader.texts().back() == "ended"; }));
  std::this_thread::sleep_for(milliseconds(1'500));
  EXPECT_EQ(reader.texts().back(), "ended");
  EXPECT_THAT(reader.texts(), ::testing::Not(::testing::Contains("lost")));
  EXPECT_EQ(newest(life_topic), "ended*");
}

// Without the farewell it is as if the process had been killed.
TEST_F(Nats, AReaderThatComesLaterSeesThatALifeIsLost) {
  {
    Peer living(server, {}, retained(life_topic, "lost"));
    living.publish(retained(life_topic, "up"));
    ASSERT_TRUE(comes_true([&] { return newest(life_topic) == "up*"; }));
  }
  EXPECT_TRUE(comes_true([&] { return newest(life_topic) == "lost*"; }));
  const auto carrier = make_nats_carrier({server.url(false)}, quick);
  const Fleet fleet = ask_for_fleet(*carrier, seconds(10), milliseconds(300));
  EXPECT_THAT(fleet.text(), ::testing::HasSubstr("hall/r1: lost"));
}

TEST_F(Nats, AServerWithoutJetStreamIsReported) {
  NatsServer plain("", false);
  plain.configure({});
  plain.start();
  Listener listener;
  NatsLimits limits = quick;
  limits.beginning = milliseconds(1'000);
  const auto carrier = make_nats_carrier({plain.url(false)}, limits);
  carrier->subscribe(life_topic);
  carrier->start(listener, {});
  ASSERT_TRUE(listener.reasons.wait_for(1));
  EXPECT_EQ(listener.reasons.items()[0],
            plain.url(false) + ": JetStream: nobody answers, perhaps it is not enabled");
  EXPECT_EQ(listener.connected.size(), 0U);
  carrier->stop({});
}

TEST_F(Nats, ATokenTakesThePlaceOfAUser) {
  NatsServer strict("authorization { token: \"right\" }\n");
  strict.configure({});
  strict.start();
  const auto failure = [&](const std::string& token) {
    Listener listener;
    const auto carrier = make_nats_carrier({.url = strict.url(false), .token = token}, quick);
    carrier->start(listener, {});
    EXPECT_TRUE(
        comes_true([&] { return listener.connected.size() + listener.reasons.size() > 0; }));
    carrier->stop({});
    return listener.connected.size() > 0 ? "none" : listener.reasons.items()[0];
  };
  EXPECT_EQ(failure("right"), "none");
  EXPECT_EQ(failure("wrong"),
            strict.url(false) + ": the broker refuses the token: Authorization Violation");
}

// Each user of the stream may say where its messages go.
TEST_F(Nats, WhatTheStreamDeliversElsewhereIsNotHeard) {
  Peer writer(server, {});
  writer.publish(retained("rr/hall/a", "1"));
  ASSERT_TRUE(comes_true([&] { return newest("rr/hall/a") == "1*"; }));
  Peer victim(server, {"rr/hall/target"});
  constexpr std::array<BrokerScheme, 1> schemes{{{"nats", false, 4222}}};
  const BrokerOptions options{server.url(false)};
  const auto mailbox = std::make_shared<NatsMailbox>();
  NatsLink link(options, place_of(options, schemes), seconds(10), mailbox);
  const auto own = link.subscribe("rr.hall.target");
  NatsMessage request{reader_create_subject("elsewhere", "rrkept.hall.a"), "rr.hall.answer"};
  request.payload = bytes_of(reader_create_text("elsewhere", "rrkept.hall.a", "rr.hall.target"));
  ASSERT_TRUE(link.publish(request));
  ASSERT_TRUE(comes_true([&] {
    const auto mail = mailbox->wait(std::chrono::steady_clock::now() + milliseconds(100));
    return !mail.messages.empty() && text_of(mail.messages[0].payload) == "1";
  }));
  writer.publish({"rr/hall/target", bytes_of("2")});
  ASSERT_TRUE(victim.listener.messages.wait_for(1));
  EXPECT_THAT(victim.texts(), ::testing::ElementsAre("2"));
}

TEST_F(Nats, TakesTheNextServerOfACluster) {
  NatsServer gone;
  Listener listener;
  const std::string url = gone.url(false) + "," + server.url(false).substr(7);
  const auto carrier = make_nats_carrier({url}, quick);
  EXPECT_EQ(carrier->url(), url);
  carrier->start(listener, {});
  EXPECT_TRUE(listener.connected.wait_for(1));
  EXPECT_EQ(listener.reasons.size(), 1U);
  carrier->stop({});
}

TEST(NatsUrls, OfClustersAreLists) {
  if (!has_nats()) GTEST_SKIP() << "libnats is not installed";
  EXPECT_THROW(static_cast<void>(make_nats_carrier({"nats://a,http://b"})), Error);
  EXPECT_THROW(static_cast<void>(make_nats_carrier({"nats://a,"})), Error);
  EXPECT_THROW(static_cast<void>(make_nats_carrier({.url = "nats://a", .replicas = 0})), Error);
  EXPECT_NO_THROW(static_cast<void>(make_nats_carrier({"nats://a,nats://b:4,c,[::1]:5"})));
}

}  // namespace
}  // namespace rr::gateway
