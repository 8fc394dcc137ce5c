// SPDX-License-Identifier: Apache-2.0
// Who somebody is, by what he has proved.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <stdlib.h>

#include <array>
#include <cctype>
#include <cstdio>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "rr/authority.hpp"
#include "rr/message_tree.hpp"
#include "runtime/cpp/src/channel/openssl_tls.hpp"
#include "runtime/cpp/src/channel/testing/host_proxy.hpp"
#include "runtime/cpp/src/node/testing/pair.hpp"
#include "runtime/cpp/src/node/testing/raw_peer.hpp"
#include "runtime/cpp/src/replay/stream.hpp"

namespace rr::testing {
namespace {

using replay::Arrival;
using replay::Milliseconds;
using replay::Stream;
using ::testing::HasSubstr;

constexpr Milliseconds answer_limit{10'000};

std::string fresh_folder(const std::string& name) {
  static int count = 0;
  return test_folder() + "/" + name + std::to_string(count++);
}

class ClientThatRequiresTls : public ::testing::Test {
 protected:
  ClientThatRequiresTls() : authority(Authority::create(fresh_folder("required"))) {}
  NodeOptions options(bool is_certified) {
    NodeOptions result;
    result.tls.authority_files = {authority.certificate_file()};
    result.tls.is_required = true;
    if (!is_certified) return result;
    result.id = NodeId::random();
    result.tls.certificate_file = authority.issue(result.id);
    return result;
  }
  Authority authority;
};

TEST_F(ClientThatRequiresTls, SaysNothingInClear) {
  replay::Listener listener(0);
  Node client(options(false));
  for (const std::string scheme : {"rr+tcp", "rr+ws", "tcp"}) {
    const std::string url = scheme + "://127.0.0.1:" + std::to_string(listener.port()) +
                            (scheme == "tcp" ? "//counter" : "/?service=counter");
    const Error error = error_of([&] {
      client.connect<CounterStub>(url, {.username = "alice", .credentials = {{"password", "x"}}});
    });
    EXPECT_EQ(error.code(), ErrorCode::connection_error) << url;
    EXPECT_THAT(error.message(), HasSubstr("this node requires TLS")) << url;
  }
  EXPECT_FALSE(listener.accept(Milliseconds(50)));  // nobody has come
}

TEST_F(ClientThatRequiresTls, ConnectsWithTlsAndWithinTheMachine) {
  NodeOptions serving = options(true);
  serving.local.user_run_dir = fresh_folder("run");
  Node server(serving);
  server.register_service("counter", std::make_shared<Counter>());
  const std::string port = std::to_string(server.listen_tcp(0, "127.0.0.1"));
  server.listen("rr+local://");
  server.listen("rr+intra://");
  NodeOptions asking = options(false);
  asking.local.user_run_dir = serving.local.user_run_dir;
  Node client(asking);
  const std::string id = "/?service=counter&nodeid=" + server.id().text();
  for (const std::string& url :
       {"rrs+tcp://127.0.0.1:" + port + id, "rrs+ws://127.0.0.1:" + port + id,
        "rr+wss://127.0.0.1:" + port + id, "rr+local://" + id, "rr+intra://" + id}) {
    EXPECT_EQ(client.connect<CounterStub>(url)->add(1, 2), 3) << url;
  }
}

TEST_F(ClientThatRequiresTls, DoesNotFallBackInASubscription) {
  Node server;
  server.register_service("counter", std::make_shared<Counter>());
  const std::string port = std::to_string(server.listen_tcp(0, "127.0.0.1"));
  Node client(options(false));
  ServiceSubscription counter =
      client.subscribe("rr+tcp://127.0.0.1:" + port + "/?service=counter");
  ASSERT_TRUE(eventually([&] { return counter.last_error().has_value(); }));
  EXPECT_THAT(counter.last_error()->message(), HasSubstr("this node requires TLS"));
}

TEST_F(ClientThatRequiresTls, ServesNoAdoptedSocketInClearEither) {
  Node server(options(true));
  server.register_service("counter", std::make_shared<Counter>());
  int adopted = -1;
  RawPeer peer(RawPeer::Paired{adopted});
  server.adopt(adopted);
  peer.ask_for_node_info();
  EXPECT_EQ(peer.next_type(), EntryType::null);
  EXPECT_TRUE(peer.is_closed());
}

/// A node behind a web server that has a host's certificate.
class HostsCertificate : public ::testing::Test {
 protected:
  HostsCertificate() {
    make_host_certificate(file);
    server.register_service("counter", std::make_shared<Counter>());
    proxy = std::make_unique<HostProxy>(file, server.listen_tcp(0, "127.0.0.1"));
  }
  ~HostsCertificate() override { unsetenv("SSL_CERT_FILE"); }
  std::string url(const NodeId& node = {}) const {
    return "rr+wss://localhost:" + std::to_string(proxy->port()) + "/?service=counter" +
           (node.is_any() ? std::string() : "&nodeid=" + node.text());
  }
  std::string refusal(Node& client, const std::string& at) const {
    return error_of([&] { client.connect<CounterStub>(at); }).message();
  }
  NodeOptions trusting() const {
    NodeOptions options;
    options.tls.authority_files = {file};
    return options;
  }
  std::string fingerprint() const {
    const std::string command = "openssl x509 -in " + file + " -noout -fingerprint -sha256";
    const std::unique_ptr<FILE, int (*)(FILE*)> output(popen(command.c_str(), "r"), &pclose);
    std::array<char, 256> text{};
    const char* const line = fgets(text.data(), text.size(), output.get());
    std::string digits;
    for (const char c : std::string(line == nullptr ? "" : line).substr(19)) {
      if (std::isxdigit(static_cast<unsigned char>(c)) != 0) digits += c;
    }
    return digits;
  }

  const std::string file = fresh_folder("host") + ".pem";
  Node server;
  std::unique_ptr<HostProxy> proxy;
};

TEST_F(HostsCertificate, ProvesTheHost) {
  Node client(trusting());
  EXPECT_EQ(client.connect<CounterStub>(url())->add(1, 2), 3);
}

TEST_F(HostsCertificate, ProvesNoNode) {
  Node client(trusting());
  EXPECT_THAT(refusal(client, url(server.id())),
              HasSubstr("does not prove that it is node " + server.id().text()));
}

TEST_F(HostsCertificate, ProvesTheNodeThatItIsPinnedFor) {
  NodeOptions options;  // whoever signed it
  options.tls.pins[server.id()] = fingerprint();
  Node client(options);
  EXPECT_EQ(client.connect<CounterStub>(url(server.id()))->add(1, 2), 3);
  EXPECT_EQ(client.connect<CounterStub>(url())->add(1, 2), 3);
  const NodeId other = NodeId::random();
  EXPECT_THAT(refusal(client, url(other)),
              HasSubstr("is of node " + server.id().text() + ", not of " + other.text()));
}

TEST_F(HostsCertificate, DoesNotStandForANodeThatIsPinnedToAnother) {
  NodeOptions options = trusting();
  options.tls.pins[server.id()] = std::string(64, 'a');
  Node client(options);
  EXPECT_THAT(refusal(client, url(server.id())), HasSubstr("is not the one that is pinned"));
  EXPECT_THAT(refusal(client, url()),
              HasSubstr("says that it is one whose certificate is another"));
}

TEST_F(HostsCertificate, IsNotSentWhatAFilterHasForANode) {
  SubscriptionOptions options;
  options.filter.nodes = {{.id = server.id(), .username = "alice"}};
  Node client(trusting());
  ServiceSubscription counter = client.subscribe(url(), options);
  ASSERT_TRUE(eventually([&] { return counter.last_error().has_value(); }));
  EXPECT_THAT(counter.last_error()->message(), HasSubstr("does not prove that it is node"));
}

TEST_F(HostsCertificate, OfTheSystemsAuthoritiesCountsWhereThereAreNoOthers) {
  setenv("SSL_CERT_FILE", file.c_str(), 1);
  Node client;
  EXPECT_EQ(client.connect<CounterStub>(url())->add(1, 2), 3);
  NodeOptions own;
  own.tls.authority_files = {Authority::create(fresh_folder("trusted")).certificate_file()};
  Node careful(own);
  EXPECT_THAT(refusal(careful, url()), HasSubstr("an authority that this node does not trust"));
  own.tls.trust_system_authorities = true;
  Node both(own);
  EXPECT_EQ(both.connect<CounterStub>(url())->add(1, 2), 3);
  NodeOptions off;
  off.tls.trust_system_authorities = false;
  Node nobody(off);
  EXPECT_THAT(refusal(nobody, url()), HasSubstr("an authority that this node does not trust"));
}

class CertifiedClient : public ::testing::Test {
 protected:
  CertifiedClient() : authority(Authority::create(fresh_folder("client"))) {
    NodeOptions options;
    options.id = NodeId::random();
    options.tls = certificate_of(options.id);
    options.tls.must_certify_clients = true;
    server = std::make_unique<Node>(options);
    server->register_service("counter", std::make_shared<Counter>(),
                             {.on_client_connected = [this](const ServiceClient& client) {
                               const std::lock_guard lock(mutex);
                               seen.push_back(client.node);
                             }});
    port = server->listen_tcp(0, "127.0.0.1");
  }
  TlsOptions certificate_of(const NodeId& id) {
    TlsOptions options;
    options.certificate_file = authority.issue(id);
    options.authority_files = {authority.certificate_file()};
    return options;
  }
  static MessageTree request(EntryType type, const std::string& member, const NodeId& sender) {
    MessageTree message;
    message.sender_node = sender;
    message.entries.resize(1);
    message.entries[0].type = type;
    message.entries[0].member = member;
    return message;
  }
  // Connects with a certificate, and says that it is `said`.
  void connect_as(const NodeId& certified, const NodeId& said) {
    const channel::OpenSslTls tls(certificate_of(certified), certified);
    Stream stream = Stream::connect("127.0.0.1", port);
    stream.send(write_tree(request(EntryType::stream_op, "STARTTLS", {})));
    replay::Bytes bytes;
    ASSERT_EQ(stream.receive(bytes, answer_limit), Arrival::message);
    stream.put(tls.make_client(server->id()), answer_limit);
    stream.send(write_tree(request(EntryType::stream_op, "CreateConnection", said)));
    ASSERT_EQ(stream.receive(bytes, answer_limit), Arrival::message);
    MessageTree connect = request(EntryType::connect_client, "", said);
    connect.entries[0].service_path = "counter";
    connect.entries[0].request_id = 1;
    connect.sender_endpoint = 7;
    stream.send(write_tree(connect));
    ASSERT_EQ(stream.receive(bytes, answer_limit), Arrival::message);
  }

  Authority authority;
  std::mutex mutex;
  std::vector<NodeId> seen;
  std::unique_ptr<Node> server;
  std::uint16_t port = 0;
};

TEST_F(CertifiedClient, IsKnownByItsCertificateWithoutSayingWhoItIs) {
  const NodeId certified = NodeId::random();
  connect_as(certified, certified);
  connect_as(certified, {});
  EXPECT_TRUE(eventually([&] {
    const std::lock_guard lock(mutex);
    return seen.size() == 2;
  }));
  EXPECT_EQ(seen, (std::vector<NodeId>{certified, certified}));
}

}  // namespace
}  // namespace rr::testing
