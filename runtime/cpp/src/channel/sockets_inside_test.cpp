// SPDX-License-Identifier: Apache-2.0
// Addresses, and sockets that listen and connect.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <future>
#include <map>
#include <memory>
#include <string>

#include "rr/error.hpp"
#include "rr/url.hpp"
#include "runtime/cpp/src/channel/accept.hpp"
#include "runtime/cpp/src/channel/channel.hpp"
#include "runtime/cpp/src/channel/components.hpp"
#include "runtime/cpp/src/channel/connected.hpp"
#include "runtime/cpp/src/channel/listening_socket.hpp"
#include "runtime/cpp/src/channel/opening.hpp"
#include "runtime/cpp/src/channel/reactor.hpp"
#include "runtime/cpp/src/channel/remote_address.hpp"
#include "runtime/cpp/src/channel/socket.hpp"
#include "runtime/cpp/src/channel/tcp_connect.hpp"
#include "runtime/cpp/src/channel/tcp_listener.hpp"
#include "runtime/cpp/src/channel/testing/accepting.hpp"
#include "runtime/cpp/src/platform/waiting.hpp"

namespace rr::channel {
namespace {

using std::chrono_literals::operator""h;
using rr::testing::comes_true;
using rr::testing::SocketPair;
using rr::testing::TestReceiver;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::SizeIs;
using ::testing::StartsWith;

template <class Run>
ErrorCode failure_of(const Run& run) {
  try {
    run();
  } catch (const Error& error) {
    return error.code();
  }
  return ErrorCode::none;
}

TEST(Addresses, AreWrittenAsUrls) {
  const auto digits = resolve("127.0.0.1", 2355);
  ASSERT_THAT(digits, SizeIs(1));
  EXPECT_EQ(url_of(digits.front()), "rr+tcp://127.0.0.1:2355");
  EXPECT_EQ(url_of(digits.front(), "rrs+tcp"), "rrs+tcp://127.0.0.1:2355");
  EXPECT_EQ(url_of(resolve("::1", 1).front()), "rr+tcp://[::1]:1");
  EXPECT_EQ(url_of(Address()), "");
  EXPECT_EQ(failure_of([] { resolve("no.such.host.invalid", 1); }), ErrorCode::connection_error);
}

TEST(Addresses, ToListenAtAreThoseOfBothFamilies) {
  EXPECT_THAT(resolve_for_listening("127.0.0.1", 0), SizeIs(1));
  const auto all = resolve_for_listening("*", 0);
  EXPECT_GE(all.size(), 1U);
  EXPECT_EQ(all.size(), resolve_for_listening("", 0).size());
}

TEST(Addresses, OfThePeerHaveNoPort) {
  const SocketPair sockets("127.0.0.3");
  EXPECT_EQ(remote_address_of(sockets.other()), "127.0.0.3");
  EXPECT_EQ(remote_address_of(sockets.own()), "127.0.0.1");
  const SocketPair local;
  EXPECT_THAT(remote_address_of(local.own()), StartsWith("uid "));
  EXPECT_EQ(remote_address_of(-1), "");
}

TEST(OpeningSteps, FollowTheScheme) {
  using enum OpeningStep;
  EXPECT_THAT(opening_steps("rr+tcp"), ElementsAre(agree));
  EXPECT_THAT(opening_steps("rrs+tcp"), ElementsAre(start_tls, agree));
  EXPECT_THAT(opening_steps("rr+ws"), ElementsAre(web_socket, agree));
  EXPECT_THAT(opening_steps("rr+wss"), ElementsAre(web_tls, web_socket, agree));
  EXPECT_THAT(opening_steps("rrs+wss"), ElementsAre(web_tls, web_socket, start_tls, agree));
}

// The channels of one node, without its services.
class SocketsTest : public ::testing::Test {
 protected:
  SocketsTest() {
    NodeOptions options;
    options.id = NodeId::random();
    options.name = "board";
    context_.options = std::make_shared<const NodeOptions>(std::move(options));
    context_.reactor = std::make_shared<Reactor>(4);
    context_.accepted = std::make_shared<Admission>(context_.options);
    context_.pools = make_pools(*context_.options);
    watch_pools(context_.pools, context_.reactor);
    context_.reactor->start();
  }
  ~SocketsTest() override {
    for (const auto& connection : connections_) {
      connection->close(Error(ErrorCode::connection_error, "the test is over"));
    }
    context_.reactor->connections().wait_for_none();
    connections_.clear();
    context_.reactor->stop();
  }
  AcceptHandler accept() {
    return [this](const std::shared_ptr<Connection>& connection) {
      const MutexLock lock(mutex_);
      connections_.push_back(connection);
      return std::make_shared<TestReceiver>(connection, nullptr);
    };
  }
  static Url at(const std::string& base) { return Url::parse(base + "/?service=s"); }

  ChannelContext context_;
  Mutex mutex_;
  std::vector<std::shared_ptr<Connection>> connections_;
};

TEST_F(SocketsTest, AListenerSaysWhereItIsAndIsFoundThere) {
  const auto listener =
      std::make_unique<TcpListener>(context_, Url::parse("rr+tcp://127.0.0.1:0"), accept());
  const auto urls = listener->urls();
  ASSERT_FALSE(urls.empty());
  EXPECT_THAT(urls.front(), StartsWith("rr+tcp://127.0.0.1:"));
  EXPECT_EQ(urls.front().find(":0", 16), std::string::npos) << urls.front();
  listener->services_changed("abcdefghijklmnop");  // nobody watches
  const Url url = at(urls.front());
  Agreed agreed = connect_stream(resolve(url.host, url.port), url, context_, Clock::now() + 1h);
  EXPECT_EQ(agreed.remote_node, context_.options->id);
  EXPECT_EQ(agreed.remote_name, "board");
  EXPECT_EQ(agreed.agreement.version, MessageVersion::v4);
  const auto connection =
      connected(context_, std::move(agreed), tcp_terms(*context_.options), accept());
  EXPECT_EQ(connection->remote_name(), "board");
  EXPECT_EQ(connection->version(), MessageVersion::v4);
}

TEST_F(SocketsTest, AnOpeningGoesOnStepByStep) {
  const auto listener =
      std::make_unique<TcpListener>(context_, Url::parse("rr+tcp://127.0.0.1:0"), accept());
  const Url url = at(listener->urls().front());
  Opening opening(resolve(url.host, url.port).front(), url, context_);
  std::optional<Agreed> agreed;
  while (!agreed) {
    const platform::Awaited wanted = opening.wanted();
    ASSERT_GE(wanted.socket, 0);
    platform::wait_for(wanted.socket, wanted.wanted, Clock::now() + 1h);
    agreed = opening.go_on();
  }
  EXPECT_EQ(agreed->remote_node, context_.options->id);
}

TEST_F(SocketsTest, NobodyIsWhereNobodyListens) {
  std::string base;
  {
    const TcpListener listener(context_, Url::parse("rr+tcp://127.0.0.1:0"), accept());
    base = listener.urls().front();
  }
  const Url url = at(base);
  EXPECT_EQ(failure_of([&] {
              connect_stream(resolve(url.host, url.port), url, context_, Clock::now() + 1h);
            }),
            ErrorCode::connection_error);
}

TEST_F(SocketsTest, AListeningSocketAcceptsUntilItStops) {
  const Address wanted = resolve("127.0.0.1", 0).front();
  std::error_code error;
  Descriptor descriptor = platform::listen_at(wanted, error);
  ASSERT_FALSE(error) << error.message();
  const auto socket = std::make_shared<ListeningSocket>(context_, std::move(descriptor),
                                                        tcp_terms(*context_.options), accept());
  socket->start();
  socket->on_ready(0);  // nobody has come
  const Url url = at(url_of(socket->address()));
  EXPECT_NE(url.port, 0);
  EXPECT_NO_THROW(connect_stream(resolve(url.host, url.port), url, context_, Clock::now() + 1h));
  socket->stop();
}

TEST_F(SocketsTest, AConnectionThatComesInIsCounted) {
  SocketPair sockets;
  const auto connection = accept_connection(context_, Descriptor(sockets.give_away()),
                                            tcp_terms(*context_.options), nullptr, accept());
  EXPECT_EQ(context_.accepted->size(), 1U);
  SocketPair others;
  const auto adopted = adopt_socket(context_, others.give_away(), accept());
  EXPECT_EQ(context_.accepted->size(), 2U);
  adopted->close(Error(ErrorCode::connection_error, "enough"));
  EXPECT_TRUE(comes_true([&] { return context_.accepted->size() == 1; }));
}

TEST_F(SocketsTest, AChannelIsThereForEachScheme) {
  const auto channels = all_channels(context_);
  for (const char* scheme : {"rr+tcp", "rr+local", "rr+intra"}) {
    EXPECT_TRUE(channels.contains(scheme)) << scheme;
  }
  EXPECT_EQ(channels.at("rr+tcp")->service_at(Url::parse("rr+tcp://127.0.0.1:1"), never), "");
  EXPECT_NE(make_local_channel(context_), nullptr);
  EXPECT_EQ(make_pools(*context_.options).sessions->held(), 0U);
}

TEST(Components, AreNamedWhereTheyAreMissing) {
  EXPECT_EQ(missing_component("rr+tcp"), "");
  EXPECT_EQ(missing_component("rr+ws"), "") << "this program has it";
  EXPECT_TRUE(failure_of([] { certified_id({.certificate_file = "/nowhere/node.pem"}); }) !=
              ErrorCode::none);
}

}  // namespace
}  // namespace rr::channel
