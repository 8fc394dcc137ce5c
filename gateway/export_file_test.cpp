// SPDX-License-Identifier: Apache-2.0
#include "gateway/export_file.hpp"

#include <gtest/gtest.h>

#include <string>

#include "rr/error.hpp"

namespace rr::gateway {
namespace {

const std::string good = R"(
site = "hall"
node = "robot1"
state = "state"

[broker]
url = "mqtts://hub:8883"
user = "robot1"
authority = "ca.pem"
certificate = "/etc/robot1.pem"
key = "robot1.key"

[[service]]
name = "arm"
url = "rr+tcp://localhost:6257/?service=arm"
readers = ["hub"]
log_size = "64 MiB"
log_age = "2 days"
session_limit = "90 s"
[[service.allow]]
members = ["pose", "force*"]
access = ["read"]
rate = "20/s"
lifespan = "5 s"

[[service.allow]]
path = "tools[*]"
members = ["*"]
access = ["read", "write", "call", "lock"]
users = ["alice"]

[[service.user]]
broker = "alice"
service = "operator"
)";

std::string mistakes(const std::string& text) {
  try {
    static_cast<void>(parse_export_file("x.toml", text));
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::invalid_configuration);
    return error.message();
  }
  return "none";
}

std::string changed(const std::string& from, const std::string& to) {
  std::string text = good;
  text.replace(text.find(from), from.size(), to);
  return text;
}

TEST(GatewayExportFile, IsRead) {
  const ExportFile file = parse_export_file("folder/x.toml", good);
  EXPECT_EQ(file.site, "hall");
  EXPECT_EQ(file.state_folder, "folder/state");
  EXPECT_EQ(file.broker.url, "mqtts://hub:8883");
  EXPECT_EQ(file.broker.authority, "folder/ca.pem");
  EXPECT_EQ(file.broker.certificate, "/etc/robot1.pem");
  EXPECT_EQ(file.broker.key, "folder/robot1.key");
  ASSERT_EQ(file.services.size(), 1U);
  const ExportedServiceOptions& arm = file.services[0];
  EXPECT_EQ(arm.readers, std::vector<std::string>{"hub"});
  EXPECT_EQ(arm.session_limit, std::chrono::seconds(90));
  EXPECT_EQ(arm.log_bytes, 64U * 1024 * 1024);
  EXPECT_EQ(arm.log_age, std::chrono::hours(48));
  ASSERT_EQ(arm.rules.size(), 2U);
  EXPECT_EQ(arm.rules[0].period, std::chrono::milliseconds(50));
  EXPECT_EQ(arm.rules[0].lifespan, std::chrono::seconds(5));
  EXPECT_EQ(arm.rules[1].access, reading | writing | calling | locking);
  EXPECT_EQ(arm.users.at({"alice"}).name, "operator");
}

TEST(GatewayExportFile, ClientsOfAUserMayBeOthersAtTheService) {
  const auto entry = [](const std::string& broker, const std::string& client,
                        const std::string& service) {
    return "[[service.user]]\nbroker = \"" + broker + "\"\nclient = \"" + client +
           "\"\nservice = \"" + service + "\"\n";
  };
  const ExportFile file = parse_export_file("x.toml", good + entry("alice", "eve@site 2", "guest"));
  const ExportedServiceOptions& arm = file.services[0];
  EXPECT_EQ(login_of(arm, {"alice"}).name, "operator");
  EXPECT_EQ(login_of(arm, {"alice", "eve@site 2"}).name, "guest");
  EXPECT_EQ(login_of(arm, {"alice", "adam"}).name, "operator");
  EXPECT_EQ(login_of(arm, {"bob", "eve@site 2"}).name, arm.login.name);
  const std::string twice =
      mistakes(good + entry("alice", "eve", "guest") + entry("alice", "eve", "x"));
  EXPECT_TRUE(twice.ends_with("user `alice`, client `eve`, is there twice")) << twice;
}

TEST(GatewayExportFile, MistakesHaveTheirPlaces) {
  EXPECT_EQ(mistakes(changed("site = \"hall\"", "site = \"a/b\"")),
            "x.toml:2:8: a name has 1 to 64 letters, digits, `_` or `-`");
  EXPECT_EQ(mistakes(changed("readers", "raeders")),
            "x.toml:16:1: `raeders` is no key of [[service]]");
  EXPECT_EQ(mistakes(changed("\"20/s\"", "\"20\"")), "x.toml:23:8: not such as `20/s`");
  EXPECT_EQ(mistakes(changed("[\"read\"]", "[\"read\", \"raed\"]")),
            "x.toml:22:19: access is `read`, `write`, `call` or `lock`");
  EXPECT_EQ(mistakes(changed("tools[*]", "tools[")),
            "x.toml:27:8: `tools[` is no path of an object");
  EXPECT_EQ(mistakes(changed("log_size = \"64 MiB\"", "log_size = 64")),
            "x.toml:17:12: a text is expected");
  EXPECT_TRUE(mistakes(changed("= \"hall\"", "=")).starts_with("x.toml:2:"))
      << mistakes(changed("= \"hall\"", "="));
}

TEST(GatewayExportFile, AllMistakesAreReported) {
  EXPECT_EQ(mistakes("nod = 1\n"),
            "x.toml:1:1: `nod` is no key of an export file\n"
            "x.toml:1:1: `site` is missing\nx.toml:1:1: `node` is missing\n"
            "x.toml:1:1: `state` is missing\nx.toml:1:1: `broker.url` is missing\n"
            "x.toml:1:1: `[[service]]` is missing");
}

TEST(GatewayExportFile, NamesOfMembersArePlain) {
  EXPECT_EQ(mistakes(changed("\"pose\"", "\"a/b\"")), "x.toml:21:12: `a/b` is no name of a member");
  EXPECT_EQ(mistakes(changed("tools[*]", "tools/*")),
            "x.toml:27:8: `tools/*` is no path of objects");
}

TEST(GatewayExportFile, AMissingPasswordFileIsReportedAtItsPlace) {
  EXPECT_EQ(mistakes(changed("user = \"robot1\"", "password_file = \"/nowhere/secret\"")),
            "x.toml:8:17: /nowhere/secret cannot be read");
}

TEST(GatewayExportRules, StarsFitAnyLetters) {
  EXPECT_TRUE(fits("*", ""));
  EXPECT_TRUE(fits("a*c*e", "abcde"));
  EXPECT_TRUE(fits("*ab", "aab"));
  EXPECT_FALSE(fits("a*c", "abcd"));
  EXPECT_FALSE(fits("", "a"));
  EXPECT_TRUE(fits("", ""));
}

TEST(GatewayExportRules, AStarInAPathIsOfOneStep) {
  EXPECT_TRUE(path_fits("", ""));
  EXPECT_TRUE(path_fits("tools[*]", "tools[left]"));
  EXPECT_TRUE(path_fits("*.axis", "tools[left].axis"));
  EXPECT_FALSE(path_fits("tools[*]", "tools[left].axis[2]"));
  EXPECT_FALSE(path_fits("*", "a.b"));
  EXPECT_FALSE(path_fits("*.*", "a"));
  EXPECT_FALSE(path_fits("*", ""));
}

TEST(GatewayExportRules, WhatIsNotListedIsNotAllowed) {
  const ExportFile file = parse_export_file("x.toml", good);
  const ExportedServiceOptions& arm = file.services[0];
  EXPECT_NE(find_rule(arm, "bob", "", "pose", reading), nullptr);
  EXPECT_NE(find_rule(arm, "", "", "force_left", reading), nullptr);
  EXPECT_EQ(find_rule(arm, "bob", "", "pose", writing), nullptr);
  EXPECT_EQ(find_rule(arm, "bob", "", "speed", reading), nullptr);
  EXPECT_EQ(find_rule(arm, "bob", "tools[left]", "open", calling), nullptr);
  EXPECT_NE(find_rule(arm, "alice", "tools[left]", "open", calling), nullptr);
  EXPECT_EQ(find_rule(arm, "alice", "tools", "open", calling), nullptr);
  EXPECT_EQ(find_rule(arm, "alice", "", "open", calling), nullptr);
}

TEST(GatewayExportFile, NamesWhatANatsServerNeeds) {
  const std::string rest = "[[service]]\nname = \"arm\"\nurl = \"x\"\n";
  const std::string head =
      "site = \"h\"\nnode = \"r\"\nstate = \"s\"\n[broker]\n"
      "url = \"tls://hub\"\n";
  const ExportFile file = parse_export_file(
      "/etc/x.toml", head + "credentials = \"r.creds\"\nreplicas = \"3\"\n" + rest);
  EXPECT_EQ(file.broker.credentials, "/etc/r.creds");
  EXPECT_EQ(file.broker.replicas, 3);
  for (const char* wrong : {"replicas = \"2\"", "replicas = \"x\"", "replicas = 3"}) {
    EXPECT_THROW(static_cast<void>(parse_export_file("x.toml", head + wrong + "\n" + rest)), Error)
        << wrong;
  }
}

}  // namespace
}  // namespace rr::gateway
