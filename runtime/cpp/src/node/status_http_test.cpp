// SPDX-License-Identifier: Apache-2.0
// `GET /metrics` and `GET /health` at a node's port: who may ask, and what is answered.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "runtime/cpp/src/channel/metrics_text.hpp"
#include "runtime/cpp/src/channel/status.hpp"
#include "runtime/cpp/src/channel/status_page.hpp"
#include "runtime/cpp/src/node/testing/open_metrics.hpp"
#include "runtime/cpp/src/node/testing/pair.hpp"
#include "runtime/cpp/src/node/testing/raw_socket.hpp"

namespace rr::testing {
namespace {

using ::testing::AllOf;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

class StatusHttp : public ::testing::Test {
 protected:
  Node node{NodeOptions{.metrics = {.is_enabled = true}}};
  const std::uint16_t port = node.listen_tcp(0, "127.0.0.1");
  const std::string here = "127.0.0.1:" + std::to_string(port);

  [[nodiscard]] std::string ask(const std::string& path, const std::string& more = "",
                                const std::string& method = "GET") const {
    const RawSocket peer(port);
    peer.send(method + " " + path + " HTTP/1.1\r\nHost: " + here + "\r\n" + more + "\r\n");
    std::string head = peer.receive_until("\r\n\r\n");
    const std::size_t at = head.find("Content-Length: ");
    if (at == std::string::npos) return head;
    const std::size_t length = std::stoul(head.substr(at + 16));
    std::string all = head;
    const std::size_t whole = head.find("\r\n\r\n") + 4 + length;
    while (all.size() < whole) {
      const std::string part = peer.receive_until("\n");
      if (part.empty()) break;
      all += part;
    }
    return all;
  }
};

TEST_F(StatusHttp, MetricsAreOpenMetricsText) {
  const std::string answer = ask("/metrics");
  EXPECT_THAT(answer,
              AllOf(StartsWith("HTTP/1.1 200 OK\r\nContent-Type: application/openmetrics-text; "
                               "version=1.0.0; charset=utf-8\r\n"),
                    HasSubstr("\r\nX-Content-Type-Options: nosniff\r\n"),
                    HasSubstr("\r\nCross-Origin-Resource-Policy: same-origin\r\n"),
                    HasSubstr("\r\nConnection: close\r\n"), Not(HasSubstr("Access-Control")),
                    EndsWith("# EOF\n")));
  const OpenMetrics parsed(answer.substr(answer.find("\r\n\r\n") + 4));
  EXPECT_THAT(parsed.faults(), ::testing::IsEmpty());
  // The one that asks.
  EXPECT_EQ(parsed.value("robdef_connections{transport=\"rr+ws\",role=\"server\","
                         "state=\"no_session\"}"),
            1);
  EXPECT_THAT(ask("/metrics?name=x"), StartsWith("HTTP/1.1 200 "));
}

TEST_F(StatusHttp, HealthSaysWhatIsWrong) {
  EXPECT_THAT(ask("/health"), AllOf(StartsWith("HTTP/1.1 200 OK\r\n"),
                                    HasSubstr("\r\nContent-Type: application/json\r\n"),
                                    EndsWith("\r\n\r\n{\"status\":\"ok\"}\n")));
  node.set_fault("the \"arm\" is\nhot");
  EXPECT_THAT(ask("/health"),
              AllOf(StartsWith("HTTP/1.1 503 "),
                    EndsWith("{\"status\":\"fault\",\"why\":\"the \\\"arm\\\" is\\u000ahot\"}\n")));
  node.set_fault("");
  EXPECT_THAT(ask("/health"), StartsWith("HTTP/1.1 200 OK\r\n"));
}

TEST_F(StatusHttp, OtherMethodsAreNotAllowed) {
  for (const char* const method : {"POST", "PUT", "DELETE", "HEAD", "OPTIONS", "PATCH"}) {
    EXPECT_THAT(ask("/metrics", "", method),
                AllOf(StartsWith("HTTP/1.1 405 "), HasSubstr("\r\nAllow: GET\r\n"),
                      Not(HasSubstr("robdef_"))))
        << method;
  }
  EXPECT_THAT(ask("/other"), StartsWith("HTTP/1.1 404 "));
  EXPECT_THAT(ask("/metrics/"), StartsWith("HTTP/1.1 404 "));
  EXPECT_THAT(ask("/"), StartsWith("HTTP/1.1 426 "));
}

TEST_F(StatusHttp, APageOfTheWebDoesNotReadIt) {
  for (const char* const more :
       {"Origin: https://evil.example\r\n", "Origin: null\r\n", "Sec-Fetch-Site: cross-site\r\n",
        "Sec-Fetch-Site: same-site\r\n", "Origin: \r\n"}) {
    EXPECT_THAT(ask("/metrics", more),
                AllOf(StartsWith("HTTP/1.1 403 "), Not(HasSubstr("robdef_"))))
        << more;
  }
  EXPECT_THAT(ask("/metrics", "Sec-Fetch-Site: none\r\n"), StartsWith("HTTP/1.1 200 "));
  // One whose name points here.
  for (const char* const host : {"evil.example", "localhost.evil.example", "", "*"}) {
    const RawSocket peer(port);
    peer.send("GET /metrics HTTP/1.1\r\nHost: " + std::string(host) + "\r\n\r\n");
    EXPECT_THAT(peer.receive_until("\r\n\r\n"), StartsWith("HTTP/1.1 421 ")) << host;
  }
}

TEST_F(StatusHttp, IsNotThereUnlessSwitchedOn) {
  Node plain;
  const std::uint16_t its_port = plain.listen_tcp(0, "127.0.0.1");
  for (const char* const path : {"/metrics", "/health"}) {
    const RawSocket peer(its_port);
    peer.send("GET " + std::string(path) + " HTTP/1.1\r\nHost: localhost\r\n\r\n");
    EXPECT_THAT(peer.receive_until("\r\n\r\n"), StartsWith("HTTP/1.1 404 ")) << path;
  }
}

TEST_F(StatusHttp, IsHeldByAFewConnectionsAtOnce) {
  std::vector<std::unique_ptr<RawSocket>> held;
  const auto take = [&] {
    held.push_back(std::make_unique<RawSocket>(port));
    held.back()->send("GET /health HTTP/1.1\r\nHost: " + here + "\r\n\r\n");
    return held.back()->receive_until("\r\n\r\n");
  };
  for (int i = 0; i < 8; ++i) EXPECT_THAT(take(), StartsWith("HTTP/1.1 200 ")) << i;
  EXPECT_THAT(take(), StartsWith("HTTP/1.1 503 "));
  held.clear();
  EXPECT_TRUE(eventually([&] {
    const bool is_answered = take().starts_with("HTTP/1.1 200 ");
    held.clear();
    return is_answered;
  }));
}

TEST_F(StatusHttp, ClientsConnectAsBefore) {
  node.register_service("counter", std::make_shared<Counter>());
  Node client;
  for (const char* const scheme : {"rr+tcp://", "rr+ws://"}) {
    EXPECT_EQ(client.connect<CounterStub>(scheme + here + "/?service=counter")->add(1, 2), 3);
  }
}

// What no peer on the loopback interface can show.
TEST(StatusPage, KeepsOutWhoeverIsNotNamed) {
  const auto status_of = [](const MetricsOptions& options, const std::string& from) {
    channel::Status status(options);
    const auto page = channel::status_page(
        status, {.method = "GET", .path = "/metrics", .host = "10.0.0.1:5", .from = from}, {});
    return page ? page->status : 0U;
  };
  EXPECT_EQ(status_of({}, "127.0.0.1"), 200U);
  EXPECT_EQ(status_of({}, "127.9.9.9"), 200U);
  EXPECT_EQ(status_of({}, "::1"), 200U);
  EXPECT_EQ(status_of({}, "10.0.0.5"), 403U);
  EXPECT_EQ(status_of({}, ""), 403U);
  EXPECT_EQ(status_of({}, "uid 0"), 403U);
  const MetricsOptions some{.from = {"10.0.0.5", "192.168.8.0/21", "fd00::/8"}};
  EXPECT_EQ(status_of(some, "10.0.0.5"), 200U);
  EXPECT_EQ(status_of(some, "10.0.0.6"), 403U);
  EXPECT_EQ(status_of(some, "192.168.15.255"), 200U);
  EXPECT_EQ(status_of(some, "192.168.16.0"), 403U);
  EXPECT_EQ(status_of(some, "fdff::1"), 200U);
  EXPECT_EQ(status_of(some, "fe80::1%eth0"), 403U);
  EXPECT_EQ(status_of(some, "::1"), 200U);
  EXPECT_EQ(status_of({.from = {"fe80::/10"}}, "fe80::1%eth0"), 200U);
  EXPECT_EQ(status_of({.from = {"0.0.0.0/0"}}, "8.8.8.8"), 200U);
  EXPECT_EQ(status_of({.from = {"0.0.0.0/0"}}, "2001::1"), 403U);
  EXPECT_EQ(status_of({.from = {"*"}}, "2001::1"), 200U);
}

TEST(StatusPage, IsAskedByNamesOfThisMachine) {
  channel::Status status({.hosts = {"Robot1.Lab.Example"}});
  const auto status_at = [&](const std::string& host) {
    return channel::status_page(
               status, {.method = "GET", .path = "/health", .host = host, .from = "::1"}, {})
        ->status;
  };
  EXPECT_EQ(status_at("robot1.lab.example:6000"), 200U);
  EXPECT_EQ(status_at("robot2.lab.example"), 421U);
  EXPECT_EQ(status_at("localhost"), 200U);
}

TEST(StatusPage, IsNotGivenInClearWhereTlsIsRequired) {
  channel::Status status({});
  const auto page = channel::status_page(status,
                                         {.method = "GET",
                                          .path = "/metrics",
                                          .host = "localhost",
                                          .from = "127.0.0.1",
                                          .may_be_clear = false},
                                         {});
  EXPECT_EQ(page->status, 403U);
}

}  // namespace
}  // namespace rr::testing
