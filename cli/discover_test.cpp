// SPDX-License-Identifier: Apache-2.0
// The command `discover`, as a user runs it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <rr/discovery.hpp>
#include <rr/node.hpp>
#include <string>
#include <vector>

#include "compiler/driver/program.hpp"
#include "runtime/cpp/src/discovery/testing.hpp"
#include "runtime/cpp/src/node/testing/pair.hpp"

namespace robdef {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

/// A counter that can be discovered, at a port of the test's own.
class Discover : public ::testing::Test {
 protected:
  Discover() : node_({.name = "counter.node"}) {
    node_.register_service("counter", std::make_shared<rr::testing::Counter>());
    node_.listen_tcp(0, "127.0.0.1");
    node_.discovery().announce({.network = network_, .period = std::chrono::milliseconds(500)});
  }
  [[nodiscard]] Ended run(std::vector<std::string> more) const {
    std::vector<std::string> arguments = {"discover", "--once",
                                          "--ipv4",   "--interface",
                                          "lo",       "--port=" + std::to_string(network_.port)};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_robdef(folder_, arguments);
  }

  TemporaryFolder folder_;
  rr::DiscoveryNetwork network_ = rr::discovery::loopback_network();
  rr::Node node_;
};

TEST_F(Discover, ShowsNodesAndTheirServices) {
  const Ended ended = run({});
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_THAT(ended.out,
              AllOf(HasSubstr("node " + node_.id().text() + " counter.node\n"),
                    HasSubstr("  service counter (test.counter.Counter) at counter.node"),
                    HasSubstr("&service=counter\n")));
}

TEST_F(Discover, ShowsServicesOfATypeAsJson) {
  const Ended ended = run({"--type", "test.counter.Named", "--format=json"});
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_THAT(ended.out, AllOf(HasSubstr("\"id\": \"" + node_.id().text() + "\""),
                               HasSubstr("\"name\": \"counter\""),
                               HasSubstr("\"type\": \"test.counter.Counter\""),
                               Not(HasSubstr("\"name\": \"RobotRaconteurServiceIndex\""))));
  EXPECT_EQ(run({"--type=no.Such", "--format=json", "--wait=1"}).out, "{\n  \"nodes\": []\n}\n");
}

TEST_F(Discover, RefusesWhatItDoesNotKnow) {
  EXPECT_EQ(run({"file"}).status, 2);
  EXPECT_EQ(run({"--format=line"}).status, 2);
  EXPECT_EQ(run({"--wait=x"}).status, 2);
}

}  // namespace
}  // namespace robdef
