// SPDX-License-Identifier: Apache-2.0
// Two connections of one reactor, over a pair of sockets.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <functional>
#include <future>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "rr/error.hpp"
#include "runtime/cpp/src/channel/stream_connection.hpp"
#include "runtime/cpp/src/channel/testing/accepting.hpp"
#include "runtime/cpp/src/channel/testing/quiet_tap.hpp"
#include "runtime/cpp/src/channel/testing/socket_pair.hpp"

namespace rr::channel {
namespace {

using std::chrono_literals::operator""h;
using std::chrono_literals::operator""ms;
using rr::testing::comes_true;
using rr::testing::SocketPair;
using ::testing::ElementsAre;
using Role = StreamConnection::Role;

// A receiver with what a client's has besides.
class NotingReceiver final : public Receiver {
 public:
  explicit NotingReceiver(Connection& connection) : connection_(connection) {}

  void take_answer(const Message& /*message*/, const Entry& entry, const MemoryRef& /*owner*/,
                   DeferredCallbacks& /*deferred*/) override {
    answer = entry.request_id;
    if (waiter != nullptr) connection_.finish_answered(*std::exchange(waiter, nullptr));
  }
  void handle(const Message& message, const Entry& first, const MemoryRef& /*owner*/) override {
    if (on_handle) on_handle(message, first);
    ++handled;
  }
  void lost(const Error& why, DeferredCallbacks& /*deferred*/) override { code = why.code(); }
  void closed() override { is_closed = true; }

  std::function<void(const Message&, const Entry&)> on_handle;
  Waiter* waiter = nullptr;
  std::atomic<std::uint32_t> answer{0};
  std::atomic<unsigned> handled{0};
  std::atomic<ErrorCode> code{ErrorCode::none};
  std::atomic<bool> is_closed{false};

 private:
  Connection& connection_;
};

void write_message(Writer& writer, EntryType type, std::uint32_t id, std::size_t size = 0) {
  writer.reset(MessageVersion::v2);
  const std::string filling(size, 'x');
  if (size != 0) writer.string_element("filling", filling);
  writer.entry({.type = type, .request_id = id}, size == 0 ? 0 : 1, 0);
  writer.message({}, 1);
}

class StreamConnectionTest : public ::testing::Test {
 protected:
  StreamConnectionTest() { reactor_->start(); }
  ~StreamConnectionTest() override {
    for (const auto& connection : {client_, server_}) {
      connection->close(Error(ErrorCode::connection_error, "the test is over"));
    }
    reactor_->connections().wait_for_none();
    reactor_->stop();
  }
  static NodeOptions options() {
    NodeOptions options;
    options.id = NodeId::random();
    options.limits.message_size = 100'000;
    return options;
  }
  void start() {
    client_->start(at_client_);
    server_->start(at_server_);
  }
  void send(Connection& from, EntryType type, std::uint32_t id = 0, std::size_t size = 0) {
    Writer writer;
    write_message(writer, type, id, size);
    from.send(writer);
  }
  bool are_handled(unsigned count) {
    return comes_true([&] { return at_server_->handled == count; });
  }

  const std::shared_ptr<Reactor> reactor_ = std::make_shared<Reactor>(4);
  const std::shared_ptr<const NodeOptions> options_ =
      std::make_shared<const NodeOptions>(options());
  SocketPair sockets_{"127.0.0.2"};
  const std::shared_ptr<StreamConnection> client_ = std::make_shared<StreamConnection>(
      Role::client, Descriptor(::dup(sockets_.own())), reactor_, options_);
  const std::shared_ptr<StreamConnection> server_ = std::make_shared<StreamConnection>(
      Role::server, Descriptor(sockets_.give_away()), reactor_, options_);
  const std::shared_ptr<NotingReceiver> at_client_ = std::make_shared<NotingReceiver>(*client_);
  const std::shared_ptr<NotingReceiver> at_server_ = std::make_shared<NotingReceiver>(*server_);
};

TEST_F(StreamConnectionTest, KnowsWhoAndWhatIsAtTheOtherEnd) {
  const NodeId node = NodeId::random();
  EXPECT_EQ(server_->version(), MessageVersion::v2);
  server_->set_agreement(node, "guest", {.version = MessageVersion::v4, .combined_connect = true});
  EXPECT_EQ(server_->version(), MessageVersion::v4);
  EXPECT_TRUE(server_->may_combine());
  EXPECT_EQ(server_->remote_node(), node);
  EXPECT_EQ(server_->remote_name(), "guest");
  EXPECT_EQ(server_->remote_address(), "127.0.0.2");
  EXPECT_EQ(client_->remote_address(), "127.0.0.1");
  EXPECT_THAT(server_->local_url(), ::testing::StartsWith("rr+tcp://127.0.0.1:"));
  EXPECT_EQ(server_->traits().message_limit, 100'000U);
  EXPECT_FALSE(server_->traits().is_encrypted);
  EXPECT_TRUE(server_->certified_node().is_any());
  server_->set_certified_node(node);
  EXPECT_EQ(server_->certified_node(), node);
  EXPECT_NE(server_->threads(), nullptr);
  EXPECT_EQ(server_->thread_share(), server_->threads());
  EXPECT_EQ(client_->threads(), nullptr);
}

TEST_F(StreamConnectionTest, KeepsWhatItsEndpointsSayOfThem) {
  server_->set_endpoints(7, 9);
  EXPECT_EQ(server_->own_endpoint(), 7U);
  std::vector<bool> told;
  server_->set_on_authorised([&](bool is_authorised) { told.push_back(is_authorised); });
  server_->set_authorised(true);
  server_->set_authorised(true);
  server_->set_authorised(false);
  EXPECT_THAT(told, ElementsAre(true, false));
  const auto pool = std::make_shared<Pool>(1000, 0);
  const auto account = std::make_shared<Account>(pool, 1000);
  EXPECT_EQ(server_->account(), nullptr);
  server_->set_account(account);
  EXPECT_EQ(server_->account(), account);
  EXPECT_NE(server_->new_stream(), server_->new_stream());
}

TEST_F(StreamConnectionTest, MessagesAreHandledInTheirOrder) {
  std::vector<std::uint32_t> ids;
  at_server_->on_handle = [&](const Message&, const Entry& first) {
    ids.push_back(first.request_id);
  };
  start();
  for (std::uint32_t id = 1; id <= 5; ++id) {
    send(*client_, EntryType::property_get_req, id, id == 3 ? 80'000 : 10);
  }
  ASSERT_TRUE(are_handled(5));
  EXPECT_THAT(ids, ElementsAre(1, 2, 3, 4, 5));
  EXPECT_EQ(client_->sample().traffic.messages_sent, 5U);
  EXPECT_EQ(server_->sample().traffic.messages_received, 5U);
  EXPECT_EQ(server_->sample().traffic.bytes_received, client_->sample().traffic.bytes_sent);
  EXPECT_TRUE(server_->sample().is_open);
  EXPECT_TRUE(server_->sample().is_server);
  EXPECT_EQ(server_->sample().transport, "rr+tcp");
}

TEST_F(StreamConnectionTest, ACallerReadsItsAnswer) {
  at_server_->on_handle = [&](const Message&, const Entry& first) {
    Writer writer;
    write_message(writer, EntryType::property_get_res, first.request_id);
    server_->reply(writer);
  };
  start();
  for (std::uint32_t id = 1; id <= 3; ++id) {
    Waiter waiter;
    at_client_->waiter = &waiter;
    client_->claim(waiter);
    Writer writer;
    write_message(writer, EntryType::property_get_req, id);
    client_->send_call(writer, coarse_now(), Priority::usual);
    client_->wait(waiter, never, coarse_now());
    EXPECT_TRUE(waiter.is_done());
    EXPECT_EQ(at_client_->answer, id);
  }
}

TEST_F(StreamConnectionTest, AClaimEndsWithoutAnAnswer) {
  start();
  Waiter waiter;
  client_->claim(waiter);
  EXPECT_TRUE(waiter.is_reader());
  client_->resign(waiter);
  EXPECT_FALSE(waiter.is_reader());
  Waiter impatient;
  client_->claim(impatient);
  client_->wait(impatient, Clock::now(), coarse_now());
  EXPECT_FALSE(impatient.is_done());
}

TEST_F(StreamConnectionTest, TheReactorReadsWhatNoCallerWaitsFor) {
  start();
  client_->expect();
  send(*server_, EntryType::property_get_res, 8);
  EXPECT_TRUE(comes_true([&] { return at_client_->answer == 8U; }));
}

TEST_F(StreamConnectionTest, ANudgeBringsSomethingToRead) {
  start();
  client_->nudge();
  EXPECT_TRUE(comes_true([&] { return server_->sample().traffic.messages_received == 1; }));
  client_->expect();
  EXPECT_TRUE(comes_true([&] { return client_->sample().traffic.messages_received == 1; }));
  EXPECT_EQ(at_server_->handled, 0U) << "the connections speak about themselves";
}

TEST_F(StreamConnectionTest, StreamsAndNewestValuesArrive) {
  start();
  Writer writer;
  for (std::uint32_t id = 1; id <= 20; ++id) {
    write_message(writer, EntryType::pipe_packet, id);
    client_->stream(writer);
  }
  client_->on_stuck();  // what was gathered leaves
  client_->flush_streamed();
  EXPECT_TRUE(client_->wait_sent(0, Clock::now() + 1h));
  EXPECT_TRUE(client_->has_sent(0));
  write_message(writer, EntryType::wire_packet, 0);
  client_->send_newest(writer, {.stream = client_->new_stream(), .time = 1}, coarse_now());
  EXPECT_TRUE(are_handled(21));
  EXPECT_EQ(client_->sample().traffic.wire_values, 1U);
}

TEST_F(StreamConnectionTest, ALargeMessageIsRefusedBeforeItIsSent) {
  start();
  Writer writer;
  write_message(writer, EntryType::property_set_req, 1, 50'000);
  EXPECT_NO_THROW(client_->check_size(writer));
  write_message(writer, EntryType::property_set_req, 1, 100'000);
  EXPECT_THROW(client_->check_size(writer), Error);
  EXPECT_THROW(client_->send(writer), Error);
  EXPECT_FALSE(client_->is_closed());
}

TEST_F(StreamConnectionTest, AHandlerStepsOutWhileItWaits) {
  std::promise<void> second;
  std::atomic<bool> was_back{false};
  at_server_->on_handle = [&](const Message&, const Entry& first) {
    if (first.request_id == 2) second.set_value();
    if (first.request_id != 1) return;
    ASSERT_TRUE(server_->step_out());
    second.get_future().get();  // handled by another thread meanwhile
    was_back = server_->step_in(never);
    server_->await_strand();
  };
  start();
  EXPECT_FALSE(server_->step_out()) << "this thread handles nothing";
  send(*client_, EntryType::property_get_req, 1);
  send(*client_, EntryType::property_get_req, 2);
  ASSERT_TRUE(are_handled(2));
  EXPECT_TRUE(was_back);
}

TEST_F(StreamConnectionTest, AMessageThatIsSuspendedIsHandledOnceMore) {
  std::vector<std::uint32_t> ids;
  std::promise<void> suspended;
  at_server_->on_handle = [&](const Message&, const Entry& first) {
    ids.push_back(first.request_id);
    if (ids.size() != 1) return;
    ASSERT_TRUE(server_->suspend());
    suspended.set_value();
  };
  start();
  EXPECT_FALSE(server_->suspend()) << "this thread handles nothing";
  send(*client_, EntryType::property_get_req, 1);
  send(*client_, EntryType::property_get_req, 2);
  suspended.get_future().get();
  server_->resume();
  ASSERT_TRUE(are_handled(3));
  EXPECT_THAT(ids, ElementsAre(1, 1, 2));
}

TEST_F(StreamConnectionTest, ItsEndIsToldInOrder) {
  std::promise<std::string> gone;
  server_->set_on_gone(
      [&](StreamConnection& connection) { gone.set_value(connection.why_closed().message()); });
  start();
  client_->expect();  // the reactor is to find the end there
  send(*client_, EntryType::property_get_req, 1);
  ASSERT_TRUE(are_handled(1));
  server_->close(Error(ErrorCode::connection_error, "enough"));
  EXPECT_TRUE(server_->is_closed());
  EXPECT_EQ(gone.get_future().get(), "enough");
  EXPECT_TRUE(comes_true([&] { return at_server_->is_closed.load(); }));
  EXPECT_EQ(at_server_->code, ErrorCode::connection_error);
  EXPECT_TRUE(comes_true([&] { return at_client_->is_closed.load(); }));
  EXPECT_THROW(send(*client_, EntryType::property_get_req, 2), Error);
}

TEST_F(StreamConnectionTest, IsClosedAfterAWhile) {
  start();
  server_->close_after(1h);
  EXPECT_FALSE(server_->is_closed());
  server_->close_after(1ms);
  EXPECT_TRUE(comes_true([&] { return at_server_->is_closed.load(); }));
}

// Of a socket that is watched nothing is missed when an event is told twice.
TEST_F(StreamConnectionTest, AnEventWithoutInputChangesNothing) {
  start();
  server_->on_ready(ready::room);
  server_->on_ready(ready::input);
  EXPECT_FALSE(server_->is_closed());
  send(*client_, EntryType::property_get_req, 1);
  EXPECT_TRUE(are_handled(1));
}

// What a receiver does that does not care.
TEST_F(StreamConnectionTest, AReceiverMayLeavePacketsAndForesightAlone) {
  DeferredCallbacks deferred;
  EXPECT_FALSE(at_server_->take_packet({}, {}, {}, deferred));
  at_server_->foresee({});
  EXPECT_TRUE(deferred.empty());
}

// What holds for connections whose channel knows no more.
TEST_F(StreamConnectionTest, AConnectionMayBeWithoutAddressCertificateAndStrand) {
  start();
  Connection& connection = *client_;
  EXPECT_EQ(connection.Connection::remote_address(), "");
  EXPECT_TRUE(connection.Connection::certified_node().is_any());
  EXPECT_FALSE(connection.Connection::suspend());
  connection.Connection::resume();
  Writer writer;
  write_message(writer, EntryType::property_get_req, 1);
  connection.send(writer, coarse_now());
  write_message(writer, EntryType::property_get_req, 2);
  client_->send(writer, coarse_now(), Priority::urgent);
  EXPECT_TRUE(are_handled(2));
  write_message(writer, EntryType::property_get_res, 3);
  server_->reply(writer, Priority::usual);  // not from a handler: it leaves at once
  client_->expect();
  EXPECT_TRUE(comes_true([&] { return at_client_->answer == 3U; }));
}

class CountingTap final : public rr::testing::QuietTap {
 public:
  std::uint64_t message(std::uint32_t /*number*/, Direction direction,
                        std::span<const Piece> message) override {
    ++(direction == Direction::to_service ? to_service : to_client);
    bytes += message.front().size;
    return 1;
  }
  int to_service = 0;
  int to_client = 0;
  std::size_t bytes = 0;
};

TEST_F(StreamConnectionTest, TheTapSeesTheHandshake) {
  const auto tap = std::make_shared<CountingTap>();
  NodeOptions tapped = options();
  tapped.tap = tap;
  SocketPair sockets;
  const auto connection =
      std::make_shared<StreamConnection>(Role::client, Descriptor(sockets.give_away()), reactor_,
                                         std::make_shared<const NodeOptions>(std::move(tapped)));
  connection->tell_handshake(std::vector<std::byte>(3), std::vector<std::byte>(4));
  EXPECT_EQ(tap->to_service, 1);
  EXPECT_EQ(tap->to_client, 1);
  EXPECT_EQ(tap->bytes, 7U);
}

}  // namespace
}  // namespace rr::channel
