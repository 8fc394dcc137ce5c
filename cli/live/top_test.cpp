// SPDX-License-Identifier: Apache-2.0
// `robdef top`, and what it makes of a node's metrics.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <memory>
#include <string>

#include "cli/live/node_metrics.hpp"
#include "cli/live/testing/bench_service.hpp"
#include "compiler/driver/program.hpp"
#include "rr/node.hpp"
#include "runtime/cpp/src/node/testing/server.hpp"

namespace robdef::testing {
namespace {

using live::NodeMetrics;
using rr::testing::eventually;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

std::string bucket(const std::string& kind, const std::string& bound, int count) {
  return "rpc_server_call_duration_seconds_bucket{rpc_system_name=\"robot_raconteur\","
         "robdef_request=\"" +
         kind + "\",le=\"" + bound + "\"} " + std::to_string(count) + "\n";
}

TEST(NodeMetrics, ReadsSamplesAndNothingElse) {
  const NodeMetrics metrics(
      "HTTP/1.1 200 OK\r\nContent-Length: 12\r\n\r\n# TYPE a counter\na_total{k=\"v\"} 3\n"
      "a_total{k=\"w\"} 4.5\nb 1e3\nc x\nd\nab_total 9\n# EOF\n");
  EXPECT_EQ(metrics.value("a_total{k=\"v\"}"), 3);
  EXPECT_EQ(metrics.sum("a_total"), 7.5);
  EXPECT_EQ(metrics.value("b"), 1000);
  EXPECT_EQ(metrics.value("c"), 0);
  EXPECT_TRUE(metrics.latencies().empty());
}

TEST(NodeMetrics, LatencyIsThatOfTheRequestsBetweenTwoLooks) {
  const NodeMetrics before(bucket("get", "0.001", 100) + bucket("get", "0.01", 100) +
                           bucket("get", "+Inf", 100));
  const NodeMetrics now(bucket("get", "0.001", 104) + bucket("get", "0.01", 107) +
                        bucket("get", "+Inf", 107) + bucket("set", "0.001", 2) +
                        bucket("set", "0.01", 2) + bucket("set", "+Inf", 3));
  // Ten requests: six within a millisecond, nine within ten, one slower.
  EXPECT_EQ(live::latency(before, now, 0.5), 0.001);
  EXPECT_EQ(live::latency(before, now, 0.6), 0.001);
  EXPECT_EQ(live::latency(before, now, 0.9), 0.01);
  EXPECT_EQ(live::latency(before, now, 0.95), std::numeric_limits<double>::infinity());
  EXPECT_EQ(live::latency(now, now, 0.95), std::nullopt);
  EXPECT_EQ(live::latency(NodeMetrics(""), NodeMetrics(""), 0.95), std::nullopt);
}

class Top : public ::testing::Test {
 protected:
  const std::shared_ptr<Bench> bench_ = std::make_shared<Bench>();
  rr::testing::Server server_{"bench", bench_, {.metrics = {.is_enabled = true}}};
  TemporaryFolder folder_;
};

TEST_F(Top, CountsWhatMembersSend) {
  bench_->level().set_in(1.5);
  Running top(folder_, {"top", server_.url(), "--every", "0.05"});
  ASSERT_TRUE(eventually([&] { return bench_->points().endpoint_count() == 1; }));
  for (int i = 0; i < 3; ++i) bench_->points().send({.x = 1.0 * i, .y = -2});
  bench_->ticked(7, "x");
  EXPECT_TRUE(eventually([&] {
    static const std::string points = "points  pipe          0.0           3  {\"x\":2,\"y\":-2}";
    return top.out().rfind(points) != std::string::npos;
  })) << top.out();
  EXPECT_TRUE(eventually([&] {
    return top.out().rfind("ticked  event         0.0           1") != std::string::npos;
  })) << top.out();
  EXPECT_EQ(top.end(SIGTERM), 0);
  EXPECT_THAT(top.out(),
              AllOf(HasSubstr(server_.url() + "  connected\nclients 1, requests "),
                    HasSubstr("\n\nMEMBER  KIND   PER SECOND       COUNT  NEWEST\n"),
                    HasSubstr("level   wire "), HasSubstr("  1.5\n"), Not(HasSubstr("\x1b"))));
  EXPECT_TRUE(eventually([&] { return bench_->level().connection_count() == 0; }));
}

TEST_F(Top, ShowsNamedMembersAndEndsAfterSomeTables) {
  const Ended ended = run_robdef(
      folder_, {"top", server_.url(), "lamp.switched", "--every", "0.01", "--count", "2"});
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_THAT(ended.out, HasSubstr("lamp.switched  event         0.0           0  \n"));
  EXPECT_THAT(ended.out, Not(HasSubstr("level")));
  std::size_t tables = 0;
  for (std::size_t at = 0; (at = ended.out.find("MEMBER", at)) != std::string::npos; ++at) ++tables;
  EXPECT_EQ(tables, 2U);
}

TEST_F(Top, SaysWhereANodeTellsNothing) {
  rr::testing::Server silent("bench", bench_);
  const Ended ended = run_robdef(folder_, {"top", silent.url(), "--every", "0.01", "--count", "3"});
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_THAT(ended.out, HasSubstr("the node tells no metrics (--robotraconteur-metrics)\n"));
}

TEST_F(Top, RefusesMembersThatSendNothing) {
  for (const char* const member : {"gain", "add", "hidden", "nothing"}) {
    const Ended ended = run_robdef(folder_, {"top", server_.url(), member});
    EXPECT_EQ(ended.status, 1) << member;
    EXPECT_THAT(ended.err, HasSubstr(member));
  }
  EXPECT_EQ(run_robdef(folder_, {"top"}).status, 2);
}

TEST_F(Top, ConnectsAgain) {
  Running top(folder_, {"top", server_.url(), "level", "--every", "0.05", "--timeout", "2"});
  ASSERT_TRUE(eventually([&] { return top.out().find("MEMBER") != std::string::npos; }));
  server_.stop();
  ASSERT_TRUE(eventually([&] { return top.out().find("  lost: ") != std::string::npos; }));
  server_.start();
  ASSERT_TRUE(eventually([&] { return top.out().find("connected again") != std::string::npos; }));
  bench_->level().set_in(17.25);
  EXPECT_TRUE(eventually([&] { return top.out().find("  17.25\n") != std::string::npos; }));
  EXPECT_EQ(top.end(SIGTERM), 0);
}

}  // namespace
}  // namespace robdef::testing
