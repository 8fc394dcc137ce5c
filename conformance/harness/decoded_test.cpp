// SPDX-License-Identifier: Apache-2.0
#include "conformance/harness/decoded.hpp"

#include <gtest/gtest.h>

#include "conformance/harness/captures.hpp"

namespace rr::conformance {
namespace {

TEST(Decoded, EveryRecordedFrameGoesBothWays) {
  const Captures captures = read_captures(CONFORMANCE_CAPTURES);
  int frames = 0;
  for (const Scenario& scenario : captures.scenarios) {
    for (const Frame& frame : scenario.frames) {
      rr::MessageTree tree;
      ASSERT_TRUE(rr::read_tree(frame.bytes, tree)) << scenario.name << " " << frame.number;
      EXPECT_EQ(json_of_message(tree), frame.decoded) << scenario.name << " " << frame.number;
      EXPECT_EQ(rr::write_tree(message_of_json(frame.decoded)), frame.bytes);
      ++frames;
    }
  }
  EXPECT_EQ(frames, 5572);  // 30 of them in frames of web sockets
}

TEST(Decoded, AFieldThatIsMissingIsNoticed) {
  EXPECT_THROW(message_of_json(Json::parse(R"({"header":{"version":2}})")), Json::exception);
  EXPECT_THROW(
      message_of_json(Json::parse(R"({"header":{"version":2,"sender_node_id":"x"},"entries":[]})")),
      std::runtime_error);
}

}  // namespace
}  // namespace rr::conformance
