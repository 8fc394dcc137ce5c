// SPDX-License-Identifier: Apache-2.0
// TLS with peers that do what no node of ours does: each is refused by the check that is named.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <span>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>

#include "rr/authority.hpp"
#include "rr/message_tree.hpp"
#include "rr/url.hpp"
#include "runtime/cpp/src/channel/components.hpp"
#include "runtime/cpp/src/channel/layer.hpp"
#include "runtime/cpp/src/channel/openssl_tls.hpp"
#include "runtime/cpp/src/channel/web_socket.hpp"
#include "runtime/cpp/src/node/testing/pair.hpp"
#include "runtime/cpp/src/node/testing/silent_peer.hpp"
#include "runtime/cpp/src/replay/stream.hpp"

namespace rr::testing {
namespace {

using replay::Arrival;
using replay::Milliseconds;
using replay::Stream;
using ::testing::HasSubstr;

constexpr Milliseconds limit{10'000};

MessageTree operation(EntryType type, const std::string& member, const NodeId& sender) {
  MessageTree message;
  message.sender_node = sender;
  message.entries.resize(1);
  message.entries[0].type = type;
  message.entries[0].member = member;
  return message;
}

// Waits for a request of the connection itself, and answers it as a node.
void answer(Stream& stream, const std::string& member, const NodeId& as) {
  replay::Bytes bytes;
  MessageTree request;
  if (stream.receive(bytes, limit) != Arrival::message || !read_tree(bytes, request) ||
      request.entries.at(0).member != member) {
    throw std::runtime_error("no " + member);
  }
  stream.send(write_tree(operation(EntryType::stream_op_ret, member, as)));
}

class TlsPeer : public ::testing::Test {
 protected:
  TlsPeer() {
    static int count = 0;
    authority = std::make_unique<Authority>(
        Authority::create(test_folder() + "/peer" + std::to_string(count++)));
  }
  NodeOptions options_of(const NodeId& id) const {
    NodeOptions options;
    options.id = id;
    options.tls = certificate_of(id);
    return options;
  }
  TlsOptions certificate_of(const NodeId& id) const {
    TlsOptions options;
    options.certificate_file = authority->issue(id);
    options.authority_files = {authority->certificate_file()};
    return options;
  }
  // What a client of ours says about a service that does `serve` with its connection.
  std::string refusal(const std::function<void(Stream&)>& serve, const std::string& more = {}) {
    replay::Listener listener(0);
    const auto service = std::async(std::launch::async, [&] {
      auto stream = listener.accept(limit);
      if (!stream) return;
      try {
        serve(*stream);
        replay::Bytes bytes;
        while (stream->receive(bytes, limit) == Arrival::message) continue;
      } catch (const std::exception&) {
        // The client has gone.
      }
    });
    NodeOptions options;
    options.tls.authority_files = {authority->certificate_file()};
    Node client(options);
    const std::string url =
        "rrs+tcp://127.0.0.1:" + std::to_string(listener.port()) + "/?service=counter" + more;
    return error_of([&] { client.connect<CounterStub>(url); }).message();
  }
  // Encrypts as a server with the certificate of a node.
  void encrypt(Stream& stream, const NodeId& as) const {
    const channel::OpenSslTls tls(certificate_of(as), as);
    stream.put(tls.make_server(false), limit);
  }

  std::unique_ptr<Authority> authority;
  const NodeId wanted = NodeId::random();
  const NodeId other = NodeId::random();
};

// A server of several hosts chooses its certificate by the first record.
TEST(TlsNames, OfAHostAreInTheFirstRecord) {
  const SilentPeer peer;
  std::string first;
  std::thread server([&] {
    const int socket = peer.accept();
    std::array<char, 4096> bytes{};
    const ssize_t size = ::recv(socket, bytes.data(), bytes.size(), 0);
    if (size > 0) first.assign(bytes.data(), static_cast<std::size_t>(size));
    ::close(socket);
  });
  Node node;
  EXPECT_THROW(node.connect<CounterStub>("rr+wss://localhost:" + std::to_string(peer.port()) +
                                         "/?service=counter"),
               Error);
  server.join();
  EXPECT_THAT(first, HasSubstr("localhost"));
}

TEST_F(TlsPeer, WithTheCertificateOfAnotherNodeThanWasAskedForIsRefused) {
  const auto serve = [&](Stream& stream) {
    answer(stream, "STARTTLS", wanted);
    encrypt(stream, other);
  };
  const std::string text =
      "the other side's certificate is of node " + other.text() + ", not of " + wanted.text();
  EXPECT_THAT(refusal(serve, "&nodeid=" + wanted.text()), HasSubstr(text));
  // Who asks for any node means the one that has answered.
  EXPECT_THAT(refusal(serve), HasSubstr(text));
}

TEST_F(TlsPeer, ThatSaysItIsAnotherThanItsCertificateIsRefused) {
  EXPECT_THAT(refusal([&](Stream& stream) {
                answer(stream, "STARTTLS", wanted);
                encrypt(stream, wanted);
                answer(stream, "CreateConnection", other);
              }),
              HasSubstr("says that it is another than its certificate does"));
}

TEST_F(TlsPeer, ThatGoesOnInClearIsRefused) {
  EXPECT_THAT(
      refusal([&](Stream& stream) {
        answer(stream, "STARTTLS", wanted);
        stream.send(write_tree(operation(EntryType::stream_op_ret, "CreateConnection", wanted)));
      }),
      HasSubstr("the other side does not speak TLS"));
}

// The other direction: what comes to a service of ours.
class TlsClientPeer : public TlsPeer {
 protected:
  TlsClientPeer() {
    NodeOptions options = options_of(wanted);
    options.log = [this](LogLevel, std::string_view text) {
      const std::lock_guard lock(mutex);
      logged += std::string(text) + "\n";
    };
    server = std::make_unique<Node>(std::move(options));
    server->register_service("counter", std::make_shared<Counter>());
    port = server->listen_tcp(0, "127.0.0.1");
  }
  Stream start_tls() const {
    Stream stream = Stream::connect("127.0.0.1", port);
    stream.send(write_tree(operation(EntryType::stream_op, "STARTTLS", {})));
    replay::Bytes bytes;
    EXPECT_EQ(stream.receive(bytes, limit), Arrival::message);
    return stream;
  }
  std::string log() {
    const std::lock_guard lock(mutex);
    return logged;
  }
  bool is_served() {
    NodeOptions options;
    options.tls.authority_files = {authority->certificate_file()};
    Node client(options);
    const std::string url = "rrs+tcp://127.0.0.1:" + std::to_string(port) + "/?service=counter";
    return client.connect<CounterStub>(url)->add(1, 2) == 3;
  }

  std::mutex mutex;
  std::string logged;
  std::unique_ptr<Node> server;
  std::uint16_t port = 0;
};

TEST_F(TlsClientPeer, InClearBehindTheRequestForTlsIsNotServed) {
  Stream stream = start_tls();
  stream.send(write_tree(operation(EntryType::stream_op, "CreateConnection", other)));
  replay::Bytes bytes;
  EXPECT_EQ(stream.receive(bytes, limit), Arrival::closed);
  EXPECT_TRUE(eventually([&] { return log().find("does not speak TLS") != std::string::npos; }));
  EXPECT_TRUE(is_served());
}

TEST_F(TlsClientPeer, InOnePieceWithTheRequestForTlsIsNotServedEither) {
  Stream stream = Stream::connect("127.0.0.1", port);
  replay::Bytes bytes = write_tree(operation(EntryType::stream_op, "STARTTLS", {}));
  const auto more = write_tree(operation(EntryType::stream_op, "CreateConnection", other));
  bytes.insert(bytes.end(), more.begin(), more.end());
  stream.send(bytes);
  MessageTree message;
  for (Arrival arrival = stream.receive(bytes, limit); arrival == Arrival::message;
       arrival = stream.receive(bytes, limit)) {
    ASSERT_TRUE(read_tree(bytes, message));
    EXPECT_EQ(message.entries.at(0).member, "STARTTLS");
  }
  EXPECT_FALSE(stream.is_open());
}

// The layer of a client that also sends bytes in clear: with its second flight of the handshake, or
// before or behind the first record after it.
class SaysInClear final : public channel::Layer {
 public:
  enum class When { in_handshake, after_handshake, after_first_record };
  SaysInClear(std::unique_ptr<Layer> tls, When when, channel::Bytes bytes)
      : tls_(std::move(tls)), when_(when), bytes_(std::move(bytes)) {}

  void receive(std::span<const std::byte> wire, channel::Bytes& plain,
               channel::Bytes& reply) override {
    channel::Bytes flight;
    tls_->receive(wire, plain, flight);
    if (when_ == When::in_handshake && !flight.empty()) {
      channel::append(reply, std::exchange(bytes_, {}));
    }
    channel::append(reply, flight);
  }
  void send(std::span<const std::byte> plain, channel::Bytes& wire) override {
    if (when_ == When::after_handshake) channel::append(wire, std::exchange(bytes_, {}));
    tls_->send(plain, wire);
    channel::append(wire, std::exchange(bytes_, {}));
  }
  void begin(channel::Bytes& wire) override { tls_->begin(wire); }
  [[nodiscard]] bool is_open() const override { return tls_->is_open(); }
  [[nodiscard]] bool has_ended() const override { return tls_->has_ended(); }

 private:
  const std::unique_ptr<Layer> tls_;
  const When when_;
  channel::Bytes bytes_;
};

// A client that says something in clear besides TLS: what the service answers inside.
class TlsClientPeerInClear : public TlsClientPeer {
 protected:
  using When = SaysInClear::When;
  Arrival answer_of(When when, const replay::Bytes& in_clear, bool is_web = false) {
    const auto web = channel::make_web_sockets({});
    const channel::OpenSslTls tls(certificate_of(other), other);
    Stream stream = Stream::connect("127.0.0.1", port);
    if (is_web) {
      const std::string url = "rr+ws://127.0.0.1:" + std::to_string(port) + "/?service=counter";
      stream.put(web->make_client(Url::parse(url)), limit);
    }
    stream.send(request);
    replay::Bytes bytes;
    EXPECT_EQ(stream.receive(bytes, limit), Arrival::message);
    try {
      stream.put(std::make_unique<SaysInClear>(tls.make_client(wanted), when, in_clear), limit);
    } catch (const std::runtime_error&) {
      return Arrival::closed;
    }
    stream.send(write_tree(operation(EntryType::stream_op, "CreateConnection", other)));
    const Arrival arrival = stream.receive(bytes, limit);
    MessageTree message;
    if (arrival == Arrival::message && read_tree(bytes, message)) {
      EXPECT_EQ(message.entries.at(0).member, "CreateConnection");
      EXPECT_EQ(message.entries.at(0).error, 0);
    }
    return arrival;
  }

  const replay::Bytes request = write_tree(operation(EntryType::stream_op, "STARTTLS", other));
};

TEST_F(TlsClientPeerInClear, MayRepeatItsRequestForTlsOnceWithinTheHandshake) {
  EXPECT_EQ(answer_of(When::in_handshake, {}), Arrival::message);
  EXPECT_EQ(answer_of(When::in_handshake, request), Arrival::message);
  EXPECT_EQ(answer_of(When::in_handshake, request, true), Arrival::message);
}

TEST_F(TlsClientPeerInClear, MayNotRepeatItTwice) {
  replay::Bytes twice = request;
  channel::append(twice, request);
  EXPECT_EQ(answer_of(When::in_handshake, twice), Arrival::closed);
  EXPECT_TRUE(eventually([&] { return log().find("does not speak TLS") != std::string::npos; }));
}

TEST_F(TlsClientPeerInClear, MaySayNothingElseWithinTheHandshake) {
  replay::Bytes other_request = request;
  other_request.back() ^= std::byte{1};
  EXPECT_EQ(answer_of(When::in_handshake, other_request), Arrival::closed);
  EXPECT_EQ(answer_of(When::in_handshake,
                      write_tree(operation(EntryType::stream_op, "CreateConnection", other))),
            Arrival::closed);
}

// It may have been on its way before the last message of the handshake.
TEST_F(TlsClientPeerInClear, MayRepeatItUntilTheFirstRecord) {
  EXPECT_EQ(answer_of(When::after_handshake, request), Arrival::message);
  EXPECT_EQ(answer_of(When::after_first_record, request), Arrival::closed);
  EXPECT_TRUE(is_served());
}

TEST_F(TlsClientPeer, ThatSaysItIsAnotherThanItsCertificateIsNotServed) {
  const NodeId certified = NodeId::random();
  const channel::OpenSslTls tls(certificate_of(certified), certified);
  MessageTree request = operation(EntryType::stream_op, "STARTTLS", {});
  // A client with a certificate says so, or it is not asked for it.
  request.entries[0].elements.resize(1);
  request.entries[0].elements[0].name = "mutualauth";
  request.entries[0].elements[0].type = ElementType::string;
  for (const char c : std::string_view("true")) {
    request.entries[0].elements[0].payload.push_back(static_cast<std::byte>(c));
  }
  Stream stream = Stream::connect("127.0.0.1", port);
  stream.send(write_tree(request));
  replay::Bytes bytes;
  ASSERT_EQ(stream.receive(bytes, limit), Arrival::message);
  stream.put(tls.make_client(wanted), limit);
  stream.send(write_tree(operation(EntryType::stream_op, "CreateConnection", other)));
  EXPECT_EQ(stream.receive(bytes, limit), Arrival::closed);
  EXPECT_TRUE(is_served());
}

// With the program of OpenSSL as client, to which even old versions of TLS are allowed.
class TlsVersions : public TlsClientPeer {
 protected:
  std::string said_by_openssl(const std::string& more) const {
    const std::string command = "openssl s_client -connect 127.0.0.1:" + std::to_string(port) +
                                " -cipher ALL:@SECLEVEL=0 " + more + " </dev/null 2>&1";
    std::string text;
    const std::unique_ptr<FILE, int (*)(FILE*)> output(popen(command.c_str(), "r"), &pclose);
    std::array<char, 4096> bytes{};
    while (const std::size_t size = fread(bytes.data(), 1, bytes.size(), output.get())) {
      text.append(bytes.data(), size);
    }
    return text;
  }
};

TEST_F(TlsVersions, FromOneTwoOnAreAccepted) {
  EXPECT_THAT(said_by_openssl("-tls1_2"), HasSubstr("New, TLSv1.2, Cipher is ECDHE"));
  EXPECT_THAT(said_by_openssl("-tls1_3"), HasSubstr("New, TLSv1.3, Cipher is TLS_"));
}

TEST_F(TlsVersions, BelowOneTwoAreRefused) {
  for (const char* version : {"-tls1", "-tls1_1"}) {
    EXPECT_THAT(said_by_openssl(version), HasSubstr("alert protocol version")) << version;
  }
  EXPECT_TRUE(
      eventually([&] { return log().find("at least 1.2 is needed") != std::string::npos; }));
}

TEST_F(TlsVersions, ThatSomebodyHasLoweredAreRefused) {
  // Says that it has tried a higher one before, as a client does whose connection was disturbed.
  EXPECT_THAT(said_by_openssl("-tls1_2 -fallback_scsv"), HasSubstr("inappropriate fallback"));
  EXPECT_TRUE(eventually([&] {
    return log().find("somebody between the two sides has lowered") != std::string::npos;
  }));
}

}  // namespace
}  // namespace rr::testing
