// SPDX-License-Identifier: Apache-2.0
// A Prometheus, where one is installed, scrapes a node, and knows what the node has counted.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <string>
#include <vector>

#include "runtime/cpp/src/node/testing/pair.hpp"
#include "runtime/cpp/src/node/testing/raw_socket.hpp"

namespace rr::testing {
namespace {

constexpr const char* program = "/usr/bin/prometheus";

/// A port that nobody had a moment ago.
std::uint16_t free_port() {
  Node node;
  return node.listen_tcp(0, "127.0.0.1");
}

class Prometheus {
 public:
  Prometheus(const std::string& folder, std::uint16_t target) : port_(free_port()) {
    std::filesystem::create_directories(folder);
    std::ofstream(folder + "/prometheus.yml")
        << "global: {scrape_interval: 200ms, scrape_timeout: 200ms}\n"
        << "scrape_configs: [{job_name: robots, static_configs: [{targets: ['127.0.0.1:" << target
        << "']}]}]\n";
    const std::vector<std::string> arguments = {
        program, "--config.file=" + folder + "/prometheus.yml", "--storage.tsdb.path=" + folder,
        "--web.listen-address=127.0.0.1:" + std::to_string(port_), "--log.level=error"};
    std::vector<char*> words;
    for (const std::string& argument : arguments) {
      words.push_back(const_cast<char*>(argument.c_str()));
    }
    words.push_back(nullptr);
    process_ = fork();
    if (process_ != 0) return;
    execv(program, words.data());
    _exit(127);
  }
  ~Prometheus() {
    kill(process_, SIGTERM);
    waitpid(process_, nullptr, 0);
  }
  Prometheus(const Prometheus&) = delete;
  Prometheus& operator=(const Prometheus&) = delete;

  /// The value of a query with one result; empty when there is none.
  [[nodiscard]] std::string ask(const std::string& query) const {
    std::string encoded;
    for (const char c : query) {
      constexpr std::string_view digits = "0123456789ABCDEF";
      const auto byte = static_cast<unsigned char>(c);
      if (std::isalnum(byte) != 0 || c == '_') {
        encoded += c;
      } else {
        encoded += {'%', digits[byte >> 4], digits[byte & 15]};
      }
    }
    const RawSocket peer(port_);
    peer.send("GET /api/v1/query?query=" + encoded +
              " HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n");
    const std::string answer = peer.receive_all();
    static const std::regex value(R"re("value":\[[0-9.]+,"([^"]+)"\])re");
    std::smatch match;
    return std::regex_search(answer, match, value) ? match[1].str() : std::string();
  }

 private:
  const std::uint16_t port_;
  pid_t process_ = -1;
};

TEST(Prometheus, KnowsWhatANodeHasCounted) {
  if (access(program, X_OK) != 0) GTEST_SKIP() << "Prometheus is not installed";
  Node node({.name = "scraped.node", .metrics = {.is_enabled = true}});
  node.register_service("counter", std::make_shared<Counter>());
  const std::uint16_t port = node.listen_tcp(0, "127.0.0.1");
  Node client;
  auto counter = client.connect<CounterStub>("rr+tcp://127.0.0.1:" + std::to_string(port) +
                                             "/?service=counter");
  for (int i = 0; i < 7; ++i) counter->add(i, 1);
  EXPECT_THROW(counter->raise(static_cast<int>(ErrorCode::out_of_range), "far"), Error);

  const Prometheus prometheus(test_folder() + "/prometheus", port);
  ASSERT_TRUE(eventually([&] { return prometheus.ask("up") == "1"; }));
  const auto value_of = [&](const std::string& query) { return prometheus.ask(query); };
  EXPECT_TRUE(eventually([&] {
    return value_of(R"(robdef_server_requests_total{robdef_request="call",outcome="ok"})") == "7";
  }));
  EXPECT_EQ(value_of(R"(robdef_server_requests_total{robdef_request="call",outcome="error"})"),
            "1");
  EXPECT_EQ(value_of(R"(robdef_server_errors_total{error_type="RobotRaconteur.OutOfRange"})"), "1");
  EXPECT_EQ(value_of(R"(rpc_server_call_duration_seconds_count{robdef_request="call"})"), "8");
  EXPECT_EQ(value_of(R"(rpc_server_call_duration_seconds_bucket{robdef_request="call",le="+Inf"})"),
            "8");
  EXPECT_EQ(value_of(R"(robdef_server_sessions{robdef_service="counter"})"), "1");
  EXPECT_EQ(value_of(R"(count(robdef_node_info{node_name="scraped.node"}))"), "1");
  // Counters go on: it scrapes again and again.
  counter->add(1, 1);
  EXPECT_TRUE(eventually([&] {
    return value_of(R"(robdef_server_requests_total{robdef_request="call",outcome="ok"})") == "8";
  }));
}

}  // namespace
}  // namespace rr::testing
