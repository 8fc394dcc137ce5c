// SPDX-License-Identifier: Apache-2.0
#include "rr/setup.hpp"

#include <gtest/gtest.h>
#include <stdlib.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "rr/authority.hpp"
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
  EXPECT_TRUE(client.tcp_listen_localhost && server.tcp_listen_localhost);
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
                                   "local-shared-memory",
                                   "tcp-start-server",
                                   "tcp-listen-localhost",
                                   "tcp-start-server-sharer",
                                   "tcp-ipv4-discovery",
                                   "tcp-ipv6-discovery",
                                   "tcp-ws-allow-local-pages",
                                   "tls-trust-system-authorities",
                                   "intra-start-server",
                                   "disable-timeouts",
                                   "disable-message4",
                                   "disable-stringtable",
                                   "load-tls",
                                   "require-tls",
                                   "local-tap-enable",
                                   "web-inspector",
                                   "metrics",
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
        "--robotraconteur-tls-certificate=a.pem", "--robotraconteur-tls-key=a.key",
        "--robotraconteur-tls-authority=ca.pem", "--robotraconteur-tls-revocation=revoked.pem",
        "--robotraconteur-local-tap-name=tap", "--robotraconteur-web-inspector-page=page.html",
        "--robotraconteur-log-level=FATAL", "--robotraconteur-log-format=logfmt",
        "--robotraconteur-log-file=node.log", "--robotraconteur-log-file-size=1",
        "--robotraconteur-log-file-count=0", "--robotraconteur-metrics-from=10.0.0.5",
        "--robotraconteur-metrics-host=a.example"}) {
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

TEST_F(Setup, AFileComesBeforeTheEnvironmentAndFlags) {
  const fs::path file = home_ / "node.conf";
  std::ofstream(file) << "# of the camera\n\n  tcp-port = 1000\n\tlog-level=info\r\n"
                      << "nodename = camera.host\nmetrics = true\nmetrics-from = 10.0.0.5\n"
                      << "metrics-from = fd00::/8\ntls-key = /etc/a b#c.key\njumbo-message = 1\n";
  const std::string flag = "--robotraconteur-config=" + file.string();
  const SetupOptions options = taken(SetupOptions::server("a.node", 3333), {flag.c_str()});
  EXPECT_EQ(options.tcp_port, 1000);
  EXPECT_EQ(options.log_level, "info");
  EXPECT_EQ(options.node.name, "camera.host");
  EXPECT_EQ(options.tls_key, "/etc/a b#c.key");
  EXPECT_TRUE(options.metrics && options.jumbo_message);
  EXPECT_EQ(options.metrics_from, (std::vector<std::string>{"10.0.0.5", "fd00::/8"}));

  set("ROBOTRACONTEUR_TCP_PORT", "2000");
  EXPECT_EQ(taken(SetupOptions::client(), {flag.c_str()}).tcp_port, 2000);
  EXPECT_EQ(taken(SetupOptions::client(),
                  {"--robotraconteur-tcp-port=3000", "--robotraconteur-config", file.c_str()})
                .tcp_port,
            3000);
  set("ROBOTRACONTEUR_CONFIG", file.string());
  EXPECT_EQ(taken(SetupOptions::client(), {}).node.name, "camera.host");
  EXPECT_EQ(taken(SetupOptions::client(), {"--", "--robotraconteur-config=/nowhere"}).node.name,
            "camera.host");
}

TEST_F(Setup, AFileThatIsWrongIsRefusedWithItsLine) {
  const fs::path file = home_ / "node.conf";
  const auto refusal = [&](const std::string& text) {
    std::ofstream(file) << text;
    const std::string flag = "--robotraconteur-config=" + file.string();
    const Error error = error_of([&] { taken(SetupOptions::client(), {flag.c_str()}); });
    EXPECT_EQ(error.code(), ErrorCode::invalid_configuration) << text;
    const std::string& message = error.message();
    const std::size_t at = message.find("node.conf:");
    return at == std::string::npos ? message : message.substr(at);
  };
  EXPECT_EQ(refusal("tcp-port = 1\n\ntcp-prot = 2\n"),
            "node.conf:3: there is no setting `tcp-prot`");
  EXPECT_EQ(refusal("tcp-port = 70000"), "node.conf:1: `70000` is no value for `tcp-port`");
  EXPECT_EQ(refusal("metrics = maybe\n"), "node.conf:1: `maybe` is no value for `metrics`");
  EXPECT_EQ(refusal("metrics\n"), "node.conf:1: `metrics` is no `name = value`");
  EXPECT_EQ(refusal(" = 1\n"), "node.conf:1: `= 1` is no `name = value`");
  EXPECT_EQ(refusal("config = other.conf\n"), "node.conf:1: there is no setting `config`");
  EXPECT_NE(refusal(std::string(70'000, '#')).find("64 KiB"), std::string::npos);
  EXPECT_EQ(error_of([&] {
              taken(SetupOptions::client(), {"--robotraconteur-config=/nowhere/node.conf"});
            }).code(),
            ErrorCode::invalid_configuration);
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

TEST_F(Setup, AServerIsForThisMachineUnlessToldOtherwise) {
  const auto hosts_of = [](const NodeSetup& setup) {
    std::set<std::string> hosts;
    for (const std::string& url : setup->urls("any")) {
      if (url.starts_with("rr+tcp://")) hosts.insert(Url::parse(url).host);
    }
    return hosts;
  };
  SetupOptions options = SetupOptions::server("a.node", 0);
  options.discovery_announce_enable = options.discovery_listening_enable = false;
  const NodeSetup usual(options);
  for (const std::string& host : hosts_of(usual)) {
    EXPECT_TRUE(host == "127.0.0.1" || host == "::1") << host;
  }
  EXPECT_TRUE(hosts_of(usual).contains("127.0.0.1"));
  options.node.name = "b.node";
  const std::array arguments = {"program", "--robotraconteur-tcp-listen-localhost=false"};
  const NodeSetup open(options, arguments.size(), arguments.data());
  EXPECT_TRUE(hosts_of(open).contains("0.0.0.0"));
  Node node;
  const std::string port = std::to_string(node.listen_tcp(0));
  for (const std::string& url : node.urls("any")) {
    EXPECT_TRUE(url.starts_with("rr+tcp://127.0.0.1:" + port) ||
                url.starts_with("rr+tcp://[::1]:" + port))
        << url;
  }
}

TEST_F(Setup, AServerSaysOnceWhereItListens) {
  SetupOptions options = quiet_server("a.node");
  std::string port;
  ::testing::internal::CaptureStderr();
  {
    const NodeSetup setup(options);
    port = std::to_string(setup.port());
  }
  EXPECT_EQ(::testing::internal::GetCapturedStderr(),
            "robotraconteur: listens at port " + port +
                " of the loopback interface; --robotraconteur-tcp-listen-localhost=false opens it "
                "to other machines\n");
  options.log_level = "error";
  ::testing::internal::CaptureStderr();
  { const NodeSetup setup(options); }
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
  std::vector<std::string> lines;
  std::mutex mutex;
  options.node.log = [&](LogLevel level, std::string_view text) {
    if (!text.starts_with("listens at")) return;
    EXPECT_EQ(level, LogLevel::info);
    const std::lock_guard lock(mutex);
    lines.emplace_back(text);
  };
  options.tcp_listen_localhost = false;
  { const NodeSetup setup(options); }
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_NE(lines[0].find("of all interfaces; "), std::string::npos);
}

/// With an authority, and certificates of it.
class SetupWithTls : public Setup {
 protected:
  SetupWithTls() : authority_(Authority::create((home_ / "ca").string())) {}

  static Error failure_of(const SetupOptions& options) {
    return error_of([&] { NodeSetup setup(options); });
  }
  static SetupOptions secure(const std::string& name) {
    SetupOptions options = quiet_server(name);
    options.load_tls = options.require_tls = true;
    return options;
  }
  // That a client which trusts the authority reaches it, and only with TLS.
  void expect_served(NodeSetup& setup) const {
    setup->register_service("counter", std::make_shared<Counter>());
    SetupOptions asking = SetupOptions::client();
    asking.discovery_listening_enable = false;
    asking.require_tls = true;
    asking.tls_authority = {authority_.certificate_file()};
    NodeSetup client(asking);
    const std::string at = "127.0.0.1:" + std::to_string(setup.port()) + "/?service=counter";
    EXPECT_EQ(client->connect<CounterStub>("rrs+tcp://" + at)->add(1, 2), 3);
    Node plain;
    EXPECT_NE(error_of([&] { plain.connect<CounterStub>("rr+tcp://" + at); }).code(),
              ErrorCode::none);
  }
  Authority authority_;
};

TEST_F(SetupWithTls, LoadTlsWithoutACertificateIsAnError) {
  for (SetupOptions options : {quiet_server("a.node"), SetupOptions::client()}) {
    options.discovery_listening_enable = false;
    options.load_tls = true;  // and does not require it
    const Error error = failure_of(options);
    EXPECT_EQ(error.code(), ErrorCode::invalid_configuration);
    EXPECT_NE(error.message().find("tls-certificate"), std::string::npos) << error.message();
  }
  SetupOptions missing = secure("a.node");
  missing.tls_certificate = (home_ / "none.pem").string();
  EXPECT_EQ(failure_of(missing).code(), ErrorCode::invalid_configuration);
}

TEST_F(SetupWithTls, FlagsGiveTheCertificateAndItsNodeIsTheNode) {
  {
    const NodeSetup before(quiet_server("a.node"));  // whose id is kept from now on
  }
  const NodeId id = NodeId::random();
  const std::string certificate = "--robotraconteur-tls-certificate=" + authority_.issue(id);
  const std::string trusted = "--robotraconteur-tls-authority=" + authority_.certificate_file();
  const std::array arguments = {"program", certificate.c_str(), trusted.c_str()};
  SetupOptions options = SetupOptions::secure_server("a.node", 0);
  options.discovery_announce_enable = options.discovery_listening_enable = false;
  NodeSetup setup(options, arguments.size(), arguments.data());
  EXPECT_EQ(setup.node().id(), id);
  EXPECT_TRUE(setup.options().load_tls);
  expect_served(setup);
  // The name is its own all the same.
  EXPECT_EQ(error_of([] { NodeSetup second(quiet_server("a.node")); }).code(),
            ErrorCode::invalid_operation);
}

TEST_F(SetupWithTls, TheEnvironmentGivesTheCertificateToo) {
  const NodeId id = NodeId::random();
  set("ROBOTRACONTEUR_TLS_CERTIFICATE", authority_.issue(id));
  set("ROBOTRACONTEUR_TLS_AUTHORITY", authority_.certificate_file());
  NodeSetup setup(secure("a.node"));
  EXPECT_EQ(setup.node().id(), id);
  unsetenv("ROBOTRACONTEUR_TLS_CERTIFICATE");  // not for the client
  expect_served(setup);
}

TEST_F(SetupWithTls, TheCertificateOfTheKeptIdIsFoundInTheUsersFolder) {
  NodeId id;
  {
    const NodeSetup before(quiet_server("a.node"));
    id = before.node().id();
  }
  fs::path pkcs12 = authority_.issue(id);
  pkcs12.replace_extension(".p12");
  const fs::path folder =
      geteuid() == 0 ? home_ / "etc/robotraconteur/certificates" : home_ / "config/certificates";
  fs::create_directories(folder);
  fs::copy(pkcs12, folder / (id.text() + ".p12"));
  NodeSetup setup(secure("a.node"));
  EXPECT_EQ(setup.node().id(), id);
  expect_served(setup);
}

TEST_F(SetupWithTls, AnIdThatIsNotTheCertificatesIsAnError) {
  SetupOptions options = secure("a.node");
  options.node.id = NodeId::random();
  options.tls_certificate = authority_.issue(NodeId::random());
  const Error error = failure_of(options);
  EXPECT_EQ(error.code(), ErrorCode::invalid_configuration);
  EXPECT_NE(error.message().find("the certificate is of node"), std::string::npos);
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
