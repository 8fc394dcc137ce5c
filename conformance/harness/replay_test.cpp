// SPDX-License-Identifier: Apache-2.0
// The two replays against each other: a recording agrees with itself, and any change of it is seen.
#include <gtest/gtest.h>

#include <future>
#include <stdexcept>

#include "conformance/harness/broker.hpp"
#include "conformance/harness/client_replay.hpp"
#include "conformance/harness/decoded.hpp"
#include "conformance/harness/service_replay.hpp"

namespace rr::conformance {
namespace {

// The other replay is the client: nothing has to be told to it.
class PlayedClient final : public TestedClient {
 public:
  void begin(const Scenario&, int, const Json&) override {}
  void start(const Json&) override {}
  std::optional<Json> outcome(Milliseconds) override { return std::nullopt; }
  [[nodiscard]] bool tells_outcomes() const override { return false; }
  [[nodiscard]] Milliseconds patience() const override { return Milliseconds(10000); }
};

struct BothResults {
  Result service;
  Result client;
};

class Replay : public testing::Test {
 protected:
  static const Captures& captures() {
    static const Captures all = read_captures(CONFORMANCE_CAPTURES);
    return all;
  }

  BothResults play(const Scenario& as_client, const Scenario& as_service,
                   const std::string& name = "tcp") {
    const Comparison comparison(captures());
    const Deviations none;
    Channel channel(name);
    Listener listener = channel.listen();
    Entrance entrance(channel, as_service, listener);
    PlayedClient client;
    BothResults results;
    const auto service = std::async(std::launch::async, [&] {
      results.client = ClientReplay(comparison, none, entrance, client).play(as_service);
    });
    const Connect connect{name,
                          [&] { return channel.connect(as_client, "127.0.0.1", listener.port()); }};
    results.service =
        ServiceReplay(comparison, none, connect, [](const std::string&) {}).play(as_client);
    service.wait();
    return results;
  }
};

TEST_F(Replay, EveryRecordingAgreesWithItself) {
  for (const Scenario& scenario : captures().scenarios) {
    if (scenario.hand_made) continue;
    const BothResults results = play(scenario, scenario);
    for (const Result& result : {results.service, results.client}) {
      EXPECT_EQ(result.checked, static_cast<int>(scenario.steps.size()));
      for (const Fault& fault : result.faults) {
        ADD_FAILURE() << scenario.name << " " << scenario.version << " " << name_of(result.run.role)
                      << " " << fault.place << ": " << fault.text;
      }
    }
  }
}

TEST_F(Replay, OverEveryChannelTheSameIsPlayedAndCompared) {
  const Scenario& recorded = *captures().find("functions", "v4");
  Scenario changed = recorded;
  Frame& answer = changed.frames.at(10);
  answer.decoded["entries"][0]["elements"][0]["value"] = Json::array({43});
  answer.bytes = rr::write_tree(message_of_json(answer.decoded));
  for (const std::string& channel : channel_names()) {
    // There are no bytes, or they pass gateways, which conformance.mqtt and conformance.nats have.
    if (channel == "intra" || is_over_broker(channel)) continue;
    SCOPED_TRACE(channel);
    const BothResults same = play(recorded, recorded, channel);
    EXPECT_EQ(same.service.checked, static_cast<int>(recorded.steps.size()));
    EXPECT_TRUE(same.service.faults.empty());
    EXPECT_TRUE(same.client.faults.empty());
    const BothResults other = play(recorded, changed, channel);
    ASSERT_EQ(other.service.faults.size(), 1U);
    EXPECT_EQ(other.service.faults[0].place, "step 3");
  }
}

TEST_F(Replay, OtherWordsAroundARecordedWebSocketAreFound) {
  const Scenario& recorded = *captures().find("websocket", "v4");
  ASSERT_FALSE(recorded.web_socket.is_empty());
  Scenario changed = recorded;
  std::string& response = changed.web_socket.response;
  response.replace(response.find("Upgrade\r\nSec"), 7, "upgrade");
  EXPECT_THROW(play(recorded, changed), std::runtime_error);
}

TEST_F(Replay, AChangedAnswerIsFoundInItsStep) {
  const Scenario& recorded = *captures().find("functions", "v4");
  Scenario changed = recorded;
  Frame& answer = changed.frames.at(10);
  ASSERT_FALSE(answer.from_client);
  answer.decoded["entries"][0]["elements"][0]["value"] = Json::array({43});
  answer.bytes = rr::write_tree(message_of_json(answer.decoded));
  const BothResults results = play(recorded, changed);
  ASSERT_EQ(results.service.faults.size(), 1U);
  EXPECT_EQ(results.service.faults[0].place, "step 3");
  EXPECT_TRUE(results.client.faults.empty());
}

TEST_F(Replay, AnAnswerTooFewIsFoundAndTheRestIsStillPlayed) {
  const Scenario& recorded = *captures().find("functions", "v2");
  Scenario changed = recorded;
  changed.steps.at(4).frame_count = 1;
  const BothResults results = play(recorded, changed);
  ASSERT_EQ(results.service.faults.size(), 1U);
  EXPECT_EQ(results.service.faults[0].place, "step 4");
}

TEST_F(Replay, AChangedRequestIsFoundInItsStep) {
  const Scenario& recorded = *captures().find("properties_modifiers", "v2");
  Scenario changed = recorded;
  Frame& request = changed.frames.at(9);
  ASSERT_TRUE(request.from_client);
  request.decoded["entries"][0]["member"] = "v_double";
  request.bytes = rr::write_tree(message_of_json(request.decoded));
  const BothResults results = play(changed, recorded);
  ASSERT_EQ(results.client.faults.size(), 1U);
  EXPECT_EQ(results.client.faults[0].place, "step 3");
}

TEST_F(Replay, ARequestTooManyIsFound) {
  const Scenario& recorded = *captures().find("connect", "v4");
  Scenario changed = recorded;
  changed.steps.back().frame_count = 0;
  changed.connections[0].closed_after_frame = 3;
  const BothResults results = play(recorded, changed);
  ASSERT_EQ(results.client.faults.size(), 1U);
}

}  // namespace
}  // namespace rr::conformance
