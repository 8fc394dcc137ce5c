// SPDX-License-Identifier: Apache-2.0
// Certificates, authorities and lists of revoked certificates that change while a node runs.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <future>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "rr/authority.hpp"
#include "runtime/cpp/src/node/testing/pair.hpp"
#include "runtime/cpp/src/platform/files.hpp"

namespace rr::testing {
namespace {

using ::testing::AnyOf;
using ::testing::HasSubstr;

namespace fs = std::filesystem;

// A session of a client, and why it has ended.
class Session {
 public:
  Session(Node& node, const std::string& url) : reason_(ended_->get_future()) {
    ConnectOptions options;
    options.on_closed = [ended = ended_](const Error& why) { ended->set_value(why.message()); };
    client = node.connect<CounterStub>(url, std::move(options));
  }
  // Empty when it goes on.
  std::string end(std::chrono::milliseconds limit = std::chrono::seconds(20)) {
    if (reason_.wait_for(limit) != std::future_status::ready) return {};
    return reason_.get();
  }

  Client<CounterStub> client;

 private:
  std::shared_ptr<std::promise<std::string>> ended_ = std::make_shared<std::promise<std::string>>();
  std::future<std::string> reason_;
};

class TlsWhileANodeRuns : public ::testing::Test {
 protected:
  static constexpr std::chrono::milliseconds period{50};

  TlsWhileANodeRuns() {
    static int count = 0;
    folder = test_folder() + "/running" + std::to_string(count++);
    authority = std::make_unique<Authority>(Authority::create(folder + "/ca"));
    fs::copy(authority->certificate_file(), folder + "/trusted.pem");
    server_options = options_of(NodeId::random());
    server_options.log = [this](LogLevel level, std::string_view text) {
      const std::lock_guard lock(log_mutex);
      log.push_back((level == LogLevel::error     ? "error: "
                     : level == LogLevel::warning ? "warning: "
                                                  : "") +
                    std::string(text));
    };
    server_options.tls.must_certify_clients = true;
    client_options = options_of(NodeId::random());
  }

  NodeOptions options_of(const NodeId& id) {
    NodeOptions options;
    options.id = id;
    options.tls.certificate_file = authority->issue(id);
    options.tls.authority_files = {folder + "/trusted.pem"};
    options.tls.revocation_files = {authority->revocation_file()};
    options.tls.look_again_period = period;
    return options;
  }
  void start() {
    server = std::make_unique<Node>(server_options);
    server->register_service("counter", std::make_shared<Counter>());
    url = "rrs+tcp://127.0.0.1:" + std::to_string(server->listen_tcp(0, "127.0.0.1")) +
          "/?service=counter";
    client = std::make_unique<Node>(client_options);
  }
  // At once: a file that is written in place is empty for a moment, which is logged as well.
  static void replace(const std::string& file, const std::string& text) {
    std::ofstream(file + ".new") << text;
    ASSERT_FALSE(platform::rename_file(file + ".new", file));
  }
  std::string refusal() {
    return error_of([&] { client->connect<CounterStub>(url); }).message();
  }
  std::vector<std::string> logged() {
    const std::lock_guard lock(log_mutex);
    return log;
  }
  std::size_t times_logged(const std::string& text) {
    std::size_t count = 0;
    for (const std::string& line : logged()) count += line.find(text) != std::string::npos ? 1 : 0;
    return count;
  }

  std::string folder;
  std::unique_ptr<Authority> authority;
  NodeOptions server_options;
  NodeOptions client_options;
  std::mutex log_mutex;
  std::vector<std::string> log;
  std::unique_ptr<Node> server;
  std::unique_ptr<Node> client;
  std::string url;
};

TEST_F(TlsWhileANodeRuns, ItUsesARenewedCertificateForNewConnections) {
  start();
  Session before(*client, url);
  authority->renew(server_options.id, Authority::RenewedKey::another);
  authority->revoke_earlier(server_options.id);
  EXPECT_EQ(client->connect<CounterStub>(url)->add(1, 2), 3);
  // As a client as well.
  authority->renew(client_options.id);
  authority->revoke_earlier(client_options.id);
  EXPECT_EQ(client->connect<CounterStub>(url)->add(1, 2), 3);
  // That one has shown the old certificates of both. Whoever looks first ends it.
  EXPECT_THAT(before.end(), AnyOf(HasSubstr("revoked"), HasSubstr("closed the connection")));
}

TEST_F(TlsWhileANodeRuns, ItEndsTheSessionsOfARevokedClient) {
  start();
  Session session(*client, url);
  Node other_client(options_of(NodeId::random()));
  Session other(other_client, url);
  EXPECT_EQ(session.client->add(1, 2), 3);
  const auto begin = std::chrono::steady_clock::now();
  authority->revoke(client_options.id);
  EXPECT_NE(session.end(), "");
  const auto time = std::chrono::steady_clock::now() - begin;
  EXPECT_TRUE(eventually([&] {
    return times_logged("the connection with node " + client_options.id.text() +
                        " was closed: the other side's certificate has been revoked") == 1;
  }));
  EXPECT_EQ(other.client->add(1, 2), 3);
  EXPECT_THAT(refusal(), HasSubstr("revoked"));
  RecordProperty(
      "milliseconds_until_the_end",
      static_cast<int>(std::chrono::duration_cast<std::chrono::milliseconds>(time).count()));
}

TEST_F(TlsWhileANodeRuns, AClientLeavesARevokedService) {
  start();
  Session session(*client, url);
  authority->revoke(server_options.id);
  EXPECT_THAT(session.end(), HasSubstr("the other side's certificate has been revoked"));
}

TEST_F(TlsWhileANodeRuns, SessionsByWebSocketsEndToo) {
  start();
  const std::string rest = url.substr(url.find(':'));
  Session web(*client, "rr+wss" + rest);
  Session inside(*client, "rrs+ws" + rest);
  authority->revoke(server_options.id);
  EXPECT_THAT(web.end(), HasSubstr("has been revoked"));
  EXPECT_THAT(inside.end(), HasSubstr("has been revoked"));
}

TEST_F(TlsWhileANodeRuns, ItEndsSessionsWhoseAuthorityIsTrustedNoMore) {
  fs::copy(authority->certificate_file(), folder + "/of_client.pem");
  client_options.tls.authority_files = {folder + "/of_client.pem"};
  start();
  Session session(*client, url);
  Authority other = Authority::create(folder + "/other");
  fs::copy(other.certificate_file(), folder + "/new.pem");
  ASSERT_FALSE(platform::rename_file(folder + "/new.pem", folder + "/of_client.pem"));
  EXPECT_THAT(session.end(), HasSubstr("authority that this node does not trust"));
  EXPECT_THAT(refusal(), HasSubstr("authority"));
}

TEST_F(TlsWhileANodeRuns, ItKeepsSessionsWhenNothingIsWrong) {
  start();
  Session session(*client, url);
  authority->refresh();  // another list, which says the same
  authority->renew(server_options.id);
  EXPECT_EQ(session.end(10 * period), "");
  EXPECT_EQ(session.client->add(1, 2), 3);
}

TEST_F(TlsWhileANodeRuns, AFileThatCannotBeUsedLeavesTheOldOneInUse) {
  start();
  Session session(*client, url);
  authority->revoke(client_options.id);
  EXPECT_NE(session.end(), "");
  const std::string good = folder + "/good";
  fs::copy(authority->revocation_file(), good);
  replace(authority->revocation_file(), "no list\n");
  replace(server_options.tls.certificate_file, "no certificate\n");
  EXPECT_TRUE(eventually([&] {
    return times_logged("has no list of revoked certificates; what was read before stays in use") ==
               1 &&
           times_logged("has no certificate; what was read before stays in use") == 1;
  }));
  // The list that was read before counts still, and the certificate serves others.
  EXPECT_THAT(refusal(), HasSubstr("revoked"));
  ASSERT_FALSE(platform::rename_file(good, authority->revocation_file()));
  Node other(options_of(NodeId::random()));
  EXPECT_EQ(other.connect<CounterStub>(url)->add(1, 2), 3);
  std::this_thread::sleep_for(5 * period);
  EXPECT_EQ(times_logged("has no certificate"), 1U);
}

TEST_F(TlsWhileANodeRuns, ACertificateOfAnotherNodeIsNotTaken) {
  start();
  const std::string other = authority->issue(NodeId::random());
  fs::remove(server_options.tls.certificate_file);
  fs::copy(other, server_options.tls.certificate_file);
  EXPECT_EQ(client->connect<CounterStub>(url)->add(1, 2), 3);
  EXPECT_TRUE(eventually([&] { return times_logged("the certificate is of node ") == 1; }));
}

TEST_F(TlsWhileANodeRuns, AListThatHasRunOutLetsNobodyInAndEndsNothing) {
  start();
  Session session(*client, url);
  authority->refresh(Authority::Days(-1));
  EXPECT_THAT(refusal(), HasSubstr("the list of revoked certificates has run out"));
  EXPECT_EQ(session.end(6 * period), "");
  EXPECT_EQ(session.client->add(1, 2), 3);
  EXPECT_TRUE(eventually([&] {
    return times_logged("error: the list of revoked certificates has run out, on 20") == 1;
  }));
  authority->refresh(Authority::Days(7));
  EXPECT_EQ(client->connect<CounterStub>(url)->add(1, 2), 3);
}

TEST_F(TlsWhileANodeRuns, AListThatHasRunOutIsUsedWhereThatIsWanted) {
  server_options.tls.accepts_outdated_lists = true;
  client_options.tls.accepts_outdated_lists = true;
  authority->refresh(Authority::Days(-1));
  start();
  EXPECT_EQ(client->connect<CounterStub>(url)->add(1, 2), 3);
  EXPECT_TRUE(eventually([&] { return times_logged("it is used all the same") == 1; }));
  authority->revoke(client_options.id);
  EXPECT_THAT(refusal(), HasSubstr("revoked"));
}

TEST_F(TlsWhileANodeRuns, ItSaysWhenItsCertificateRunsOut) {
  authority->issue(server_options.id, Authority::Days(-1));
  start();
  EXPECT_THAT(refusal(), HasSubstr("has expired"));
  EXPECT_TRUE(eventually([&] { return times_logged("this node's certificate has run out") == 1; }))
      << ::testing::PrintToString(logged());
}

}  // namespace
}  // namespace rr::testing
