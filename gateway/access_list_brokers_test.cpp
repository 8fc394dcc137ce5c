// SPDX-License-Identifier: Apache-2.0
// Real brokers with the access lists that the program prints.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "gateway/properties.hpp"
#include "gateway/testing/broker_kinds.hpp"
#include "gateway/testing/listener.hpp"
#include "gateway/testing/rig.hpp"

namespace rr::gateway {
namespace {

using testing::BrokerSetup;
using testing::comes_true;
using testing::Folder;
using testing::Listener;
using testing::OverBroker;
using testing::Program;
using testing::RealBroker;
using testing::Rig;
using ::testing::UnorderedElementsAre;
using testing::value_comes;

/// A connection of a user.
struct Person {
  Person(const RealBroker& broker, const std::string& name,
         const std::vector<std::string>& filters = {})
      : carrier(make_carrier({broker.url(), name, "secret-" + name})) {
    for (const std::string& filter : filters) carrier->subscribe(filter);
    carrier->start(listener, {"life/" + name, {}});
    EXPECT_TRUE(listener.connected.wait_for(1)) << name;
  }
  ~Person() { carrier->stop({}); }
  [[nodiscard]] std::set<std::string> topics() const {
    std::set<std::string> all;
    for (const Message& message : listener.messages.items()) all.insert(message.topic);
    return all;
  }

  Listener listener;
  std::unique_ptr<Carrier> carrier;
};

class BrokersAccess : public OverBroker {
 protected:
  /// `more` are lines of the export file of robot `r1`.
  void start(const std::string& rules) {
    write("r1.toml", "robot1", "r1", rules);
    write("r2.toml", "robot2", "r2", rules);
    for (const char* name : {"robot1", "robot2", "hub", "alice", "eve", "admin"}) {
      setup.users[name] = "secret-" + std::string(name);
    }
    setup.access_list = printed({"r1.toml", "r2.toml"});
    broker = GetParam().start(setup);
  }
  /// What the program prints for export files; the user `admin` looks at everything.
  [[nodiscard]] std::string printed(const std::vector<std::string>& files) const {
    const bool is_nats = GetParam().list_form == "nats";
    std::vector<std::string> words{ROBDEF_GATEWAY, "--acl", GetParam().list_form};
    // Those of the list itself, and the others.
    if (is_nats) words.insert(words.end(), {"--user", "hub", "--user", "eve", "--user", "alice"});
    for (const std::string& file : files) words.push_back(folder.path() + "/" + file);
    Program program(words);
    EXPECT_TRUE(testing::exited_with(program.wait(), 0));
    std::string text;
    for (const std::string& line : program.lines()) {
      text += line + "\n";
      if (line == "  users: [") text += "    {user: \"admin\", password: $password_admin}\n";
    }
    return is_nats ? text : text + "user admin\ntopic readwrite #\n";
  }
  void write(const std::string& name, const std::string& user, const std::string& node,
             const std::string& rules) {
    std::ofstream(folder.path() + "/" + name)
        << "site = \"hall\"\nnode = \"" << node << "\"\nstate = \"state\"\n[broker]\nurl = "
        << "\"mqtt://hub\"\nuser = \"" << user << "\"\n[[service]]\nname = \"bench\"\nurl = \"x\"\n"
        << rules;
  }

  Folder folder;
  BrokerSetup setup;
  std::unique_ptr<RealBroker> broker;
};

constexpr const char* some_rules =
    "[[service.allow]]\nmembers = [\"speed\", \"force\"]\naccess = [\"read\"]\n"
    "[[service.allow]]\npath = \"tools[*]\"\nmembers = [\"open\"]\naccess = [\"call\"]\n"
    "users = [\"alice\"]\n";

TEST_P(BrokersAccess, LetsRequestsPassThatTheExportLists) {
  start(some_rules);
  Person admin(*broker, "admin", {"rr/#", "other"});
  const std::string r1 = "rr/hall/r1/bench/";
  const std::vector<std::pair<std::string, std::string>> requests{
      {"eve", r1 + "$get/eve/speed"},
      {"eve", r1 + "$stream/eve/force"},
      {"alice", r1 + "$call/alice/tools[left]/open"},
      {"alice", r1 + "$object/alice/tools[left]"},
      {"alice", r1 + "$get/alice/speed"},
      {"robot1", r1 + "force"},
      {"robot1", "rr/hall/r1/$life"},
      {"robot1", "rr/$reply/eve/1"},
      // Not these.
      {"eve", r1 + "$get/alice/speed"},                  // the name of another user
      {"eve", r1 + "$get/eve/secret"},                   // is in no rule
      {"eve", r1 + "$set/eve/speed"},                    // is for reading
      {"eve", r1 + "$call/eve/tools[left]/open"},        // is for alice
      {"alice", r1 + "$call/alice/tools[left]/close"},   // is in no rule
      {"alice", r1 + "$call/alice/tools[left]/a/open"},  // another object
      {"eve", r1 + "force"},                             // a value of a robot
      {"eve", "rr/hall/r1/$life"},
      {"eve", "rr/$reply/alice/1"},
      {"robot1", "rr/hall/r2/bench/force"},  // another robot
      {"robot1", "rr/hall/r2/bench/$get/robot1/secret"},
      {"robot2", "rr/hall/r1/$life"}};
  constexpr std::size_t passing = 8;
  std::map<std::string, std::unique_ptr<Person>> people;
  for (const auto& [user, topic] : requests) {
    auto& person = people[user];
    if (!person) person = std::make_unique<Person>(*broker, user);
    ASSERT_EQ(person->carrier->publish({topic, {}}), Published::taken);
  }
  // What was refused is acknowledged as well, with that.
  std::size_t refused = 0;
  EXPECT_TRUE(comes_true([&] {
    refused = 0;
    for (const auto& [user, person] : people) {
      for (const auto& what : person->listener.refused.items()) {
        refused += what.find("a message to") != std::string::npos ? 1 : 0;
      }
    }
    return refused >= requests.size() - passing;
  })) << refused;
  ASSERT_TRUE(admin.listener.messages.wait_for(passing));
  std::set<std::string> expected;
  for (std::size_t i = 0; i < passing; ++i) expected.insert(requests[i].second);
  EXPECT_EQ(admin.topics(), expected);
  EXPECT_EQ(refused, requests.size() - passing);
}

TEST_P(BrokersAccess, ARefusalNamesTheTopicHoweverFastItIs) {
  start(some_rules);
  Person eve(*broker, "eve");
  constexpr std::size_t count = 3000;
  std::set<std::string> expected;
  for (std::size_t i = 0; i < count; ++i) {
    const std::string topic = "secret/" + std::to_string(i);
    ASSERT_TRUE(comes_true([&] { return eve.carrier->publish({topic, {}}) == Published::taken; }));
    expected.insert("`" + topic + "`");
  }
  std::set<std::string> named;
  EXPECT_TRUE(comes_true([&] {
    for (const std::string& text : eve.listener.refused.items()) {
      const std::size_t begin = std::min(text.find('`'), text.size());
      named.insert(text.substr(begin, text.rfind('`') + 1 - begin));
    }
    return named.size() >= count;
  }));
  EXPECT_EQ(named, expected);
}

TEST_P(BrokersAccess, GivesUsersWhatTheExportLists) {
  start(some_rules);
  const std::vector<std::string> topics{"rr/hall/r1/bench/force",
                                        "rr/hall/r1/bench/secret",
                                        "rr/hall/r1/bench/tools[a]/open",
                                        "rr/hall/r1/$life",
                                        "rr/hall/r2/bench/$def/x",
                                        "rr/$reply/eve/1",
                                        "rr/$reply/alice/1",
                                        "rr/hall/r1/bench/$get/eve/speed",
                                        "rr/hall/r2/bench/$get/eve/speed",
                                        "other"};
  // Where the broker looks at the subscription, each of them is asked for.
  const auto filters = GetParam().has_wide_filters ? std::vector<std::string>{"#"} : topics;
  Person eve(*broker, "eve", filters);
  Person alice(*broker, "alice", filters);
  Person robot(*broker, "robot1", filters);
  Person admin(*broker, "admin", {"rr/#", "other"});
  for (const std::string& topic : topics) {
    ASSERT_EQ(admin.carrier->publish({topic, {}}), Published::taken);
  }
  ASSERT_TRUE(admin.listener.messages.wait_for(10));
  // The last that each may have.
  ASSERT_TRUE(comes_true([&] {
    return eve.topics().size() >= 4 && alice.topics().size() >= 4 && robot.topics().size() >= 4;
  }));
  EXPECT_THAT(eve.topics(), UnorderedElementsAre("rr/hall/r1/bench/force", "rr/hall/r1/$life",
                                                 "rr/hall/r2/bench/$def/x", "rr/$reply/eve/1"));
  EXPECT_THAT(alice.topics(), UnorderedElementsAre("rr/hall/r1/bench/force", "rr/hall/r1/$life",
                                                   "rr/hall/r2/bench/$def/x", "rr/$reply/alice/1"));
  // As any user, and the requests to itself.
  EXPECT_THAT(robot.topics(),
              UnorderedElementsAre("rr/hall/r1/bench/force", "rr/hall/r1/$life",
                                   "rr/hall/r2/bench/$def/x", "rr/hall/r1/bench/$get/eve/speed"));
}

TEST_P(BrokersAccess, BothGatewaysWorkWithIt) {
  start(
      "[[service.allow]]\nmembers = [\"*\"]\naccess = [\"read\", \"write\", \"call\"]\n"
      "[[service.allow]]\npath = \"tools[*]\"\nmembers = [\"width\"]\naccess = [\"read\"]\n");
  int made = 0;
  // The bench of the test is hall/robot; its list is that of r1 with another name.
  write("robot.toml", "robot1", "robot",
        "[[service.allow]]\nmembers = [\"*\"]\naccess = [\"read\", \"write\", \"call\"]\n"
        "[[service.allow]]\npath = \"tools[*]\"\nmembers = [\"width\"]\naccess = [\"read\"]\n");
  setup.access_list = printed({"robot.toml"});
  // A server of NATS refuses passwords that no user has.
  setup.users.erase("robot2");
  broker->kill();
  broker->configure(setup);
  broker->start();
  Rig rig([&] {
    const std::string user = ++made == 1 ? "robot1" : "hub";
    return make_carriers({broker->url(), user, "secret-" + user});
  });
  const auto bench = rig.connect();
  EXPECT_EQ(bench->call("count").as<int>(), 1);
  // What the list does not allow is refused at once, by the broker.
  try {
    bench->object("tools", "left hand").call("open");
    ADD_FAILURE() << "it was executed";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::permission_denied);
    EXPECT_EQ(error.message(),
              "the broker has refused a message to "
              "`rr/hall/robot/bench/$call/hub/tools[left%20hand]/open`: " +
                  GetParam().refused_message);
  }
  bench->set("speed", 0.25);
  EXPECT_EQ(bench->get("speed").as<double>(), 0.25);
  EXPECT_EQ(bench->object("tools", "left hand").get("width").as<double>(), 2.5);
  auto samples = bench->pipe("samples").connect();
  EXPECT_TRUE(comes_true([&] {
    rig.robot.bench().pipe("samples").send(1);
    return samples.try_receive().has_value();
  }));
  auto force = bench->wire("force").connect();
  rig.robot.bench().wire("force").set_in(2.5);
  EXPECT_TRUE(value_comes(force, 2.5));
}

TEST_P(BrokersAccess, HoldsRetainedMessagesToTheSameRights) {
  start(some_rules);
  Message life{"rr/hall/r1/$life", bytes_of("up")};
  life.retained = true;
  Person eve(*broker, "eve", {life.topic});
  Person robot(*broker, "robot1");
  ASSERT_EQ(eve.carrier->publish(life), Published::taken);
  ASSERT_TRUE(comes_true([&] {
    const auto refused = eve.listener.refused.items();
    return std::ranges::find(refused, "the broker has refused a message to `" + life.topic +
                                          "`: " + GetParam().refused_message) != refused.end();
  }));
  ASSERT_EQ(robot.carrier->publish(life), Published::taken);
  ASSERT_TRUE(eve.listener.messages.wait_for(1));
  Person later(*broker, "eve", {life.topic});
  ASSERT_TRUE(later.listener.messages.wait_for(1));
  EXPECT_TRUE(later.listener.messages.items()[0].retained);
  EXPECT_EQ(eve.listener.messages.size(), 1U);
}

// What others ask is not for a user who may read all members.
TEST_P(BrokersAccess, AWideSubscriptionHasNoRequestsOfOthers) {
  start("[[service.allow]]\nmembers = [\"*\"]\naccess = [\"read\", \"call\"]\n");
  const std::string r1 = "rr/hall/r1/bench/";
  Person eve(*broker, "eve", {r1 + "#", r1 + "force"});
  Person alice(*broker, "alice");
  Person robot(*broker, "robot1", {r1 + "$call/#"});
  ASSERT_EQ(alice.carrier->publish({r1 + "$call/alice/open", {}}), Published::taken);
  ASSERT_TRUE(robot.listener.messages.wait_for(1));
  ASSERT_EQ(robot.carrier->publish({r1 + "force", {}}), Published::taken);
  ASSERT_TRUE(eve.listener.messages.wait_for(1));
  EXPECT_THAT(eve.topics(), UnorderedElementsAre(r1 + "force"));
}

// A user that asks in the name of another one.
TEST_P(BrokersAccess, AForgedUserIsDenied) {
  start(some_rules);
  Person admin(*broker, "admin", {"rr/#", "other"});
  Person eve(*broker, "eve");
  Message request{"rr/hall/r1/bench/$call/alice/tools[left]/open", {}};
  request.correlation = Bytes(4);
  request.response_topic = "rr/$reply/alice/1";
  ASSERT_EQ(eve.carrier->publish(request), Published::taken);
  ASSERT_TRUE(comes_true([&] {
    const auto refused = eve.listener.refused.items();
    return std::ranges::find(refused, "the broker has refused a message to `" + request.topic +
                                          "`: " + GetParam().refused_message) != refused.end();
  }));
  Person alice(*broker, "alice");
  ASSERT_EQ(alice.carrier->publish(request), Published::taken);
  ASSERT_TRUE(admin.listener.messages.wait_for(1));
  EXPECT_EQ(admin.listener.messages.size(), 1U);
}

INSTANTIATE_TEST_SUITE_P(All, BrokersAccess, ::testing::ValuesIn(testing::broker_kinds()),
                         testing::name_of_kind);

}  // namespace
}  // namespace rr::gateway
