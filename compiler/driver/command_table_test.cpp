// SPDX-License-Identifier: Apache-2.0
// What a compiler without the commands for running services does.
#include "compiler/driver/command_table.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>
#include <string>
#include <vector>

#include "compiler/driver/run.hpp"

namespace robdef {
namespace {

using testing::HasSubstr;
using testing::Not;

struct Said {
  ExitStatus status{};
  std::string out{};
  std::string err{};
};

Said said_to(const std::vector<std::string>& arguments) {
  std::ostringstream out;
  std::ostringstream err;
  const ExitStatus status = run(arguments, "", compiler_commands(), out, err);
  return {status, out.str(), err.str()};
}

TEST(CompilerAlone, HasNoCommandsForServices) {
  EXPECT_THAT(said_to({"--help"}).out, Not(HasSubstr("discover")));
  const Said get = said_to({"get", "rr+tcp://localhost", "x"});
  EXPECT_EQ(get.status, exit_usage);
  EXPECT_THAT(get.err, HasSubstr("unknown command `get`"));
  EXPECT_EQ(said_to({"breaking", "--user=a", "old", "new"}).status, exit_usage);
}

TEST(CompilerAlone, SaysThatItConnectsToNothing) {
  const Said breaking = said_to({"breaking", "rr+tcp://localhost:1", "rr+tcp://localhost:2"});
  EXPECT_EQ(breaking.status, exit_usage);
  EXPECT_THAT(breaking.err, HasSubstr("rr+tcp://localhost:1: this robdef is the compiler alone"));
}

}  // namespace
}  // namespace robdef
