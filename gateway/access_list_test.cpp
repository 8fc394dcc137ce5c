// SPDX-License-Identifier: Apache-2.0
#include "gateway/access_list.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "rr/error.hpp"

namespace rr::gateway {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

ExportFile file_of(const std::string& node, const std::string& user, const std::string& rules) {
  return parse_export_file("x.toml",
                           "site = \"hall\"\nnode = \"" + node +
                               "\"\nstate = \"state\"\n[broker]\n" +
                               "url = \"mqtt://hub\"\npassword_file = \"/nowhere/secret\"\n" +
                               (user.empty() ? std::string() : "user = \"" + user + "\"\n") +
                               "[[service]]\nname = \"arm\"\nurl = \"x\"\n" + rules,
                           Secrets::ignored);
}

std::string rule(const std::string& path, const std::string& members, const std::string& access,
                 const std::string& users = "") {
  return "[[service.allow]]\npath = \"" + path + "\"\nmembers = [" + members + "]\naccess = [" +
         access + "]\nusers = [" + users + "]\n";
}

TEST(GatewayAccessList, HasWhatAllUsersMay) {
  const AccessList list = access_list({file_of("r1", "robot1", rule("", "\"pose\"", "\"read\""))});
  EXPECT_THAT(list.everybody.publish,
              ElementsAre("rr/hall/r1/arm/$confirm/%u/pose", "rr/hall/r1/arm/$connect/%u/pose",
                          "rr/hall/r1/arm/$get/%u/pose", "rr/hall/r1/arm/$stream/%u/pose"));
  EXPECT_THAT(list.everybody.receive,
              ElementsAre("rr/$reply/%u/#", "rr/hall/r1/$life", "rr/hall/r1/arm/$attributes",
                          "rr/hall/r1/arm/$closed", "rr/hall/r1/arm/$def/#", "rr/hall/r1/arm/$life",
                          "rr/hall/r1/arm/$streams", "rr/hall/r1/arm/pose"));
  ASSERT_EQ(list.users.size(), 1U);
  EXPECT_THAT(list.users.at("robot1").publish, ElementsAre("rr/$reply/#", "rr/hall/r1/#"));
  EXPECT_THAT(list.users.at("robot1").receive, Contains("rr/hall/r1/arm/$get/#"));
  EXPECT_THAT(list.users.at("robot1").receive, Not(Contains("rr/hall/r1/#")));
}

TEST(GatewayAccessList, HasWhatSingleUsersMay) {
  const AccessList list = access_list({file_of(
      "r1", "robot1", rule("tools[*].axis[2]", "\"*\"", "\"write\", \"call\"", "\"alice\""))});
  EXPECT_TRUE(list.everybody.publish.empty());
  EXPECT_TRUE(list.everybody.receive.empty());
  const AccessRights& alice = list.users.at("alice");
  EXPECT_THAT(
      alice.publish,
      ElementsAre(
          "rr/hall/r1/arm/$call/alice/+/axis[2]/+", "rr/hall/r1/arm/$connect/alice/+/axis[2]/+",
          "rr/hall/r1/arm/$next/alice/+/axis[2]/+", "rr/hall/r1/arm/$object/alice/+",
          "rr/hall/r1/arm/$object/alice/+/axis[2]", "rr/hall/r1/arm/$poke/alice/+/axis[2]/+",
          "rr/hall/r1/arm/$send/alice/+/axis[2]/+", "rr/hall/r1/arm/$session/alice",
          "rr/hall/r1/arm/$set/alice/+/axis[2]/+"));
  EXPECT_THAT(alice.receive,
              ElementsAre("rr/$reply/alice/#", "rr/hall/r1/$life", "rr/hall/r1/arm/$attributes",
                          "rr/hall/r1/arm/$closed", "rr/hall/r1/arm/$def/#", "rr/hall/r1/arm/$life",
                          "rr/hall/r1/arm/$streams"));
  EXPECT_THAT(list.users.at("robot1").publish, ElementsAre("rr/$reply/alice/#", "rr/hall/r1/#"));
}

TEST(GatewayAccessList, HasLocksOfObjects) {
  const AccessList list =
      access_list({file_of("r1", "robot1", rule("", "\"*\"", "\"lock\"")),
                   file_of("r2", "robot2", rule("tools[*]", "\"*\"", "\"lock\""))});
  EXPECT_THAT(list.everybody.publish,
              ElementsAre("rr/hall/r1/arm/$lock/%u", "rr/hall/r1/arm/$session/%u",
                          "rr/hall/r2/arm/$lock/%u/+", "rr/hall/r2/arm/$object/%u/+",
                          "rr/hall/r2/arm/$session/%u"));
}

TEST(GatewayAccessList, PathsAreAsTopicsHaveThem) {
  const AccessList list =
      access_list({file_of("r1", "robot1", rule("tools[a%2fb]", "\"width\"", "\"read\""))});
  EXPECT_THAT(list.everybody.receive, Contains("rr/hall/r1/arm/tools[a%2Fb]/width"));
}

TEST(GatewayAccessList, IsWrittenForMosquitto) {
  const AccessList list =
      access_list({file_of("r1", "robot1", rule("", "\"move\"", "\"call\"", "\"alice\"")),
                   file_of("r2", "robot2", rule("", "\"force*\"", "\"read\""))});
  EXPECT_EQ(mosquitto_acl(list),
            "user alice\n"
            "topic write rr/hall/r1/arm/$call/alice/move\n"
            "topic write rr/hall/r1/arm/$next/alice/move\n"
            "topic write rr/hall/r1/arm/$session/alice\n"
            "topic read rr/$reply/alice/#\n"
            "topic read rr/hall/r1/$life\n"
            "topic read rr/hall/r1/arm/$attributes\n"
            "topic read rr/hall/r1/arm/$closed\n"
            "topic read rr/hall/r1/arm/$def/#\n"
            "topic read rr/hall/r1/arm/$life\n"
            "topic read rr/hall/r1/arm/$streams\n"
            "\n"
            "user robot1\n"
            "topic write rr/$reply/alice/#\n"
            "topic write rr/hall/r1/#\n"
            "topic read rr/hall/r1/$claim\n"
            "topic read rr/hall/r1/$life\n"
            "topic read rr/hall/r1/arm/$call/#\n"
            "topic read rr/hall/r1/arm/$confirm/#\n"
            "topic read rr/hall/r1/arm/$connect/#\n"
            "topic read rr/hall/r1/arm/$get/#\n"
            "topic read rr/hall/r1/arm/$lock/#\n"
            "topic read rr/hall/r1/arm/$next/#\n"
            "topic read rr/hall/r1/arm/$object/#\n"
            "topic read rr/hall/r1/arm/$poke/#\n"
            "topic read rr/hall/r1/arm/$send/#\n"
            "topic read rr/hall/r1/arm/$session/#\n"
            "topic read rr/hall/r1/arm/$set/#\n"
            "topic read rr/hall/r1/arm/$stream/#\n"
            "\n"
            "user robot2\n"
            "topic write rr/$reply/#\n"
            "topic write rr/hall/r2/#\n"
            "topic read rr/hall/r2/$claim\n"
            "topic read rr/hall/r2/$life\n"
            "topic read rr/hall/r2/arm/$call/#\n"
            "topic read rr/hall/r2/arm/$confirm/#\n"
            "topic read rr/hall/r2/arm/$connect/#\n"
            "topic read rr/hall/r2/arm/$get/#\n"
            "topic read rr/hall/r2/arm/$lock/#\n"
            "topic read rr/hall/r2/arm/$next/#\n"
            "topic read rr/hall/r2/arm/$object/#\n"
            "topic read rr/hall/r2/arm/$poke/#\n"
            "topic read rr/hall/r2/arm/$send/#\n"
            "topic read rr/hall/r2/arm/$session/#\n"
            "topic read rr/hall/r2/arm/$set/#\n"
            "topic read rr/hall/r2/arm/$stream/#\n"
            "\n"
            "pattern write rr/hall/r2/arm/$confirm/%u/+\n"
            "pattern write rr/hall/r2/arm/$connect/%u/+\n"
            "pattern write rr/hall/r2/arm/$get/%u/+\n"
            "pattern write rr/hall/r2/arm/$stream/%u/+\n"
            "pattern read rr/$reply/%u/#\n"
            "pattern read rr/hall/r2/$life\n"
            "pattern read rr/hall/r2/arm/$attributes\n"
            "pattern read rr/hall/r2/arm/$closed\n"
            "pattern read rr/hall/r2/arm/$def/#\n"
            "pattern read rr/hall/r2/arm/$life\n"
            "pattern read rr/hall/r2/arm/$streams\n"
            "pattern read rr/hall/r2/arm/+\n");
}

TEST(GatewayAccessList, NeedsAUserForEachRobot) {
  const auto mistake = [](const std::vector<ExportFile>& files) -> std::string {
    try {
      static_cast<void>(access_list(files));
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::invalid_configuration);
      return error.message();
    }
    return "none";
  };
  const std::string rules = rule("", "\"pose\"", "\"read\"");
  EXPECT_EQ(mistake({file_of("r1", "", rules)}), "hall/r1: `broker.user` is missing");
  EXPECT_EQ(mistake({file_of("r1", "robot", rules), file_of("r2", "robot", rules)}),
            "hall/r2: another robot has the user `robot`, too");
}

TEST(GatewayAccessList, IsWrittenForNats) {
  const AccessList list = access_list({file_of("r1", "robot1", rule("", "\"pose\"", "\"read\""))});
  EXPECT_EQ(nats_authorization(list, {"eve"}),
            R"(include passwords.conf
authorization {
  users: [
    {user: "eve", password: $password_eve, permissions: {
      publish: [
        "$JS.API.CONSUMER.CREATE.RRKEPT.*.rrkept.hall.r1.$life",
        "$JS.API.CONSUMER.CREATE.RRKEPT.*.rrkept.hall.r1.$life.$beat",
        "$JS.API.CONSUMER.CREATE.RRKEPT.*.rrkept.hall.r1.arm.$attributes",
        "$JS.API.CONSUMER.CREATE.RRKEPT.*.rrkept.hall.r1.arm.$closed",
        "$JS.API.CONSUMER.CREATE.RRKEPT.*.rrkept.hall.r1.arm.$def",
        "$JS.API.CONSUMER.CREATE.RRKEPT.*.rrkept.hall.r1.arm.$def.>",
        "$JS.API.CONSUMER.CREATE.RRKEPT.*.rrkept.hall.r1.arm.$life",
        "$JS.API.CONSUMER.CREATE.RRKEPT.*.rrkept.hall.r1.arm.$life.$beat",
        "$JS.API.CONSUMER.CREATE.RRKEPT.*.rrkept.hall.r1.arm.$streams",
        "$JS.API.CONSUMER.CREATE.RRKEPT.*.rrkept.hall.r1.arm.pose",
        "_INBOX.eve.>",
        "rr.hall.r1.arm.$confirm.eve.pose",
        "rr.hall.r1.arm.$connect.eve.pose",
        "rr.hall.r1.arm.$get.eve.pose",
        "rr.hall.r1.arm.$stream.eve.pose"]
      subscribe: [
        "_INBOX.eve.>",
        "rr.$reply.eve",
        "rr.$reply.eve.>",
        "rr.hall.r1.$life",
        "rr.hall.r1.$life.$beat",
        "rr.hall.r1.arm.$attributes",
        "rr.hall.r1.arm.$closed",
        "rr.hall.r1.arm.$def",
        "rr.hall.r1.arm.$def.>",
        "rr.hall.r1.arm.$life",
        "rr.hall.r1.arm.$life.$beat",
        "rr.hall.r1.arm.$streams",
        "rr.hall.r1.arm.pose"]}}
)" + nats_authorization(list, {}).substr(
         std::string("include passwords.conf\nauthorization {\n  users: [\n").size()));
  const std::string robot = nats_authorization(list, {});
  EXPECT_THAT(robot, HasSubstr("\n        \"rrkept.hall.r1.>\""));
  EXPECT_THAT(robot, HasSubstr("\n        \"$JS.API.STREAM.CREATE.RRKEPT\""));
  EXPECT_THAT(robot, Not(HasSubstr("rrkept.$reply")));
  EXPECT_THAT(robot, Not(HasSubstr("rr.*.*.$life")));
  for (const char* wrong : {"", "a b", "a\"", "a.b", "$a"}) {
    EXPECT_THROW(static_cast<void>(nats_authorization(list, {wrong})), Error) << wrong;
  }
  const std::string watched = nats_authorization(list, {}, {"boss"});
  EXPECT_THAT(watched, HasSubstr("{user: \"boss\", password: $password_boss"));
  EXPECT_THAT(watched, HasSubstr("\"rr.*.*.$life.$beat\""));
  EXPECT_THAT(watched, HasSubstr("\"$JS.API.CONSUMER.CREATE.RRKEPT.*.rrkept.*.*.*.$streams\""));
}

}  // namespace
}  // namespace rr::gateway
