// SPDX-License-Identifier: Apache-2.0
// Who is let in with TLS, and what those hear that are not.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <string>
#include <thread>

#include "rr/authority.hpp"
#include "runtime/cpp/src/node/testing/pair.hpp"
#include "runtime/cpp/src/node/testing/raw_socket.hpp"

namespace rr::testing {
namespace {

using ::testing::HasSubstr;

class TlsRefuses : public ::testing::Test {
 protected:
  TlsRefuses() {
    static int count = 0;
    authority = std::make_unique<Authority>(
        Authority::create(test_folder() + "/own" + std::to_string(count)));
    stranger = std::make_unique<Authority>(
        Authority::create(test_folder() + "/other" + std::to_string(count++)));
  }

  NodeOptions server_options(Authority& by, Authority::Days validity = Authority::Days(10)) const {
    NodeOptions options;
    options.id = NodeId::random();
    options.tls.certificate_file = by.issue(options.id, validity);
    options.tls.authority_files = {authority->certificate_file()};
    options.tls.revocation_files = {authority->revocation_file()};
    return options;
  }
  NodeOptions client_options() const {
    NodeOptions options;
    options.tls.authority_files = {authority->certificate_file()};
    options.tls.revocation_files = {authority->revocation_file()};
    return options;
  }
  static std::unique_ptr<Node> serve(NodeOptions options, std::uint16_t& port) {
    auto node = std::make_unique<Node>(std::move(options));
    node->register_service("counter", std::make_shared<Counter>());
    port = node->listen_tcp(0, "127.0.0.1");
    return node;
  }
  static std::string url(std::uint16_t port, const std::string& scheme = "rrs+tcp") {
    return scheme + "://127.0.0.1:" + std::to_string(port) + "/?service=counter";
  }
  static std::string refusal(Node& client, const std::string& url) {
    return error_of([&] { client.connect<CounterStub>(url); }).message();
  }

  std::unique_ptr<Authority> authority;
  std::unique_ptr<Authority> stranger;
};

TEST_F(TlsRefuses, NobodyWhoIsRight) {
  std::uint16_t port = 0;
  const auto server = serve(server_options(*authority), port);
  Node client(client_options());
  for (const char* scheme : {"rrs+tcp", "rrs+ws", "rr+wss", "rrs+wss"}) {
    if (std::string(scheme) == "rrs+wss") continue;  // TLS in TLS is not served
    EXPECT_EQ(client.connect<CounterStub>(url(port, scheme))->add(1, 2), 3) << scheme;
  }
  Node mutual(server_options(*authority));
  EXPECT_EQ(mutual.connect<CounterStub>(url(port))->add(1, 2), 3);
}

TEST_F(TlsRefuses, ACertificateOfAnotherAuthority) {
  std::uint16_t port = 0;
  const auto server = serve(server_options(*stranger), port);
  Node client(client_options());
  EXPECT_THAT(refusal(client, url(port)), HasSubstr("an authority that this node does not trust"));
}

TEST_F(TlsRefuses, ACertificateThatHasExpired) {
  std::uint16_t port = 0;
  const auto server = serve(server_options(*authority, Authority::Days(-1)), port);
  Node client(client_options());
  EXPECT_THAT(refusal(client, url(port)), HasSubstr("has expired, on 20"));
}

TEST_F(TlsRefuses, ACertificateThatWasRevokedMeanwhile) {
  std::uint16_t port = 0;
  const auto server = serve(server_options(*authority), port);
  Node client(client_options());
  EXPECT_EQ(client.connect<CounterStub>(url(port))->add(1, 2), 3);
  std::this_thread::sleep_for(std::chrono::milliseconds(20));  // the file's time has steps
  authority->revoke(server->id());
  EXPECT_THAT(refusal(client, url(port)), HasSubstr("has been revoked"));
}

TEST_F(TlsRefuses, ANodeThatIsNotTheOneWanted) {
  std::uint16_t port = 0;
  const auto server = serve(server_options(*authority), port);
  Node client(client_options());
  const NodeId other = NodeId::random();
  EXPECT_THAT(refusal(client, url(port) + "&nodeid=" + other.text()), HasSubstr("Node not found"));
  // By the rules of the web there is no such question before.
  EXPECT_THAT(refusal(client, url(port, "rr+wss") + "&nodeid=" + other.text()),
              HasSubstr("is of node " + server->id().text() + ", not of " + other.text()));
}

TEST_F(TlsRefuses, ToStartWithACertificateOfAnotherNode) {
  NodeOptions options = server_options(*authority);
  options.id = NodeId::random();
  const Error error = error_of([&] { Node node(options); });
  EXPECT_EQ(error.code(), ErrorCode::invalid_configuration);
  EXPECT_THAT(error.message(), HasSubstr("the certificate is of node "));
}

TEST_F(TlsRefuses, AServerThatHasNoCertificate) {
  std::uint16_t port = 0;
  const auto server = serve({}, port);
  Node client(client_options());
  EXPECT_THAT(refusal(client, url(port)),
              HasSubstr("does not offer encryption: Server certificate not loaded"));
}

TEST_F(TlsRefuses, AClientInClearWhereItIsRequired) {
  std::uint16_t port = 0;
  NodeOptions options = server_options(*authority);
  options.tls.is_required = true;
  const auto server = serve(options, port);
  Node client(client_options());
  EXPECT_THAT(refusal(client, url(port, "rr+tcp")),
              HasSubstr("this node serves encrypted connections only"));
  EXPECT_THAT(refusal(client, url(port, "rr+ws")),
              HasSubstr("this node serves encrypted connections only"));
  EXPECT_EQ(client.connect<CounterStub>(url(port))->add(1, 2), 3);
}

TEST_F(TlsRefuses, AClientWithoutACertificateWhereOneIsWanted) {
  std::uint16_t port = 0;
  NodeOptions options = server_options(*authority);
  options.tls.must_certify_clients = true;
  const auto server = serve(options, port);
  Node client(client_options());
  EXPECT_THAT(refusal(client, url(port)),
              HasSubstr("the other side wants a certificate of this node, which has none"));
  Node known(server_options(*authority));
  EXPECT_EQ(known.connect<CounterStub>(url(port))->add(1, 2), 3);
  NodeOptions unknown = server_options(*stranger);
  Node other(unknown);
  EXPECT_THAT(refusal(other, url(port)),
              HasSubstr("does not trust the authority of this node's certificate"));
}

TEST_F(TlsRefuses, AnotherCertificateThanThePinnedOne) {
  std::uint16_t port = 0;
  const auto server = serve(server_options(*authority), port);
  NodeOptions options = client_options();
  options.tls.pins[server->id()] = std::string(64, '0');
  Node client(options);
  EXPECT_THAT(refusal(client, url(port)), HasSubstr("is not the one that is pinned"));
}

TEST_F(TlsRefuses, ARecordOfTlsThatIsNone) {
  std::uint16_t port = 0;
  const auto server = serve(server_options(*authority), port);
  const RawSocket peer(port);
  peer.send(std::string("\x16\x03\x01\x00\x05hello", 10));  // no ClientHello
  const std::string answer = peer.receive_all();
  ASSERT_FALSE(answer.empty());
  EXPECT_EQ(answer.front(), '\x15');  // an alert
}

}  // namespace
}  // namespace rr::testing
