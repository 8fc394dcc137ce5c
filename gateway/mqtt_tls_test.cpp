// SPDX-License-Identifier: Apache-2.0
// TLS to a real broker, with certificates of an authority that the test makes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "gateway/mqtt_carrier.hpp"
#include "gateway/properties.hpp"
#include "gateway/testing/certificates.hpp"
#include "gateway/testing/listener.hpp"
#include "gateway/testing/mosquitto_broker.hpp"
#include "gateway/testing/rig.hpp"
#include "rr/error.hpp"

namespace rr::gateway {
namespace {

using testing::Folder;
using ::testing::HasSubstr;
using testing::Listener;
using testing::MosquittoBroker;
using testing::Rig;
using testing::TestAuthority;

class MosquittoTls : public ::testing::Test {
 protected:
  void SetUp() override {
    if (MosquittoBroker::program().empty()) GTEST_SKIP() << "mosquitto is not installed";
  }

  static std::string configuration(const std::string& certificate, const std::string& more = "") {
    return "certfile " + certificate + "\nkeyfile " + certificate + "\n" +
           (more.empty() ? "allow_anonymous true\n" : more);
  }
  /// Why a connection fails; empty when it is made.
  static std::string failure(const BrokerOptions& broker) {
    Listener listener;
    const auto carrier = make_mqtt_carrier(broker);
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

TEST_F(MosquittoTls, MembersWorkThroughBothGateways) {
  const MosquittoBroker broker(configuration(certificate));
  Rig rig(
      [&] { return make_mqtt_carrier({.url = broker.url("mqtts"), .authority = ours.file()}); });
  const auto bench = rig.connect();
  EXPECT_EQ(bench->call("add", {1, 2}).as<double>(), 3);
  // More than one record of TLS, in both directions.
  const auto large = dynamic::Value::record({{"x", 1}, {"q", std::vector<double>(100'000, 0.5)}});
  bench->set("pose", large);
  EXPECT_EQ(bench->get("pose")["q"].at(99'999).as<double>(), 0.5);
}

TEST_F(MosquittoTls, AnotherAuthorityIsRefused) {
  const MosquittoBroker broker(configuration(certificate));
  const TestAuthority theirs("Theirs");
  EXPECT_EQ(failure({.url = broker.url("mqtts"), .authority = theirs.file()}),
            broker.url("mqtts") +
                ": the broker's certificate is refused: unable to get local issuer certificate "
                "(authorities: " +
                theirs.file() + ")");
  // Those of the system do not know it either.
  EXPECT_THAT(failure({broker.url("mqtts")}), HasSubstr("(authorities: of the system)"));
  EXPECT_EQ(failure({.url = broker.url("mqtts"), .authority = ours.file()}), "");
}

TEST_F(MosquittoTls, AnotherNameIsRefused) {
  const MosquittoBroker broker(configuration(ours.issue("other", "DNS:other,IP:127.0.0.2")));
  EXPECT_EQ(failure({.url = broker.url("mqtts"), .authority = ours.file()}),
            broker.url("mqtts") + ": the broker's certificate is not for `127.0.0.1`");
}

TEST_F(MosquittoTls, ACertificateThatHasRunOutIsRefused) {
  const MosquittoBroker broker(configuration(ours.issue("old", "IP:127.0.0.1", -1)));
  EXPECT_THAT(failure({.url = broker.url("mqtts"), .authority = ours.file()}),
              HasSubstr("the broker's certificate is refused: certificate has expired"));
}

TEST_F(MosquittoTls, AWrongPasswordIsRefused) {
  const Folder folder;
  const std::string users = testing::make_passwords(folder, "robot:one\n");
  const MosquittoBroker broker(
      configuration(certificate, "allow_anonymous false\npassword_file " + users + "\n"));
  BrokerOptions options{
      .url = broker.url("mqtts"), .user = "robot", .password = "two", .authority = ours.file()};
  EXPECT_EQ(failure(options),
            broker.url("mqtts") +
                ": the broker refuses user `robot` or the password: " + "Not authorized");
  options.user.clear();
  EXPECT_EQ(failure(options),
            broker.url("mqtts") +
                ": the broker refuses a connection without a user: " + "Not authorized");
  options.user = "robot";
  options.password = "one";
  EXPECT_EQ(failure(options), "");
}

TEST_F(MosquittoTls, ABrokerMayAskForACertificate) {
  const MosquittoBroker broker(configuration(
      certificate, "require_certificate true\nuse_identity_as_username true\ncafile " +
                       ours.file() + "\nallow_anonymous false\n"));
  BrokerOptions options{.url = broker.url("mqtts"), .authority = ours.file()};
  // "certificate required", unless the end of the connection overtakes that.
  EXPECT_THAT(failure(options), HasSubstr("certificate"));
  options.certificate = ours.issue("robot", "DNS:robot");
  EXPECT_EQ(failure(options), "");
}

TEST_F(MosquittoTls, ABrokerWithoutTlsIsReported) {
  const MosquittoBroker broker;
  EXPECT_THAT(failure({.url = broker.url("mqtts"), .authority = ours.file()}),
              HasSubstr("it speaks no TLS"));
}

TEST_F(MosquittoTls, ABrokerThatIsNotThereIsReported) {
  MosquittoBroker broker;
  broker.kill();
  EXPECT_EQ(failure({broker.url()}), broker.url() + ": Connection refused");
  EXPECT_EQ(failure({broker.url("mqtts")}),
            broker.url("mqtts") + ": no server at its port, or it speaks no TLS");
}

TEST_F(MosquittoTls, ACertificateIsReplacedWhileItRuns) {
  const Folder folder;
  const std::string replaced = folder.path() + "/hub.pem";
  std::filesystem::copy_file(ours.issue("early", "DNS:other"), replaced);
  MosquittoBroker broker(configuration(replaced));
  Listener listener;
  const auto carrier = make_mqtt_carrier({.url = broker.url("mqtts"), .authority = ours.file()});
  carrier->start(listener, {"life", {}});
  ASSERT_TRUE(listener.reasons.wait_for(1));
  broker.kill();
  std::filesystem::copy_file(certificate, replaced,
                             std::filesystem::copy_options::overwrite_existing);
  broker.start();
  EXPECT_TRUE(listener.connected.wait_for(1));
  carrier->stop({});
}

TEST(MqttTlsFiles, ThatCannotBeUsedAreReportedAtOnce) {
  const TestAuthority authority;
  const auto mistake = [](const BrokerOptions& broker) -> std::string {
    try {
      static_cast<void>(make_mqtt_carrier(broker));
    } catch (const Error& error) {
      return error.message();
    }
    return "none";
  };
  const std::string url = "mqtts://hub";
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
  EXPECT_THAT(mistake({.url = "mqtt://hub", .authority = authority.file()}),
              HasSubstr("`mqtt://hub` is not encrypted"));
}

}  // namespace
}  // namespace rr::gateway
