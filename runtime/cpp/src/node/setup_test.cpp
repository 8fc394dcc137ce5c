// SPDX-License-Identifier: Apache-2.0
#include "rr/setup.hpp"

#include <gtest/gtest.h>
#include <stdlib.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "rr/url.hpp"
#include "runtime/cpp/src/node/testing/pair.hpp"

namespace rr {
namespace {

namespace fs = std::filesystem;
using rr::testing::Counter;
using rr::testing::CounterStub;
using rr::testing::error_of;

/// A home of the test's own.
class Setup : public ::testing::Test {
 protected:
  Setup() {
    std::string pattern = (fs::temp_directory_path() / "rr-setup-XXXXXX").string();
    home_ = mkdtemp(pattern.data());
    set("ROBOTRACONTEUR_SYSTEM_PREFIX", home_.string());
    set("ROBOTRACONTEUR_USER_CONFIG_DIR", (home_ / "config").string());
    set("ROBOTRACONTEUR_USER_RUN_DIR", (home_ / "run").string());
  }
  ~Setup() override {
    for (const std::string& name : set_) unsetenv(name.c_str());
    fs::remove_all(home_);
  }

  void set(const std::string& name, const std::string& value) {
    setenv(name.c_str(), value.c_str(), 1);
    set_.push_back(name);
  }
  static SetupOptions taken(SetupOptions options, std::vector<const char*> arguments,
                            std::vector<std::string>* left = nullptr) {
    arguments.insert(arguments.begin(), "program");
    const auto rest = options.take(static_cast<int>(arguments.size()), arguments.data());
    if (left != nullptr) *left = rest;
    return options;
  }
  /// A quiet server: on the loopback interface, without discovery.
  static SetupOptions quiet_server(const std::string& name) {
    SetupOptions options = SetupOptions::server(name, 0);
    options.tcp_listen_localhost = true;
    options.discovery_announce_enable = options.discovery_listening_enable = false;
    return options;
  }
  /// Where the id of a name is kept, whoever runs the test.
  [[nodiscard]] fs::path id_file(const std::string& name) const {
    return geteuid() == 0 ? home_ / "var/lib/robotraconteur/nodeids" / name
                          : home_ / "config/nodeids" / name;
  }
  [[nodiscard]] fs::path lock_file(const std::string& name) const {
    const fs::path run = geteuid() == 0 ? home_ / "var/run/robotraconteur/root" : home_ / "run";
    return run / "nodeids" / (name + ".pid");
  }
  static std::string text_of(const fs::path& file) {
    std::ifstream stream(file);
    std::stringstream text;
    text << stream.rdbuf();
    return text.str();
  }

  fs::path home_;
  std::vector<std::string> set_;
};

TEST_F(Setup, DefaultsAreThoseOfTheRole) {
  const SetupOptions client = SetupOptions::client();
  EXPECT_TRUE(client.discovery_listening_enable);
  EXPECT_FALSE(client.discovery_announce_enable);
  EXPECT_FALSE(client.tcp_start_server);
  EXPECT_TRUE(client.tcp_ipv6_discovery);
  EXPECT_FALSE(client.tcp_ipv4_discovery);
  EXPECT_TRUE(client.disable_stringtable);
  const SetupOptions server = SetupOptions::server("a.node", 6257);
  EXPECT_TRUE(server.discovery_announce_enable && server.tcp_start_server);
  EXPECT_TRUE(server.local_start_server && server.local_server_public);
  EXPECT_TRUE(server.intra_start_server && server.tcp_start_server_sharer);
  EXPECT_EQ(server.tcp_port, 6257);
  EXPECT_TRUE(SetupOptions::secure_server("a.node", 1).require_tls);
}

TEST_F(Setup, FlagsAreTakenOutOfTheArguments) {
  std::vector<std::string> left;
  const SetupOptions options = taken(
      SetupOptions::client(),
      {"first", "--robotraconteur-tcp-port=2355", "--robotraconteur-nodename", "my.node",
       "--robotraconteur-nodeid={11111111-2222-3333-4444-555555555555}",
       "--robotraconteur-tcp-ipv4-discovery=true", "--robotraconteur-local-enable=false",
       "--robotraconteur-jumbo-message", "--robotraconteur-log-level=DEBUG", "--other=1",
       "--robotraconteur-tcp-ws-add-origin=https://a.example", "--", "--robotraconteur-unknown"},
      &left);
  EXPECT_EQ(left,
            (std::vector<std::string>{"first", "--other=1", "--", "--robotraconteur-unknown"}));
  EXPECT_EQ(options.tcp_port, 2355);
  EXPECT_EQ(options.node.name, "my.node");
  EXPECT_EQ(options.node.id.text(), "11111111-2222-3333-4444-555555555555");
  EXPECT_TRUE(options.tcp_ipv4_discovery && options.jumbo_message);
  EXPECT_FALSE(options.local_enable);
  EXPECT_EQ(options.log_level, "debug");
  EXPECT_EQ(options.tcp_ws_add_origin, std::vector<std::string>{"https://a.example"});
}

TEST_F(Setup, EveryFlagThatUsersKnowIsTaken) {
  constexpr std::array switches = {"discovery-listening-enable",
                                   "discovery-announce-enable",
                                   "local-enable",
                                   "tcp-enable",
                                   "hardware-enable",
                                   "intra-enable",
                                   "local-start-server",
                                   "local-start-client",
                                   "local-server-public",
                                   "tcp-start-server",
                                   "tcp-listen-localhost",
                                   "tcp-start-server-sharer",
                                   "tcp-ipv4-discovery",
                                   "tcp-ipv6-discovery",
                                   "intra-start-server",
                                   "disable-timeouts",
                                   "disable-message4",
                                   "disable-stringtable",
                                   "load-tls",
                                   "require-tls",
                                   "local-tap-enable",
                                   "jumbo-message"};
  for (const char* const name : switches) {
    for (const char* const value : {"=true", "=false", "=1", "=0"}) {
      const std::string flag = std::string("--robotraconteur-") + name + value;
      EXPECT_NO_THROW(taken(SetupOptions::client(), {flag.c_str()})) << flag;
    }
    const std::string wrong = std::string("--robotraconteur-") + name + "=maybe";
    EXPECT_EQ(error_of([&] { taken(SetupOptions::client(), {wrong.c_str()}); }).code(),
              ErrorCode::invalid_argument);
  }
  for (const char* const flag :
       {"--robotraconteur-tcp-ws-remove-origin=https://b.example",
        "--robotraconteur-local-tap-name=tap", "--robotraconteur-log-level=FATAL"}) {
    EXPECT_NO_THROW(taken(SetupOptions::client(), {flag})) << flag;
  }
}

TEST_F(Setup, WrongFlagsAreRefused) {
  for (const char* const flag :
       {"--robotraconteur-tcp-prot=1", "--robotraconteur-tcp-port=70000",
        "--robotraconteur-tcp-port=", "--robotraconteur-nodename=1a", "--robotraconteur-nodeid=x",
        "--robotraconteur-log-level=loud", "--robotraconteur-nodename"}) {
    const Error error = error_of([&] { taken(SetupOptions::client(), {flag}); });
    EXPECT_EQ(error.code(), ErrorCode::invalid_argument) << flag;
    EXPECT_NE(error.message().find("--robotraconteur-"), std::string::npos) << error.message();
  }
}

TEST_F(Setup, FlagsWinOverTheEnvironmentAndThatOverTheProgram) {
  set("ROBOTRACONTEUR_TCP_PORT", "1111");
  set("ROBOTRACONTEUR_LOG_LEVEL", "ERROR");
  const SetupOptions options =
      taken(SetupOptions::server("a.node", 3333), {"--robotraconteur-tcp-port=2222"});
  EXPECT_EQ(options.tcp_port, 2222);
  EXPECT_EQ(options.log_level, "error");
  EXPECT_EQ(taken(SetupOptions::server("a.node", 3333), {}).tcp_port, 1111);
}

TEST_F(Setup, AServerKeepsItsIdByItsName) {
  NodeId id;
  {
    const NodeSetup first(quiet_server("kept.node"));
    id = first.node().id();
    EXPECT_EQ(text_of(id_file("kept.node")), id.text_with_braces());
    EXPECT_EQ(text_of(lock_file("kept.node")), std::to_string(getpid()));
    const Error error = error_of([] { NodeSetup second(quiet_server("kept.node")); });
    EXPECT_EQ(error.code(), ErrorCode::invalid_operation);
    EXPECT_NE(error.message().find("kept.node"), std::string::npos);
  }
  const NodeSetup again(quiet_server("kept.node"));
  EXPECT_EQ(again.node().id(), id);
  const NodeSetup other(quiet_server("other.node"));
  EXPECT_NE(other.node().id(), id);
}

TEST_F(Setup, AnIdFileMayHaveBlanksAndMustHoldAnId) {
  fs::create_directories(id_file("a.node").parent_path());
  std::ofstream(id_file("a.node")) << "\n  {11111111-2222-3333-4444-555555555555} \r\n";
  EXPECT_EQ(NodeSetup(quiet_server("a.node")).node().id().text(),
            "11111111-2222-3333-4444-555555555555");
  std::ofstream(id_file("b.node")) << "no id";
  EXPECT_EQ(error_of([] { NodeSetup wrong(quiet_server("b.node")); }).code(),
            ErrorCode::invalid_configuration);
  std::ofstream(id_file("c.node")) << "";
  EXPECT_FALSE(NodeSetup(quiet_server("c.node")).node().id().is_any());
}

TEST_F(Setup, AGivenIdNeedsNoFile) {
  SetupOptions options = quiet_server("a.node");
  options.node.id = NodeId::random();
  const NodeSetup setup(options);
  EXPECT_EQ(setup.node().id(), options.node.id);
  EXPECT_FALSE(fs::exists(id_file("a.node")));
}

TEST_F(Setup, AServerCanBeReachedByItsCandidateUrls) {
  NodeSetup server(quiet_server("a.node"));
  server->register_service("counter", std::make_shared<Counter>());
  std::ostringstream out;
  print_candidate_urls(out, server.node(), "counter");
  std::istringstream lines(out.str());
  std::string url;
  SetupOptions quiet = SetupOptions::client();
  quiet.discovery_listening_enable = false;
  NodeSetup client(quiet);
  int count = 0;
  while (std::getline(lines, url)) {
    if (!url.starts_with("rr+tcp://")) continue;
    EXPECT_EQ(Url::parse(url).port, server.port());
    EXPECT_EQ(client->connect<CounterStub>(url)->add(1, 2), 3);
    ++count;
  }
  EXPECT_GE(count, 1);
}

TEST_F(Setup, TlsThatIsRequiredIsNotLeftOut) {
  SetupOptions options = quiet_server("a.node");
  options.load_tls = options.require_tls = true;  // and there is no certificate
  EXPECT_EQ(error_of([&] { NodeSetup setup(options); }).code(), ErrorCode::invalid_configuration);
}

TEST_F(Setup, PublicLocalSocketsAreTheUsersOwnWhereThereIsNoFolder) {
  SetupOptions options = quiet_server("a.local.node");
  options.local_server_public = true;
  NodeSetup server(options);
  server->register_service("counter", std::make_shared<Counter>());
  Node client;
  const auto url = "rr+local:///?nodename=a.local.node&service=counter";
  EXPECT_EQ(client.connect<CounterStub>(url)->add(1, 2), 3);
}

TEST_F(Setup, DisabledThingsAreNotOffered) {
  SetupOptions options = quiet_server("a.node");
  options.disable_timeouts = options.disable_message4 = options.jumbo_message = true;
  NodeSetup server(options);
  server->register_service("counter", std::make_shared<Counter>());
  Node client;
  const auto url = server->candidate_urls("counter").front();
  EXPECT_EQ(client.connect<CounterStub>(url)->add(1, 2), 3);
}

}  // namespace
}  // namespace rr
