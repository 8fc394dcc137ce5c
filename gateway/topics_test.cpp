// SPDX-License-Identifier: Apache-2.0
#include "gateway/topics.hpp"

#include <gtest/gtest.h>

#include "rr/error.hpp"

namespace rr::gateway {
namespace {

const ServiceAddress arm{"hall", "robot-1", "arm"};

TEST(GatewayTopics, StepsOfAPathAreLevels) {
  EXPECT_EQ(member_topic(arm, "", "speed"), "rr/hall/robot-1/arm/speed");
  EXPECT_EQ(member_topic(arm, "tools[left].axis", "open"),
            "rr/hall/robot-1/arm/tools[left]/axis/open");
}

TEST(GatewayTopics, IndexesAreEncodedSoThatTheyAreOneLevel) {
  const std::string path = path_below("tools", {"part", "a/b.c#+ *"});
  EXPECT_EQ(path, "tools.part[a%2Fb%2Ec%23%2B%20%2A]");
  const auto steps = path_steps(path);
  ASSERT_EQ(steps.size(), 2U);
  EXPECT_FALSE(steps[0].index.has_value());
  EXPECT_EQ(steps[1].index, "a/b.c#+ *");
}

TEST(GatewayTopics, WhatIsNoPathIsRefused) {
  for (const char* path :
       {".", "a.", "a[", "a[1", "[1]", "a[1]b", "a b", "a[%4]", "a[%zz]", "1a"}) {
    EXPECT_THROW(static_cast<void>(path_steps(path)), Error) << path;
  }
}

TEST(GatewayTopics, RequestsAreReadAsTheyAreWritten) {
  const RequestTopic request{Verb::call, "alice", "tools[left].axis", "open"};
  const std::string topic = request_topic(arm, request);
  EXPECT_EQ(topic, "rr/hall/robot-1/arm/$call/alice/tools[left]/axis/open");
  const auto read = parse_request_topic(arm, topic);
  ASSERT_TRUE(read.has_value());
  EXPECT_EQ(read->verb, Verb::call);
  EXPECT_EQ(read->user, "alice");
  EXPECT_EQ(read->path, "tools[left].axis");
  EXPECT_EQ(read->member, "open");
  EXPECT_TRUE(topic_matches(request_filter(arm, Verb::call), topic));
  EXPECT_FALSE(topic_matches(request_filter(arm, Verb::get), topic));
}

TEST(GatewayTopics, OfAnObjectAllLevelsAreThePath) {
  const auto read = parse_request_topic(arm, "rr/hall/robot-1/arm/$object/alice/tools[left]");
  ASSERT_TRUE(read.has_value());
  EXPECT_EQ(read->path, "tools[left]");
  EXPECT_EQ(read->member, "");
}

TEST(GatewayTopics, OtherTopicsAreNoRequests) {
  for (const char* topic :
       {"rr/hall/robot-1/arm/$call", "rr/hall/robot-1/arm/$call/alice", "rr/hall/robot-1/arm/speed",
        "rr/hall/robot-1/arm/$burn/alice/speed", "rr/hall/robot-2/arm/$call/alice/open",
        "rr/hall/robot-1/arm/$call/a b/open", "rr/hall/robot-1/arm/$call/alice/$life"}) {
    EXPECT_FALSE(parse_request_topic(arm, topic).has_value()) << topic;
  }
}

TEST(GatewayTopics, LocksAreForObjectsAndSessionsForAService) {
  const auto lock = parse_request_topic(arm, "rr/hall/robot-1/arm/$lock/alice/tools[left]/axis");
  ASSERT_TRUE(lock.has_value());
  EXPECT_EQ(lock->verb, Verb::lock);
  EXPECT_EQ(lock->path, "tools[left].axis");
  EXPECT_EQ(lock->member, "");
  const std::string topic = request_topic(arm, {Verb::session, "alice", "", ""});
  EXPECT_EQ(topic, "rr/hall/robot-1/arm/$session/alice");
  const auto session = parse_request_topic(arm, topic);
  ASSERT_TRUE(session.has_value());
  EXPECT_EQ(session->user, "alice");
}

TEST(GatewayTopics, ConnectingIsOfAMember) {
  const std::string topic = request_topic(arm, {Verb::connect, "alice", "tools[left]", "force"});
  EXPECT_EQ(topic, "rr/hall/robot-1/arm/$connect/alice/tools[left]/force");
  const auto connect = parse_request_topic(arm, topic);
  ASSERT_TRUE(connect.has_value());
  EXPECT_EQ(connect->verb, Verb::connect);
  EXPECT_EQ(connect->member, "force");
}

TEST(GatewayTopics, AnswersGoToTheUserOnly) {
  EXPECT_TRUE(is_reply_topic(reply_topic("alice", "7f"), "alice"));
  EXPECT_FALSE(is_reply_topic(reply_topic("bob", "7f"), "alice"));
  EXPECT_FALSE(is_reply_topic("rr/$reply/alice/7f/x", "alice"));
  EXPECT_FALSE(is_reply_topic("rr/hall/robot-1/arm/speed", "alice"));
}

TEST(GatewayTopics, FiltersAreThoseOfMqtt) {
  EXPECT_TRUE(topic_matches("a/+/c", "a/b/c"));
  EXPECT_FALSE(topic_matches("a/+", "a/b/c"));
  EXPECT_TRUE(topic_matches("a/#", "a/b/c"));
  EXPECT_TRUE(topic_matches("a/#", "a"));
  EXPECT_FALSE(topic_matches("a/b/c", "a/b"));
}

TEST(GatewayTopics, OfRequestsAndAnswersAreNotRetained) {
  for (const char* filter :
       {"rr/h/r/$claim", "rr/h/r/s/$get/#", "rr/h/r/s/$confirm/desk/force", "rr/$reply/desk/1"}) {
    EXPECT_FALSE(may_be_retained(filter)) << filter;
  }
  for (const char* filter : {"rr/+/+/$life", "rr/h/r/s/$def/#", "rr/h/r/s/force", "rr/h/r/s/get"}) {
    EXPECT_TRUE(may_be_retained(filter)) << filter;
  }
}

}  // namespace
}  // namespace rr::gateway
