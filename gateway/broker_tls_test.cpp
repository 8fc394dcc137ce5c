// SPDX-License-Identifier: Apache-2.0
// TLS to real brokers, with certificates of an authority that the test makes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "gateway/properties.hpp"
#include "gateway/testing/broker_kinds.hpp"
#include "gateway/testing/certificates.hpp"
#include "gateway/testing/listener.hpp"
#include "gateway/testing/rig.hpp"
#include "rr/error.hpp"

namespace rr::gateway {
namespace {

using testing::Folder;
using ::testing::HasSubstr;
using testing::Listener;
using testing::OverBroker;
using testing::Rig;
using testing::TestAuthority;
using testing::value_comes;

class BrokersTls : public OverBroker {
 protected:
  /// Why a connection fails; empty when it is made.
  static std::string failure(const BrokerOptions& broker) {
    Listener listener;
    const auto carrier = make_carrier(broker);
    carrier->start(listener, {"life", {}});
    EXPECT_TRUE(testing::comes_true(
        [&] { return listener.connected.size() + listener.reasons.size() > 0; }));
    carrier->stop({});
    if (listener.connected.size() > 0) return {};
    return listener.reasons.size() > 0 ? listener.reasons.items()[0] : "nothing was reported";
  }

  const TestAuthority ours;
  const std::string certificate = ours.issue("hub", "DNS:hub,IP:127.0.0.1");
};

TEST_P(BrokersTls, MembersWorkThroughBothGateways) {
  const auto broker = GetParam().start({.certificate = certificate});
  Rig rig([&] { return make_carriers({.url = broker->url(true), .authority = ours.file()}); });
  const auto bench = rig.connect();
  EXPECT_EQ(bench->call("add", {1, 2}).as<double>(), 3);
  // More than one record of TLS, in both directions.
  const auto large = dynamic::Value::record({{"x", 1}, {"q", std::vector<double>(100'000, 0.5)}});
  bench->set("pose", large);
  EXPECT_EQ(bench->get("pose")["q"].at(99'999).as<double>(), 0.5);
  auto force = bench->wire("force").connect();
  rig.robot.bench().wire("force").set_in(2.5);
  EXPECT_TRUE(value_comes(force, 2.5));
}

TEST_P(BrokersTls, AnotherAuthorityIsRefused) {
  const auto broker = GetParam().start({.certificate = certificate});
  const TestAuthority theirs("Theirs");
  EXPECT_EQ(failure({.url = broker->url(true), .authority = theirs.file()}),
            broker->url(true) +
                ": the broker's certificate is refused: unable to get local issuer certificate "
                "(authorities: " +
                theirs.file() + ")");
  // Those of the system do not know it either.
  EXPECT_THAT(failure({broker->url(true)}), HasSubstr("(authorities: of the system)"));
  EXPECT_EQ(failure({.url = broker->url(true), .authority = ours.file()}), "");
}

TEST_P(BrokersTls, AnotherNameIsRefused) {
  const auto broker =
      GetParam().start({.certificate = ours.issue("other", "DNS:other,IP:127.0.0.2")});
  EXPECT_EQ(failure({.url = broker->url(true), .authority = ours.file()}),
            broker->url(true) + ": the broker's certificate is not for `127.0.0.1`");
}

TEST_P(BrokersTls, ACertificateThatHasRunOutIsRefused) {
  const auto broker = GetParam().start({.certificate = ours.issue("old", "IP:127.0.0.1", -1)});
  EXPECT_THAT(failure({.url = broker->url(true), .authority = ours.file()}),
              HasSubstr("the broker's certificate is refused: certificate has expired"));
}

TEST_P(BrokersTls, AWrongPasswordIsRefused) {
  const auto broker = GetParam().start({.users = {{"robot", "one"}}, .certificate = certificate});
  BrokerOptions options{
      .url = broker->url(true), .user = "robot", .password = "two", .authority = ours.file()};
  EXPECT_EQ(failure(options),
            broker->url(true) +
                ": the broker refuses user `robot` or the password: " + GetParam().refused_user);
  options.user.clear();
  EXPECT_EQ(failure(options),
            broker->url(true) +
                ": the broker refuses a connection without a user: " + GetParam().refused_user);
  options.user = "robot";
  options.password = "one";
  EXPECT_EQ(failure(options), "");
}

TEST_P(BrokersTls, ABrokerMayAskForACertificate) {
  const auto broker =
      GetParam().start({.certificate = certificate, .client_authority = ours.file()});
  BrokerOptions options{.url = broker->url(true), .authority = ours.file()};
  // "certificate required", unless the end of the connection overtakes that.
  EXPECT_THAT(failure(options), HasSubstr("certificate"));
  options.certificate = ours.issue("robot", "DNS:robot");
  EXPECT_EQ(failure(options), "");
}

TEST_P(BrokersTls, ABrokerWithoutTlsIsReported) {
  const auto broker = GetParam().start();
  EXPECT_THAT(failure({.url = broker->url(true), .authority = ours.file()}),
              HasSubstr("it speaks no TLS"));
}

TEST_P(BrokersTls, ABrokerThatIsNotThereIsReported) {
  const auto broker = GetParam().start();
  broker->kill();
  EXPECT_EQ(failure({broker->url()}), broker->url() + ": " + GetParam().no_server);
  EXPECT_EQ(failure({broker->url(true)}), broker->url(true) + ": " + GetParam().no_server_tls);
}

TEST_P(BrokersTls, ACertificateIsReplacedWhileItRuns) {
  const Folder folder;
  const std::string replaced = folder.path() + "/hub.pem";
  std::filesystem::copy_file(ours.issue("early", "DNS:other"), replaced);
  const auto broker = GetParam().start({.certificate = replaced});
  Listener listener;
  const auto carrier = make_carrier({.url = broker->url(true), .authority = ours.file()});
  carrier->start(listener, {"life", {}});
  ASSERT_TRUE(listener.reasons.wait_for(1));
  broker->kill();
  std::filesystem::copy_file(certificate, replaced,
                             std::filesystem::copy_options::overwrite_existing);
  broker->start();
  EXPECT_TRUE(listener.connected.wait_for(1));
  carrier->stop({});
}

TEST_P(BrokersTls, FilesThatCannotBeUsedAreReportedAtOnce) {
  const TestAuthority authority;
  const auto mistake = [](const BrokerOptions& broker) -> std::string {
    try {
      static_cast<void>(make_carrier(broker));
    } catch (const Error& error) {
      return error.message();
    }
    return "none";
  };
  const std::string url = GetParam().scheme == "nats" ? "tls://hub" : "mqtts://hub";
  const std::string robot = authority.issue("robot", "DNS:robot");
  EXPECT_EQ(mistake({.url = url, .authority = authority.file(), .certificate = robot}), "none");
  EXPECT_THAT(mistake({.url = url, .authority = "/nowhere/ca.pem"}),
              HasSubstr("/nowhere/ca.pem: no certificate authority: "));
  EXPECT_THAT(mistake({.url = url, .certificate = "/nowhere/robot.pem"}),
              HasSubstr("/nowhere/robot.pem: no certificate: "));
  EXPECT_THAT(mistake({.url = url, .certificate = authority.file()}),
              HasSubstr("ca.pem: no key of the certificate: "));
  const std::string other = authority.issue("other", "DNS:other");
  EXPECT_THAT(mistake({.url = url, .certificate = robot, .key = other}),
              HasSubstr("other.pem: no key of the certificate: key values mismatch"));
  EXPECT_THAT(mistake({.url = url, .key = robot}), HasSubstr("a key without a `certificate`"));
  const std::string plain = GetParam().scheme + "://hub";
  EXPECT_THAT(mistake({.url = plain, .authority = authority.file()}),
              HasSubstr("`" + plain + "` is not encrypted"));
}

INSTANTIATE_TEST_SUITE_P(All, BrokersTls, ::testing::ValuesIn(testing::broker_kinds()),
                         testing::name_of_kind);

}  // namespace
}  // namespace rr::gateway
