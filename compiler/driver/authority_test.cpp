// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "compiler/driver/run.hpp"

namespace robdef {
namespace {

using ::testing::HasSubstr;

class AuthorityCommand : public ::testing::Test {
 protected:
  AuthorityCommand() {
    std::string name = (std::filesystem::temp_directory_path() / "robdef-ca-XXXXXX").string();
    folder = mkdtemp(name.data());
  }
  ~AuthorityCommand() override { std::filesystem::remove_all(folder); }

  ExitStatus call(const std::vector<std::string>& arguments) {
    out.str("");
    err.str("");
    return run(arguments, "", out, err);
  }

  const std::string node = "11111111-2222-3333-4444-555555555555";
  std::string folder;
  std::ostringstream out;
  std::ostringstream err;
};

TEST_F(AuthorityCommand, MakesAnAuthorityAndCertificatesAndRevokesThem) {
  EXPECT_EQ(call({"ca", "init", folder + "/own"}), exit_fine) << err.str();
  EXPECT_EQ(out.str(), folder + "/own/ca.pem\n");
  EXPECT_EQ(call({"ca", "init", folder + "/own"}), exit_errors);
  EXPECT_THAT(err.str(), HasSubstr("has an authority already"));
  EXPECT_EQ(call({"ca", "issue", node, "--ca", folder + "/own", "--days", "10"}), exit_fine);
  EXPECT_EQ(out.str(), folder + "/own/nodes/" + node + ".pem\n");
  EXPECT_TRUE(std::filesystem::exists(folder + "/own/nodes/" + node + ".p12"));
  EXPECT_EQ(std::filesystem::status(folder + "/own/ca.key").permissions(),
            std::filesystem::perms(0600));
  EXPECT_EQ(call({"ca", "revoke", node, "--ca", folder + "/own"}), exit_fine);
  EXPECT_EQ(out.str(), folder + "/own/revoked.pem\n");
}

TEST_F(AuthorityCommand, SaysWhatItWants) {
  EXPECT_EQ(call({"ca", "issue"}), exit_usage);
  EXPECT_THAT(err.str(), HasSubstr("`issue NODE`"));
  EXPECT_EQ(call({"ca", "make", node}), exit_usage);
  EXPECT_EQ(call({"ca", "issue", "nobody"}), exit_usage);
  EXPECT_EQ(call({"ca", "issue", node, "--days", "0"}), exit_usage);
  EXPECT_EQ(call({"ca", "issue", node, "--ca", folder}), exit_errors);
}

}  // namespace
}  // namespace robdef
