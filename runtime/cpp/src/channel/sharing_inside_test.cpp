// SPDX-License-Identifier: Apache-2.0
// How a server's connection goes over to shared memory, and clients that do it otherwise than the
// page says.
#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "rr/error.hpp"
#include "runtime/cpp/src/channel/handshake.hpp"
#include "runtime/cpp/src/channel/operations.hpp"
#include "runtime/cpp/src/channel/stream_connection.hpp"
#include "runtime/cpp/src/channel/stream_sizes.hpp"
#include "runtime/cpp/src/channel/testing/accepting.hpp"
#include "runtime/cpp/src/channel/testing/socket_pair.hpp"
#include "runtime/cpp/src/platform/shared_memory.hpp"

namespace rr::channel {
namespace {

using std::chrono_literals::operator""us;
using rr::testing::comes_true;
using rr::testing::SocketPair;
using rr::testing::TestReceiver;

constexpr int patience = 20'000;  // milliseconds
const std::string place = "the test";

std::ptrdiff_t open_descriptors() {
  const std::filesystem::directory_iterator all("/proc/self/fd");
  return std::distance(begin(all), end(all));
}

// A server's connection, and the client's end of its socket.
struct Sharing {
  Sharing() { reactor->start(); }
  Sharing(const Sharing&) = delete;
  Sharing& operator=(const Sharing&) = delete;
  ~Sharing() {
    if (server) server->close(Error(ErrorCode::connection_error, "the test is over"));
    reactor->connections().wait_for_none();
    reactor->stop();
  }

  // `limit`: bytes that the client may make it hold.
  void accept(bool shares = true, std::size_t limit = 10'000'000) {
    LinkTerms terms = tcp_terms(*options, "rr+local");
    terms.shares_memory = shares;
    server = std::make_shared<StreamConnection>(StreamConnection::Role::server,
                                                Descriptor(sockets.give_away()), reactor, options,
                                                std::move(terms), nullptr);
    account = std::make_shared<Account>(std::make_shared<Pool>(limit, 0), limit);
    server->set_account(account);
    receiver = std::make_shared<TestReceiver>(
        server, [](Connection& connection, const Entry& /*first*/, const MemoryRef& /*owner*/) {
          Writer writer;
          writer.reset(MessageVersion::v2);
          writer.entry({.type = EntryType::property_get_res, .request_id = 9}, 0, 0);
          writer.message({}, 1);
          connection.reply(writer, Priority::usual);
        });
    server->start(receiver);
  }

  [[nodiscard]] std::vector<std::byte> request() const {
    return share_memory_request(agreed, *options);
  }
  std::uint32_t level() {
    sockets.send(capability_request(shared_memory_capability, agreed, *options));
    return check_capability(sockets.receive_message(patience), shared_memory_capability, agreed,
                            *options, place);
  }
  // Asks for memory. Whether the answer says that there is some.
  bool ask() {
    sockets.send(request());
    return receive_answer();
  }
  bool receive_answer() {
    std::array<std::byte, 1000> room;
    std::ptrdiff_t size = platform::nothing_now;
    comes_true([&] {
      size = platform::receive_with_handle(sockets.own(), room, handle);
      return size != platform::nothing_now;
    });
    if (size <= 0) return false;
    shared_terms = check_share_memory(std::span(room).first(static_cast<std::size_t>(size)), agreed,
                                      *options, place);
    return shared_terms.has_value();
  }
  // The client's side.
  std::unique_ptr<SharedCarrier> open() {
    std::error_code error;
    return std::make_unique<SharedCarrier>(SharedRings::open(handle, error), false, sockets.own(),
                                           0us);
  }
  bool is_ended() {
    return comes_true([&] { return receiver->is_closed.load(); });
  }

  const std::shared_ptr<Reactor> reactor = std::make_shared<Reactor>(4);
  const std::shared_ptr<const NodeOptions> options =
      std::make_shared<const NodeOptions>(NodeOptions{.id = NodeId::random()});
  SocketPair sockets;
  Agreed agreed;
  std::shared_ptr<Account> account;
  std::shared_ptr<StreamConnection> server;
  std::shared_ptr<TestReceiver> receiver;
  platform::Descriptor handle;
  std::optional<SharedTerms> shared_terms;
};

class SharingTest : public ::testing::Test, public Sharing {
 protected:
  void SetUp() override {
    if (!platform::has_shared_memory()) GTEST_SKIP() << "this system has no shared memory";
  }
};

TEST_F(SharingTest, MessagesGoThroughTheMemoryFromTheAnswerOn) {
  accept();
  EXPECT_EQ(level(), shared_memory_level);
  ASSERT_TRUE(ask());
  EXPECT_EQ(account->held(), SharedRings::memory_size(shared_ring_size));
  const auto client = open();
  const std::vector<std::byte> asked = rr::testing::message_of(EntryType::property_get_req, 1000);
  const platform::Buffer piece{asked.data(), asked.size()};
  for (unsigned count = 1; count <= 100; ++count) {
    ASSERT_EQ(client->send({&piece, 1}), static_cast<std::ptrdiff_t>(asked.size()));
    std::array<std::byte, 1000> room;
    std::ptrdiff_t size = platform::nothing_now;
    while (size == platform::nothing_now) size = client->receive(room, true);
    Message message;
    Entry entry;
    ASSERT_GT(size, 0);
    ASSERT_TRUE(read_message(std::span(room).first(static_cast<std::size_t>(size)), {}, false,
                             message, entry));
    EXPECT_EQ(entry.request_id, 9U);
    EXPECT_TRUE(comes_true([&] { return receiver->handled == count; }));
  }
}

TEST_F(SharingTest, IsNotOfferedWhereItIsNotWanted) {
  accept(false);
  EXPECT_EQ(level(), 0U);
  EXPECT_FALSE(ask());
  EXPECT_FALSE(handle);
  EXPECT_EQ(level(), 0U) << "the connection goes on as it was";
}

TEST_F(SharingTest, IsNotOfferedToAClientOfASession) {
  accept();
  server->set_authorised(true);
  EXPECT_EQ(level(), 0U);
  EXPECT_FALSE(ask());
  EXPECT_FALSE(handle);
}

TEST_F(SharingTest, IsRefusedWhereTheAccountHasNoRoom) {
  accept(true, 100'000);
  EXPECT_EQ(level(), shared_memory_level);
  EXPECT_FALSE(ask());
  EXPECT_FALSE(handle);
  EXPECT_EQ(account->held(), 0U);
  EXPECT_EQ(level(), shared_memory_level) << "the connection goes on as it was";
}

TEST_F(SharingTest, HappensOnce) {
  accept();
  ASSERT_TRUE(ask());
  const auto client = open();
  const std::vector<std::byte> again = request();
  const platform::Buffer piece{again.data(), again.size()};
  client->send({&piece, 1});
  std::array<std::byte, 1000> room;
  std::ptrdiff_t size = platform::nothing_now;
  while (size == platform::nothing_now) size = client->receive(room, true);
  ASSERT_GT(size, 0);
  EXPECT_FALSE(check_share_memory(std::span(room).first(static_cast<std::size_t>(size)), agreed,
                                  *options, place));
}

// The memory is there before what is sent after it.
TEST_F(SharingTest, MemoriesOfWiresArePassedWhereBothWantThem) {
  accept();
  ASSERT_TRUE(ask());
  EXPECT_TRUE(shared_terms->has_slots);
  EXPECT_TRUE(server->shares_slots());
  const auto client = open();
  client->use_slots();
  std::error_code error;
  const auto slots = SlotWriter::make(SlotSizes::for_value(100), 7, error);
  ASSERT_NE(slots, nullptr);
  EXPECT_TRUE(server->pass_memory(slots->handle()));
  const auto drawn = server->draw_holds();
  ASSERT_NE(drawn, nullptr);
  EXPECT_EQ(drawn->place(), 0U);
  const auto taken = client->take_slots(7);
  ASSERT_NE(taken, nullptr);
  EXPECT_EQ(taken->id(), 7U);
  EXPECT_EQ(server->take_slots(7, std::nullopt), nullptr);
  const auto ring = PipeRingWriter::make(PipeRingSize::for_packet(100), 8, error);
  ASSERT_NE(ring, nullptr);
  EXPECT_TRUE(server->pass_memory(ring->handle()));
  const PipeRingStart start{.id = 8, .reader = ring->admit().value()};
  EXPECT_EQ(server->take_ring(start), nullptr);
  const auto reader = client->take_ring(start);
  ASSERT_NE(reader, nullptr);
  EXPECT_EQ(reader->id(), 8U);
}

TEST_F(SharingTest, OfAPeerThatKnowsNoSlotsNothingChanges) {
  accept();
  Writer writer;
  writer.reset(MessageVersion::v2);
  writer.entry({.type = EntryType::stream_op, .member = share_memory}, 0, writer.position());
  writer.message({.sender_node = options->id, .receiver_node = options->id}, 1);
  sockets.send(writer.copy());
  ASSERT_TRUE(receive_answer());
  EXPECT_FALSE(shared_terms->has_slots);
  EXPECT_FALSE(server->shares_slots());
  std::error_code error;
  const auto slots = SlotWriter::make(SlotSizes::for_value(100), 7, error);
  EXPECT_FALSE(server->pass_memory(slots->handle()));
}

TEST_F(SharingTest, AClientThatPassesMemoriesItselfIsNotHeard) {
  accept();
  ASSERT_TRUE(ask());
  const auto client = open();
  std::error_code error;
  const auto slots = SlotWriter::make(SlotSizes::for_value(100), 7, error);
  const std::ptrdiff_t before = open_descriptors();
  constexpr std::array<std::byte, 1> bell{};
  for (int i = 0; i < 100; ++i) {
    platform::send_with_handle(sockets.own(), bell, slots->handle());
  }
  const std::vector<std::byte> asked = rr::testing::message_of(EntryType::property_get_req);
  const platform::Buffer piece{asked.data(), asked.size()};
  unsigned count = 0;
  // One look at the socket takes one of them, or more.
  EXPECT_TRUE(comes_true([&] {
    client->send({&piece, 1});
    ++count;
    return !platform::has_unreceived(sockets.own());
  })) << "the server leaves them in the socket";
  EXPECT_TRUE(comes_true([&] { return receiver->handled == count; }));
  EXPECT_EQ(open_descriptors(), before);
  EXPECT_FALSE(receiver->is_closed);
}

TEST_F(SharingTest, NothingMayFollowTheRequest) {
  for (const std::size_t size : {std::size_t{1}, std::size_t{12}, std::size_t{1000}}) {
    SCOPED_TRACE(size);
    Sharing other;
    other.accept();
    std::vector<std::byte> both = other.request();
    const std::vector<std::byte> more = rr::testing::message_of(EntryType::connection_test, 500);
    both.insert(both.end(), more.begin(),
                more.begin() + static_cast<std::ptrdiff_t>(std::min(size, more.size())));
    other.sockets.send(both);
    EXPECT_TRUE(other.is_ended());
  }
}

TEST_F(SharingTest, BytesOfTheSocketAreNoMessagesAfterwards) {
  accept();
  ASSERT_TRUE(ask());
  const auto client = open();
  sockets.send(rr::testing::message_of(EntryType::property_get_req, 10'000));
  const std::vector<std::byte> asked = rr::testing::message_of(EntryType::property_get_req);
  const platform::Buffer piece{asked.data(), asked.size()};
  client->send({&piece, 1});
  EXPECT_TRUE(comes_true([&] { return receiver->handled == 1; }));
  EXPECT_FALSE(receiver->is_closed);
}

TEST_F(SharingTest, TheEndOfTheSocketIsTheEnd) {
  accept();
  ASSERT_TRUE(ask());
  platform::shut_down(sockets.own());
  EXPECT_TRUE(is_ended());
}

TEST_F(SharingTest, AWrongIndexIsTheEnd) {
  accept();
  ASSERT_TRUE(ask());
  std::error_code error;
  const SharedRings rings = SharedRings::open(handle, error);
  ASSERT_TRUE(rings);
  rings.to_server().words->written = shared_ring_size + 1;
  constexpr std::array<std::byte, 1> bell{};
  sockets.send(bell);
  EXPECT_TRUE(is_ended());
  EXPECT_EQ(receiver->handled, 0U);
}

TEST_F(SharingTest, WhatIsNoMessageIsTheEnd) {
  accept();
  ASSERT_TRUE(ask());
  const auto client = open();
  const std::string text(1000, 'x');
  const platform::Buffer piece{reinterpret_cast<const std::byte*>(text.data()), text.size()};
  client->send({&piece, 1});
  EXPECT_TRUE(is_ended());
}

TEST_F(SharingTest, ABellThatRingsWithoutEndHarmsNobody) {
  accept();
  ASSERT_TRUE(ask());
  const auto client = open();
  const std::vector<std::byte> bells(100'000);
  sockets.send(bells);
  const std::vector<std::byte> asked = rr::testing::message_of(EntryType::property_get_req);
  const platform::Buffer piece{asked.data(), asked.size()};
  client->send({&piece, 1});
  EXPECT_TRUE(comes_true([&] { return receiver->handled == 1; }));
}

}  // namespace
}  // namespace rr::channel
