// SPDX-License-Identifier: Apache-2.0
// What a node counts: each number is asserted after a known number of calls, values and packets.
#include "runtime/cpp/src/channel/metrics.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <fstream>
#include <iterator>
#include <memory>
#include <regex>
#include <set>
#include <string>
#include <thread>

#include "rr/users.hpp"
#include "rr/version.hpp"
#include "runtime/cpp/src/channel/metrics_text.hpp"
#include "runtime/cpp/src/node/testing/open_metrics.hpp"
#include "runtime/cpp/src/node/testing/pair.hpp"
#include "runtime/cpp/src/node/testing/pipe_board.hpp"
#include "runtime/cpp/src/node/testing/raw_socket.hpp"
#include "runtime/cpp/src/node/testing/wired.hpp"

namespace rr::testing {
namespace {

NodeOptions counting() { return {.name = "metrics.test", .metrics = {.is_enabled = true}}; }

std::string requests(const std::string& kind, const std::string& outcome) {
  return "robdef_server_requests_total{robdef_request=\"" + kind + "\",outcome=\"" + outcome +
         "\"}";
}

/// A request is counted when its answer has left, which may be after the client has it.
bool is_soon(const Node& node, const std::string& sample, double value) {
  return eventually([&] { return OpenMetrics(node.metrics()).value(sample) == value; });
}

TEST(MetricsText, HasTheFormOfOpenMetrics) {
  channel::MetricsText text;
  text.begin({"a_bytes", "gauge", "Two\nlines \\ \"here\".", "bytes"});
  text.sample("", {{"name", "x\"y\\z\nw"}, {"b", ""}}, std::uint64_t{7});
  text.counter({"b", "counter", "B."}, 18'446'744'073'709'551'615U);
  text.begin({"c_seconds", "gauge", "C.", "seconds"});
  text.sample("", {}, 0.25);
  text.sample("", {{"k", "v"}}, 3.0);
  EXPECT_EQ(std::move(text).finish(),
            "# TYPE a_bytes gauge\n# UNIT a_bytes bytes\n"
            "# HELP a_bytes Two\\nlines \\\\ \\\"here\\\".\n"
            "a_bytes{name=\"x\\\"y\\\\z\\nw\",b=\"\"} 7\n"
            "# TYPE b counter\n# HELP b B.\nb_total 18446744073709551615\n"
            "# TYPE c_seconds gauge\n# UNIT c_seconds seconds\n# HELP c_seconds C.\n"
            "c_seconds 0.25\nc_seconds{k=\"v\"} 3.0\n# EOF\n");
}

TEST(Metrics, PutsLatenciesIntoTheirBuckets) {
  using namespace std::chrono_literals;
  channel::Metrics metrics;
  const auto count = [&](channel::Clock::duration took) {
    metrics.count_request(channel::RequestKind::get, took, ErrorCode::none);
  };
  for (const auto took : {0us, 9us, 10us, 24us, 25us}) count(took);
  count(9s);
  count(1h);
  count(-1ms);
  channel::MetricsText text;
  metrics.write(text);
  const OpenMetrics parsed(std::move(text).finish());
  const auto below = [&](const std::string& bound) {
    return parsed.value(
        "rpc_server_call_duration_seconds_bucket{rpc_system_name=\"robot_raconteur\","
        "robdef_request=\"get\",le=\"" +
        bound + "\"}");
  };
  EXPECT_EQ(below("1e-05"), 4);
  EXPECT_EQ(below("2.5e-05"), 6);
  EXPECT_EQ(below("5e-05"), 6);
  EXPECT_EQ(below("2.5"), 6);
  EXPECT_EQ(below("10.0"), 7);
  EXPECT_EQ(below("+Inf"), 8);
  EXPECT_NEAR(parsed.value("rpc_server_call_duration_seconds_sum{rpc_system_name=\"robot_raconteur"
                           "\",robdef_request=\"get\"}"),
              3609.000068, 1e-6);
}

TEST(Metrics, AreWellFormed) {
  Pair pair(counting());
  auto client = pair.connect();
  client->add(1, 2);
  const OpenMetrics parsed(pair.server.metrics());
  EXPECT_THAT(parsed.faults(), ::testing::IsEmpty());
  EXPECT_GT(parsed.value("process_resident_memory_bytes"), 1024 * 1024);
  EXPECT_GT(parsed.value("process_cpu_seconds_total"), 0);
  EXPECT_EQ(parsed.value("robdef_node_info{node_id=\"" + pair.server.id().text() +
                         "\",node_name=\"metrics.test\",version=\"" +
                         std::string(library_version()) + "\"}"),
            1);
}

TEST(Metrics, CountRequestsByKindAndOutcome) {
  Pair pair(counting());
  auto client = pair.connect();
  for (int i = 0; i < 5; ++i) client->get_value();
  for (int i = 0; i < 3; ++i) client->set_value(i);
  client->add(1, 2);
  EXPECT_THROW(client->raise(static_cast<int>(ErrorCode::out_of_range), "far"), Error);
  client->slow(1);
  client->get_child();
  EXPECT_TRUE(is_soon(pair.server, requests("objref", "ok"), 1));
  const OpenMetrics now(pair.server.metrics());
  EXPECT_EQ(now.value(requests("get", "ok")), 5);
  EXPECT_EQ(now.value(requests("set", "ok")), 3);
  EXPECT_EQ(now.value(requests("call", "ok")), 2);
  EXPECT_EQ(now.value(requests("call", "error")), 1);
  EXPECT_EQ(now.value("robdef_server_errors_total{error_type=\"RobotRaconteur.OutOfRange\"}"), 1);
  EXPECT_EQ(now.value("rpc_server_call_duration_seconds_count{rpc_system_name=\"robot_raconteur\","
                      "robdef_request=\"call\"}"),
            3);
}

// A program may throw any code: those without a name are counted together, and once.
TEST(Metrics, CountErrorsOfAnyCode) {
  Pair pair(counting());
  auto client = pair.connect();
  for (const int code : {77, 300, 65'535, static_cast<int>(ErrorCode::unknown_error)}) {
    EXPECT_THROW(client->raise(code, "x"), Error);
  }
  const OpenMetrics now(pair.server.metrics());
  EXPECT_THAT(now.faults(), ::testing::IsEmpty());
  EXPECT_EQ(now.value("robdef_server_errors_total{error_type=\"RobotRaconteur.UnknownError\"}"), 4);
}

// An answer that is given later counts when it is given, from when the request was taken up.
TEST(Metrics, CountLateAnswersOnce) {
  struct Later final : Counter {
    void slow(Reply<void> reply, std::int32_t /*milliseconds*/) override {
      kept = std::make_unique<Reply<void>>(std::move(reply));
      has_come = true;
    }
    std::unique_ptr<Reply<void>> kept;  // once it has come
    std::atomic<bool> has_come{false};
  };
  const auto object = std::make_shared<Later>();
  Pair pair(counting(), {}, object);
  auto client = pair.connect();
  std::thread caller([&] { client->slow(0); });
  EXPECT_TRUE(eventually([&] { return object->has_come.load(); }));
  EXPECT_EQ(OpenMetrics(pair.server.metrics()).value(requests("call", "ok")), 0);
  (*object->kept)();
  caller.join();
  EXPECT_EQ(OpenMetrics(pair.server.metrics()).value(requests("call", "ok")), 1);
}

TEST(Metrics, CountWireValuesAndSubscribers) {
  WiredPair pair(counting());
  auto client = pair.connect();
  auto level = client->level().connect();
  auto note = client->note().connect();
  for (int i = 1; i <= 10; ++i) pair.object->level().set_in(i);
  EXPECT_TRUE(eventually([&] {
    const auto value = level.try_in();
    return value && value->value == 10;
  }));
  const OpenMetrics now(pair.server.metrics());
  const double sent = now.value("robdef_wire_values_total{outcome=\"sent\"}");
  const double skipped = now.value("robdef_wire_values_total{outcome=\"skipped\"}");
  EXPECT_EQ(sent + skipped, 10);
  EXPECT_GE(sent, 1);
  EXPECT_EQ(now.value("robdef_wire_values_total{outcome=\"dropped\"}"), 0);
  EXPECT_EQ(now.value("robdef_server_wire_connections{robdef_service=\"wired\"}"), 2);
  EXPECT_TRUE(is_soon(pair.server, requests("connect", "ok"), 2));
}

TEST(Metrics, CountPipePacketsSentAndDropped) {
  Node server(counting());
  Node client;
  const auto board = std::make_shared<PipeBoard>();
  const auto service = server.register_service("board", board);
  const auto port = server.listen_tcp(0, "127.0.0.1");
  auto stub = client.connect<PipeBoardStub>("rr+tcp://127.0.0.1:" + std::to_string(port) +
                                            "/?service=board");
  auto end = stub->out().connect();
  for (int i = 0; i < 20; ++i) board->out().send(i);
  EXPECT_TRUE(eventually([&] { return end.available() == 20; }));
  const OpenMetrics now(server.metrics());
  EXPECT_EQ(now.value("robdef_pipe_packets_total{outcome=\"sent\"}"), 20);
  EXPECT_EQ(now.value("robdef_pipe_packets_total{outcome=\"dropped\"}"), 0);
  EXPECT_EQ(now.value("robdef_server_pipe_endpoints{robdef_service=\"board\"}"), 1);
}

TEST(Metrics, CountConnectionsSessionsAndTraffic) {
  Pair pair(counting());
  const auto sessions = [&] {
    return OpenMetrics(pair.server.metrics())
        .value("robdef_server_sessions{robdef_service=\"counter\"}");
  };
  EXPECT_EQ(sessions(), 0);
  auto client = pair.connect();
  const std::string text(100'000, 'x');
  client->echo(text);
  const OpenMetrics now(pair.server.metrics());
  EXPECT_EQ(sessions(), 1);
  EXPECT_GE(now.value("robdef_connections_accepted_total"), 1);
  EXPECT_GT(now.value("robdef_message_bytes_total{direction=\"received\"}"), 100'000);
  EXPECT_GT(now.value("robdef_message_bytes_total{direction=\"sent\"}"), 100'000);
  EXPECT_LT(now.value("robdef_message_bytes_total{direction=\"sent\"}"), 120'000);
  EXPECT_GE(now.value("robdef_server_objects{robdef_service=\"counter\"}"), 1);
  EXPECT_GE(now.value("robdef_threads{state=\"live\"}"), 2);
  EXPECT_EQ(now.value("robdef_budget_limit_bytes{pool=\"before_session\"}"), 8 * 1024 * 1024);
  const double received = now.value("robdef_messages_total{direction=\"received\"}");
  EXPECT_GE(received, 2);
  client.close();
  EXPECT_TRUE(eventually([&] { return sessions() == 0; }));
  // What a connection has counted stays when it has gone.
  EXPECT_TRUE(eventually([&] {
    const OpenMetrics after(pair.server.metrics());
    return after.sum("robdef_connections{") == 0;
  }));
  EXPECT_GE(
      OpenMetrics(pair.server.metrics()).value("robdef_messages_total{direction=\"received\"}"),
      received);
}

TEST(Metrics, CountConnectionsBeyondALimit) {
  NodeOptions options = counting();
  options.max_connections_before_session = 2;
  Node node(options);
  const std::uint16_t port = node.listen_tcp(0, "127.0.0.1");
  const RawSocket first(port);
  const RawSocket second(port);
  const RawSocket third(port);
  EXPECT_EQ(first.receive_all(), "");  // it had to go
  const OpenMetrics now(node.metrics());
  EXPECT_EQ(now.value("robdef_connections_refused_total{reason=\"limit\"}"), 1);
  EXPECT_EQ(now.value("robdef_connections_accepted_total"), 3);
  EXPECT_TRUE(eventually([&] {
    return OpenMetrics(node.metrics())
               .value(
                   "robdef_connections{transport=\"rr+tcp\",role=\"server\","
                   "state=\"no_session\"}") == 2;
  }));
}

TEST(Metrics, CountLogins) {
  Pair pair(counting(), {}, std::make_shared<Counter>(),
            {.users = std::make_shared<PasswordUsers>("bob b177f56968fdfe39a41e06e419013440 _\n")});
  auto bob = pair.connect({.username = "bob", .credentials = {{"password", "builder-2"}}});
  EXPECT_THROW(pair.connect({.username = "bob", .credentials = {{"password", "x"}}}), Error);
  EXPECT_THROW(pair.connect({.username = "eve", .credentials = {{"password", "x"}}}), Error);
  const OpenMetrics now(pair.server.metrics());
  EXPECT_EQ(now.value("robdef_logins_total{outcome=\"allowed\"}"), 1);
  EXPECT_EQ(now.value("robdef_logins_total{outcome=\"refused\"}"), 2);
}

// However many services there are, the text has a limit, and the sums are right.
TEST(Metrics, TextIsBounded) {
  Node node(counting());
  constexpr int count = 300;
  for (int i = 0; i < count; ++i) {
    node.register_service("service" + std::to_string(i), std::make_shared<Counter>());
  }
  const std::string text = node.metrics();
  EXPECT_LT(text.size(), 100'000U);
  const OpenMetrics now(text);
  EXPECT_THAT(now.faults(), ::testing::IsEmpty());
  EXPECT_EQ(now.sum("robdef_server_objects{"), count + 1);  // and the service index
  EXPECT_EQ(now.value("robdef_server_objects{robdef_service=\"\"}"), count + 1 - 100);
}

// Whatever the dashboard shows is there.
TEST(Metrics, AreThoseOfTheDashboard) {
  std::ifstream file(std::string(ROBDEF_SOURCE_DIR) +
                     "/examples/monitoring/grafana_dashboard.json");
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  ASSERT_FALSE(text.empty());
  Pair pair(counting());
  auto client = pair.connect();
  EXPECT_THROW(client->raise(1, "so that there is an error"), Error);
  const std::set<std::string> names = OpenMetrics(pair.server.metrics()).names();
  // Labels begin like metrics, and are followed by what they are compared with.
  const std::regex name(R"re(\b((robdef|rpc|process)_[a-z_]+)\b(?!=|!|,| *\)|, le|\}))re");
  std::set<std::string> shown;
  for (std::sregex_iterator at(text.begin(), text.end(), name), end; at != end; ++at) {
    shown.insert((*at)[1]);
  }
  EXPECT_GE(shown.size(), 15U);
  for (const std::string& each : shown) EXPECT_TRUE(names.contains(each)) << each;
}

TEST(Metrics, AreNotThereUnlessSwitchedOn) {
  const Node node;
  EXPECT_EQ(code_of([&] { static_cast<void>(node.metrics()); }), ErrorCode::invalid_operation);
}

TEST(Metrics, OptionsThatMakeNoSenseAreRefused) {
  for (const char* const place : {"here", "10.0.0.0/33", "10.0.0.0/", "fd00::/129", "10.0.0.5/x"}) {
    EXPECT_EQ(code_of([&] { Node(NodeOptions{.metrics = {.is_enabled = true, .from = {place}}}); }),
              ErrorCode::invalid_argument)
        << place;
  }
  EXPECT_EQ(
      code_of([&] {
        Node(NodeOptions{.web_socket = {.is_enabled = false}, .metrics = {.is_enabled = true}});
      }),
      ErrorCode::invalid_configuration);
}

}  // namespace
}  // namespace rr::testing
