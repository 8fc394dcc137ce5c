// SPDX-License-Identifier: Apache-2.0
#include "conformance/harness/comparison.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "conformance/harness/decoded.hpp"
#include "conformance/harness/entry_types.hpp"

namespace rr::conformance {
namespace {

class ComparisonTest : public testing::Test {
 protected:
  static const Captures& captures() {
    static const Captures all = read_captures(CONFORMANCE_CAPTURES);
    return all;
  }

  static const Frame& frame(const char* scenario, const char* version, int number) {
    return captures().find(scenario, version)->frames.at(static_cast<std::size_t>(number));
  }

  // The frame with one field changed.
  static Bytes changed(const Frame& frame, const char* path, const Json& value) {
    Json decoded = frame.decoded;
    decoded[Json::json_pointer(path)] = value;
    return rr::write_tree(message_of_json(decoded));
  }

  Comparison comparison_{captures()};
  PlayedConnection connection_;
};

TEST_F(ComparisonTest, TheRecordedBytesAgree) {
  const Frame& answer = frame("connect", "v4", 3);
  EXPECT_EQ(comparison_.difference(answer, answer.bytes, connection_, nullptr), std::nullopt);
}

TEST_F(ComparisonTest, AnEndpointMayDifferButMustStayTheSame) {
  const Frame& answer = frame("connect", "v4", 3);
  const Frame& last = frame("connect", "v4", 5);
  const char* sender = "/header/sender_endpoint";
  EXPECT_EQ(comparison_.difference(answer, changed(answer, sender, 77), connection_, nullptr),
            std::nullopt);
  EXPECT_EQ(comparison_.difference(last, changed(last, sender, 77), connection_, nullptr),
            std::nullopt);
  EXPECT_NE(comparison_.difference(last, changed(last, sender, 78), connection_, nullptr),
            std::nullopt);
}

TEST_F(ComparisonTest, ARecordedFrameIsSentToTheLiveEndpoint) {
  const Frame& answer = frame("connect", "v4", 3);
  const Frame& farewell = frame("connect", "v4", 4);
  comparison_.difference(answer, changed(answer, "/header/sender_endpoint", 77), connection_,
                         nullptr);
  rr::MessageTree tree;
  ASSERT_TRUE(rr::read_tree(addressed(farewell, connection_), tree));
  EXPECT_EQ(tree.receiver_endpoint, 77U);
}

TEST_F(ComparisonTest, TheVersionOfTheClientLibraryIsFree) {
  const Frame& request = frame("connect", "v4", 2);
  const char* version = "/entries/0/elements/0/value";
  EXPECT_EQ(comparison_.difference(request, changed(request, version, "0.1"), connection_, nullptr),
            std::nullopt);
  const char* definitions = "/entries/0/elements/1/value";
  EXPECT_NE(
      comparison_.difference(request, changed(request, definitions, "yes"), connection_, nullptr),
      std::nullopt);
}

TEST_F(ComparisonTest, AMessageIdIsComparedWithItsLead) {
  const Frame& answer = frame("objref_release", "v4", 8);  // message id 2
  const char* id = "/header/message_id";
  EXPECT_NE(comparison_.difference(answer, changed(answer, id, 1), connection_, nullptr),
            std::nullopt);
  connection_.message_id_lead = 1;
  EXPECT_EQ(comparison_.difference(answer, changed(answer, id, 1), connection_, nullptr),
            std::nullopt);
}

TEST_F(ComparisonTest, TheTextOfAnErrorCountsOnlyWhereItWasScripted) {
  const Scenario& scenario = *captures().find("connect_unknown", "v4");
  const Frame& free = scenario.frames.at(3);
  ASSERT_EQ(free.entries()[0]["elements"][1]["name"], "errorstring");
  const char* text = "/entries/0/elements/1/value";
  EXPECT_EQ(comparison_.difference(free, changed(free, text, "no"), connection_, nullptr),
            std::nullopt);
  EXPECT_NE(
      comparison_.difference(free, changed(free, "/entries/0/error", 8), connection_, nullptr),
      std::nullopt);
  EXPECT_NE(comparison_.difference(free, changed(free, "/entries/0/elements/0/value", "no"),
                                   connection_, nullptr),
            std::nullopt);

  const Frame& request = frame("errors", "v4", 7);
  const Frame& scripted = frame("errors", "v4", 8);
  ASSERT_EQ(scripted.entries()[0]["elements"][1]["value"], "went wrong");
  EXPECT_NE(comparison_.difference(scripted, changed(scripted, text, "no"), connection_, &request),
            std::nullopt);
}

TEST_F(ComparisonTest, ElementsOfAnErrorHaveNoOrder) {
  const Frame& answer = frame("connect_unknown", "v4", 3);
  Json decoded = answer.decoded;
  std::swap(decoded["entries"][0]["elements"][0], decoded["entries"][0]["elements"][1]);
  const Bytes swapped = rr::write_tree(message_of_json(decoded));
  ASSERT_NE(swapped, answer.bytes);
  EXPECT_EQ(comparison_.difference(answer, swapped, connection_, nullptr), std::nullopt);
}

TEST_F(ComparisonTest, PortsOfConnectionUrlsAreFreeTheRestIsNot) {
  const Frame& answer = frame("service_index", "v4", 5);
  const char* url = "/entries/0/elements/0/elements/1/elements/3/elements/0/value";
  std::string text = answer.decoded[Json::json_pointer(url)];
  text.replace(text.find("46737"), 5, "80");
  EXPECT_EQ(comparison_.difference(answer, changed(answer, url, text), connection_, nullptr),
            std::nullopt);
  text.replace(text.find("127.0.0.1"), 9, "localhost");
  EXPECT_NE(comparison_.difference(answer, changed(answer, url, text), connection_, nullptr),
            std::nullopt);
}

TEST_F(ComparisonTest, WhatIsNoMessageIsDifferent) {
  const Frame& answer = frame("connect", "v4", 3);
  EXPECT_NE(comparison_.difference(answer, bytes_of_hex("00"), connection_, nullptr), std::nullopt);
}

TEST_F(ComparisonTest, HostSpecificNamesAreThoseThatNobodyHasGiven) {
  for (const char* host : {"St13runtime_error", "N5boost10wrapexceptISt12out_of_rangeEE",
                           "std::exception", "std.exception", "System.InvalidOperationException",
                           "java.lang.IllegalStateException", "ValueError"}) {
    EXPECT_TRUE(comparison_.is_host_specific(host)) << host;
  }
  for (const char* given : {"RobotRaconteur.OutOfRange", "conformance.types.ProbeFault",
                            "not.a.known.Error", "scripted.Name"}) {
    EXPECT_FALSE(comparison_.is_host_specific(given)) << given;
  }
}

TEST(ScriptedNames, MayBeArgumentsOfACall) {
  Captures foreign;
  foreign.service =
      Json::parse(R"({"functions": {"fail": {"throw": {"code": 100, "name": "$0"}}}})");
  Step step;
  step.plan = Json::parse(R"({"op": "call", "args": ["experimental.door.Stuck", "text"]})");
  foreign.scenarios.emplace_back().steps = {Step(), step};
  EXPECT_FALSE(Comparison(foreign).is_host_specific("experimental.door.Stuck"));
  EXPECT_TRUE(Comparison(foreign).is_host_specific("ValueError"));
  foreign.service["functions"]["fail"]["throw"]["name"] = "experimental.door.Locked";
  EXPECT_TRUE(Comparison(foreign).is_host_specific("experimental.door.Stuck"));
  EXPECT_FALSE(Comparison(foreign).is_host_specific("experimental.door.Locked"));
}

TEST(RepeatedTypeAnswers, AreFoundByTheirRequest) {
  const Captures captures = read_captures(CONFORMANCE_CAPTURES);
  const Scenario& scenario = *captures.find("objref_release", "v4");
  EXPECT_FALSE(repeats_type_answer(scenario, scenario.frames[5]));
  EXPECT_TRUE(repeats_type_answer(scenario, scenario.frames[6]));
  EXPECT_FALSE(repeats_type_answer(scenario, scenario.frames[15]));
}

TEST_F(ComparisonTest, TheTimeOfAWireValueIsFreeButATime) {
  const Frame& answer = frame("wires", "v4", 8);
  const char* seconds = "/entries/0/elements/0/elements/0/value/0";
  EXPECT_EQ(comparison_.difference(answer, changed(answer, seconds, "17"), connection_, nullptr),
            std::nullopt);
  const char* nanoseconds = "/entries/0/elements/0/elements/1/value/0";
  EXPECT_EQ(comparison_.difference(answer, changed(answer, nanoseconds, 5), connection_, nullptr),
            std::nullopt);
  EXPECT_NE(comparison_.difference(answer, changed(answer, nanoseconds, -1), connection_, nullptr),
            std::nullopt);
  const char* packet = "/entries/0/elements/1/value/0";
  EXPECT_NE(comparison_.difference(answer, changed(answer, packet, 0.5), connection_, nullptr),
            std::nullopt);
}

TEST_F(ComparisonTest, AGeneratorIndexMayDifferButMustStayTheSame) {
  const auto& frames = captures().find("generators", "v4")->frames;
  const auto is_given = [](const Frame& one) {
    return is(one, EntryType::function_call_res) && one.entries()[0].at("error") == 0;
  };
  const Frame& given = *std::find_if(frames.begin(), frames.end(), is_given);
  const Frame& step = frames.at(static_cast<std::size_t>(given.number) + 1);
  ASSERT_TRUE(is(step, EntryType::generator_next_req));
  const char* index = "/entries/0/elements/0/value/0";
  EXPECT_EQ(comparison_.difference(given, changed(given, index, 7), connection_, nullptr),
            std::nullopt);
  EXPECT_EQ(addressed(step, connection_), changed(step, index, 7));
  const Frame& close = captures().find("generators", "v4")->frames.at(21);
  ASSERT_TRUE(is(close, EntryType::generator_next_req));
  EXPECT_EQ(addressed(close, connection_), close.bytes);  // of another generator
}

}  // namespace
}  // namespace rr::conformance
