// SPDX-License-Identifier: Apache-2.0
// The commands that connect, with TLS.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "cli/live/testing/bench_service.hpp"
#include "compiler/driver/program.hpp"
#include "rr/authority.hpp"
#include "rr/node.hpp"

namespace robdef::testing {
namespace {

using ::testing::HasSubstr;

class CommandsWithTls : public ::testing::Test {
 protected:
  CommandsWithTls() : authority_(rr::Authority::create((files_.path() / "ca").string())) {}

  void serve(bool must_certify) {
    rr::NodeOptions options;
    options.id = rr::NodeId::random();
    options.tls.certificate_file = authority_.issue(options.id);
    options.tls.authority_files = {authority_.certificate_file()};
    options.tls.must_certify_clients = must_certify;
    node_ = std::make_unique<rr::Node>(options);
    node_->register_service("bench", std::make_shared<Bench>());
    port_ = node_->listen_tcp(0, "127.0.0.1");
  }
  std::string url(const std::string& scheme) const {
    return scheme + "://127.0.0.1:" + std::to_string(port_) + "/?service=bench";
  }
  Ended get(std::vector<std::string> options, const std::string& scheme = "rrs+tcp") {
    options.insert(options.begin(), "get");
    options.insert(options.end(), {url(scheme), "fixed"});
    return run_robdef(files_, options);
  }

  TemporaryFolder files_;
  rr::Authority authority_;
  std::unique_ptr<rr::Node> node_;
  std::uint16_t port_ = 0;
};

TEST_F(CommandsWithTls, TrustTheAuthorityThatTheyAreGiven) {
  serve(false);
  const Ended trusted = get({"--tls-authority", authority_.certificate_file()});
  EXPECT_EQ(trusted.out, "42.125\n") << trusted.err;
  const Ended unknown = get({});
  EXPECT_EQ(unknown.status, 1);
  EXPECT_THAT(unknown.err, HasSubstr("an authority that this node does not trust"));
  authority_.revoke(node_->id());
  const Ended revoked = get({"--tls-authority", authority_.certificate_file(), "--tls-revocation",
                             authority_.revocation_file()});
  EXPECT_EQ(revoked.status, 1);
  EXPECT_THAT(revoked.err, HasSubstr("has been revoked"));
}

TEST_F(CommandsWithTls, ShowTheirCertificate) {
  serve(true);
  const std::string trust = authority_.certificate_file();
  EXPECT_EQ(get({"--tls-authority", trust}).status, 1);
  const std::string own = authority_.issue(rr::NodeId::random());
  const Ended shown = get({"--tls-authority", trust, "--tls-certificate", own});
  EXPECT_EQ(shown.out, "42.125\n") << shown.err;
  const Ended keyed = get({"--tls-authority", trust, "--tls-certificate", own, "--tls-key", own});
  EXPECT_EQ(keyed.out, "42.125\n") << keyed.err;
}

TEST_F(CommandsWithTls, GoNowhereInClearWhenTheyMustNot) {
  serve(false);
  EXPECT_EQ(get({}, "rr+tcp").out, "42.125\n");
  const Ended refused = get({"--require-tls"}, "rr+tcp");
  EXPECT_EQ(refused.status, 1);
  EXPECT_THAT(refused.err, HasSubstr("this node requires TLS"));
}

TEST_F(CommandsWithTls, SayWhichFilesCannotBeUsed) {
  serve(false);
  const Ended missing = get({"--tls-authority", "none.pem"});
  EXPECT_EQ(missing.status, 1);
  EXPECT_THAT(missing.err, HasSubstr("none.pem"));
  const Ended alone = get({"--tls-key", "key.pem"});
  EXPECT_EQ(alone.status, 2);
  EXPECT_THAT(alone.err, HasSubstr("`--tls-key` needs `--tls-certificate`"));
}

}  // namespace
}  // namespace robdef::testing
