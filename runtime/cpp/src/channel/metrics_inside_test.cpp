// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <utility>

#include "runtime/cpp/src/channel/metrics.hpp"
#include "runtime/cpp/src/channel/metrics_text.hpp"
#include "runtime/cpp/src/channel/status.hpp"

namespace rr::channel {
namespace {

using std::chrono_literals::operator""us;
using ::testing::HasSubstr;
using ::testing::Not;

// A connection that has sent so many messages.
class FakeConnection final : public Metered {
 public:
  explicit FakeConnection(std::uint64_t messages) : messages_(messages) {}
  [[nodiscard]] ConnectionSample sample() const override {
    return {.is_open = true,
            .is_server = true,
            .transport = "rr+tcp",
            .queued_bytes = 5,
            .traffic = {.messages_sent = messages_}};
  }

 private:
  const std::uint64_t messages_;
};

std::string text_of_metrics(const Metrics& metrics) {
  MetricsText text;
  metrics.write(text);
  return std::move(text).finish();
}

TEST(Tally, AddsUp) {
  Tally tally;
  EXPECT_EQ(tally.get(), 0U);
  tally.add(3);
  tally.add(4);
  EXPECT_EQ(tally.get(), 7U);
}

TEST(Traffic, AddsUpFieldByField) {
  Traffic sum{1, 2, 3, 4, 5, 6, 7};
  sum += Traffic{10, 20, 30, 40, 50, 60, 70};
  EXPECT_EQ(sum.messages_received, 11U);
  EXPECT_EQ(sum.bytes_received, 22U);
  EXPECT_EQ(sum.messages_sent, 33U);
  EXPECT_EQ(sum.bytes_sent, 44U);
  EXPECT_EQ(sum.wire_values, 55U);
  EXPECT_EQ(sum.values_skipped, 66U);
  EXPECT_EQ(sum.pipe_packets, 77U);
}

TEST(Metrics, CountConnectionsAndLogins) {
  Metrics metrics;
  metrics.count_accepted();
  metrics.count_accepted();
  metrics.count_beyond_limit();
  for (int i = 0; i < 3; ++i) metrics.count_failed_handshake();
  metrics.count_login(true);
  for (int i = 0; i < 4; ++i) metrics.count_login(false);
  for (int i = 0; i < 5; ++i) metrics.count_dropped_value();
  for (int i = 0; i < 6; ++i) metrics.count_dropped_packet();
  const std::string text = text_of_metrics(metrics);
  EXPECT_THAT(text, HasSubstr("robdef_connections_accepted_total 2\n"));
  EXPECT_THAT(text, HasSubstr("robdef_connections_refused_total{reason=\"limit\"} 1\n"));
  EXPECT_THAT(text, HasSubstr("robdef_connections_refused_total{reason=\"handshake\"} 3\n"));
  EXPECT_THAT(text, HasSubstr("robdef_logins_total{outcome=\"allowed\"} 1\n"));
  EXPECT_THAT(text, HasSubstr("robdef_logins_total{outcome=\"refused\"} 4\n"));
  EXPECT_THAT(text, HasSubstr("robdef_wire_values_total{outcome=\"dropped\"} 5\n"));
  EXPECT_THAT(text, HasSubstr("robdef_pipe_packets_total{outcome=\"dropped\"} 6\n"));
}

TEST(Metrics, CountRequestsByTheTimeTheyTook) {
  Metrics metrics;
  metrics.count_request(RequestKind{}, 30us, ErrorCode::none);
  metrics.count_request(RequestKind{}, 30us, ErrorCode::service_error);
  const std::string text = text_of_metrics(metrics);
  EXPECT_THAT(text, HasSubstr("le=\"2.5e-05\"} 0\n"));
  EXPECT_THAT(text, HasSubstr("le=\"5e-05\"} 2\n"));
  EXPECT_THAT(text, HasSubstr("outcome=\"ok\"} 1\n"));
  EXPECT_THAT(text, HasSubstr("outcome=\"error\"} 1\n"));
}

TEST(Metrics, KeepWhatAConnectionHasCounted) {
  Metrics metrics;
  const FakeConnection first(7);
  const FakeConnection second(100);
  metrics.add(first);
  {
    const Meter meter(&metrics, second);
    const std::string text = text_of_metrics(metrics);
    EXPECT_THAT(text, HasSubstr("robdef_messages_total{direction=\"sent\"} 107\n"));
    EXPECT_THAT(text, HasSubstr("robdef_send_queue_bytes 10\n"));
  }
  metrics.remove(first);
  const std::string text = text_of_metrics(metrics);
  EXPECT_THAT(text, HasSubstr("robdef_messages_total{direction=\"sent\"} 107\n"));
  EXPECT_THAT(text, HasSubstr("robdef_send_queue_bytes 0\n"));
  const Meter nobody(nullptr, first);
}

TEST(MetricsText, WritesFamiliesOfSamples) {
  MetricsText text;
  text.counter({"a", "counter", "Help \"me\".", "seconds"}, 1);
  text.gauge({"b", "gauge", "B."}, 2);
  text.begin({"c", "histogram", "C."});
  text.sample("_sum", {{"l", "x\ny"}, {"m", "z"}}, 1.0);
  text.sample("_count", {}, std::uint64_t{3});
  EXPECT_EQ(std::move(text).finish(),
            "# TYPE a counter\n# UNIT a seconds\n# HELP a Help \\\"me\\\".\na_total 1\n"
            "# TYPE b gauge\n# HELP b B.\nb 2\n"
            "# TYPE c histogram\n# HELP c C.\nc_sum{l=\"x\\ny\",m=\"z\"} 1.0\nc_count 3\n"
            "# EOF\n");
  EXPECT_EQ(MetricsText::seconds_text(2'500'000), "0.0025");
  EXPECT_EQ(MetricsText::seconds_text(1'000'000'000), "1.0");
}

TEST(Status, IsTheTextOfAllSources) {
  Status status{MetricsOptions{}};
  status.add([](MetricsText& text) { text.gauge({"a", "gauge", "A."}, 1); });
  status.add([](MetricsText& text) { text.gauge({"b", "gauge", "B."}, 2); });
  const std::string text = status.metrics();
  EXPECT_LT(text.find("a 1\n"), text.find("b 2\n"));
  EXPECT_TRUE(text.ends_with("# EOF\n"));
  EXPECT_EQ(status.fault(), "");
  status.set_fault("the arm is hot");
  EXPECT_EQ(status.fault(), "the arm is hot");
  status.set_fault("");
  EXPECT_EQ(status.fault(), "");
}

TEST(Status, AnswersThisMachineAndThePlacesOfTheOptions) {
  const Status status({.from = {"10.0.0.5", "192.168.8.0/21", "fd00::/8"}});
  EXPECT_TRUE(status.may_ask("127.0.0.1"));
  EXPECT_TRUE(status.may_ask("::1"));
  EXPECT_TRUE(status.may_ask("10.0.0.5"));
  EXPECT_FALSE(status.may_ask("10.0.0.6"));
  EXPECT_TRUE(status.may_ask("192.168.15.255"));
  EXPECT_FALSE(status.may_ask("192.168.16.0"));
  EXPECT_TRUE(status.may_ask("fd12::1%eth0"));
  EXPECT_FALSE(status.may_ask("fe80::1"));
  EXPECT_FALSE(status.may_ask("uid 1000"));
  EXPECT_TRUE(Status({.from = {"*"}}).may_ask("8.8.8.8"));
  EXPECT_FALSE(Status(MetricsOptions{}).may_ask("8.8.8.8"));
}

TEST(Status, RefusesPlacesThatAreNone) {
  for (const char* place : {"home", "10.0.0.5/33", "10.0.0.5/", "fd00::/129", "10.0.0.5/8x"}) {
    EXPECT_THROW(Status({.from = {place}}), Error) << place;
  }
}

TEST(Status, KnowsItsOwnNames) {
  const Status status({.hosts = {"Robot.Lab"}});
  EXPECT_TRUE(status.is_own_name("localhost"));
  EXPECT_TRUE(status.is_own_name("127.0.0.1"));
  EXPECT_TRUE(status.is_own_name("robot.lab"));
  EXPECT_FALSE(status.is_own_name("evil.example"));
}

}  // namespace
}  // namespace rr::channel
