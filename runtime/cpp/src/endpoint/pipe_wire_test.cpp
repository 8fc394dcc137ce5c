// SPDX-License-Identifier: Apache-2.0
// Pipes against a hand made other side, byte for byte where it matters (07, section 11).
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "rr/node.hpp"
#include "rr/pipes.hpp"
#include "rr/reader.hpp"
#include "rr/type.hpp"
#include "rr/writer.hpp"
#include "runtime/cpp/src/endpoint/pipe_packets.hpp"

namespace rr::endpoint {
namespace {

using ::testing::ElementsAre;
using ::testing::Pair;

extern const Definition definition;
extern const ObjectType board_type;
constexpr Member members[] = {pipe<double>("numbers"), pipe<double>("out", readonly),
                              property<double>("value"), pipe<double>("lossy", unreliable)};
constexpr const ObjectType* objects[] = {&board_type};
constinit const ObjectType board_type{"test.wire.Board", definition, {}, members, nullptr};
constinit const Definition definition{
    "test.wire",
    "service test.wire\nstdver 0.10\nobject Board\n  pipe double numbers\n"
    "  pipe double out [readonly]\n  property double value\n  pipe double lossy "
    "[unreliable]\nend\n",
    {0, 10, 0, 0},
    {},
    {},
    {},
    objects};

class Board final : public Skeleton {
 public:
  [[nodiscard]] const ObjectType& rr_object_type() const override { return board_type; }
  void rr_dispatch(std::size_t, Request& request) override {
    const double value = 1;
    request.answer(&value);
  }
  std::shared_ptr<Skeleton> rr_child(std::size_t, const ObjectIndex&) override { return nullptr; }
  PipeServer<double> numbers() const { return {*this, members[0]}; }
  PipeServer<double> lossy() const { return {*this, members[3]}; }
};

// A client of format 2 made of bytes.
class RawClient {
 public:
  explicit RawClient(Node& node) {
    int ends[2] = {-1, -1};
    if (socketpair(AF_UNIX, SOCK_STREAM, 0, ends) != 0) throw std::runtime_error("socketpair");
    socket_ = ends[0];
    timeval limit{};
    limit.tv_sec = 10;
    setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof limit);
    node_ = node.id();
    node.adopt(ends[1]);
    ask({.type = EntryType::connect_client, .service_path = "board", .request_id = 1},
        [](Writer&) { return 0U; });
    service_endpoint_ = last_.sender_endpoint;
  }
  ~RawClient() { ::close(socket_); }
  RawClient(const RawClient&) = delete;
  RawClient& operator=(const RawClient&) = delete;

  using Elements = std::function<std::uint32_t(Writer&)>;

  void send(const EntryHeader& header, const Elements& elements) {
    Writer writer;
    writer.reset(MessageVersion::v2);
    const std::uint32_t count = elements(writer);
    writer.entry(header, count, 0);
    writer.message({.sender_node = id_,
                    .receiver_node = node_,
                    .sender_endpoint = 77,
                    .receiver_endpoint = service_endpoint_},
                   1);
    const auto bytes = writer.copy();
    ASSERT_EQ(::send(socket_, bytes.data(), bytes.size(), 0), static_cast<ssize_t>(bytes.size()));
  }
  // The first entry of the next message.
  Entry receive() {
    received_.resize(10);
    read_all(0);
    const std::size_t size = message_size(received_, limits_);
    received_.resize(size);
    read_all(10);
    Entry entry;
    EXPECT_TRUE(read_message(received_, limits_, false, last_, entry));
    return entry;
  }
  Entry ask(const EntryHeader& header, const Elements& elements) {
    send(header, elements);
    return receive();
  }
  Entry ask_pipe(EntryType type, std::string_view member, std::optional<std::int32_t> index) {
    return ask({.type = type, .service_path = "board", .member = member, .request_id = 9},
               [&](Writer& writer) {
                 if (!index) return 0U;
                 type_of<std::int32_t>.write(writer, "index", &*index);
                 return 1U;
               });
  }
  // Of the message received last.
  [[nodiscard]] std::string_view metadata() const { return last_.metadata; }
  // Something that is answered in any case: what came before has been handled by then.
  void sync() {
    EXPECT_EQ(ask({.type = EntryType::property_get_req,
                   .service_path = "board",
                   .member = "value",
                   .request_id = 5},
                  [](Writer&) { return 0U; })
                  .type,
              EntryType::property_get_res);
  }

 private:
  void read_all(std::size_t from) {
    while (from < received_.size()) {
      const ssize_t got = recv(socket_, received_.data() + from, received_.size() - from, 0);
      if (got <= 0) throw std::runtime_error("nothing comes");
      from += static_cast<std::size_t>(got);
    }
  }

  int socket_ = -1;
  const Limits limits_{};
  const NodeId id_ = NodeId::random();
  NodeId node_;
  std::uint32_t service_endpoint_ = 0;
  std::vector<std::byte> received_;
  Message last_;
};

struct Packet {
  std::string index;
  std::uint32_t number = 0;
  double value = 0;
  bool asks = false;
};

RawClient::Elements packets(const std::vector<Packet>& all) {
  return [all](Writer& writer) {
    for (auto each = all.rbegin(); each != all.rend(); ++each) {
      write_packet(writer, each->index, each->number, each->asks,
                   [&] { type_of<double>.write(writer, "packet", &each->value); });
    }
    return static_cast<std::uint32_t>(all.size());
  };
}

constexpr EntryHeader packet_header(std::string_view member = "numbers") {
  return {.type = EntryType::pipe_packet, .service_path = "board", .member = member};
}

std::vector<std::pair<std::string, std::uint32_t>> acknowledged(const Entry& entry) {
  std::vector<std::pair<std::string, std::uint32_t>> result;
  Decoder decoder(MessageVersion::v2);
  ElementReader elements(decoder, entry.elements, entry.element_count);
  for (Element element; elements.next(element);) {
    std::uint32_t number = 0;
    EXPECT_TRUE(read_number(element, number));
    result.emplace_back(std::string(element.name), number);
  }
  return result;
}

struct Served {
  PipeEndpoint<double> end() const { return board->numbers().endpoints().front(); }

  std::shared_ptr<Board> board = std::make_shared<Board>();
  Node node;
  Service service = node.register_service("board", board);
  RawClient client{node};
};

TEST(PipeWire, ConnectingNeedsAnIndexAndDisconnectingAnEndpoint) {
  Served served;
  Entry answer = served.client.ask_pipe(EntryType::pipe_connect_req, "numbers", std::nullopt);
  EXPECT_EQ(answer.type, EntryType::pipe_connect_ret);
  EXPECT_EQ(answer.error, 15);
  answer = served.client.ask_pipe(EntryType::pipe_disconnect_req, "numbers", 9);
  EXPECT_EQ(answer.type, EntryType::pipe_disconnect_ret);
  EXPECT_EQ(answer.error, 18);
  answer = served.client.ask_pipe(EntryType::pipe_connect_req, "nothing", -1);
  EXPECT_EQ(answer.error, 9);
  answer = served.client.ask_pipe(EntryType::pipe_connect_req, "value", -1);
  EXPECT_EQ(answer.error, 9);
  answer = served.client.ask_pipe(EntryType::pipe_connect_req, "numbers", -5);
  EXPECT_EQ(answer.error, 0);
  EXPECT_EQ(served.end().index(), -5);
  EXPECT_EQ(served.client.ask_pipe(EntryType::pipe_disconnect_req, "numbers", -5).error, 0);
  EXPECT_EQ(served.board->numbers().endpoint_count(), 0U);
}

TEST(PipeWire, PacketsWaitForThoseBeforeThem) {
  Served served;
  served.client.ask_pipe(EntryType::pipe_connect_req, "numbers", 4);
  Entry answer = served.client.ask(packet_header(), packets({{"4", 3, 30, true}}));
  EXPECT_EQ(answer.type, EntryType::pipe_packet_ret);
  EXPECT_THAT(acknowledged(answer), ElementsAre(Pair("4", 3U)));
  EXPECT_EQ(served.end().available(), 0U);
  answer = served.client.ask(packet_header(), packets({{"4", 1, 10, true}, {"4", 2, 20, true}}));
  EXPECT_EQ(answer.request_id, 0U);
  EXPECT_THAT(acknowledged(answer), ElementsAre(Pair("4", 1U), Pair("4", 2U)));
  served.client.sync();
  EXPECT_EQ(served.end().receive(), 10);
  EXPECT_EQ(served.end().receive(), 20);
  EXPECT_EQ(served.end().receive(), 30);
}

TEST(PipeWire, WhatIsNoPacketIsDroppedInSilence) {
  Served served;
  served.client.ask_pipe(EntryType::pipe_connect_req, "numbers", 4);
  const auto odd = [&](const std::function<void(Writer&)>& number, bool has_value) {
    served.client.send(packet_header(), [&](Writer& writer) {
      const double value = 1;
      const std::uint32_t asks = 1;
      type_of<std::uint32_t>.write(writer, "requestack", &asks);
      if (has_value) type_of<double>.write(writer, "packet", &value);
      number(writer);
      writer.element("4", ElementType::dictionary, {}, has_value ? 3 : 2, 0);
      return 1U;
    });
    served.client.sync();
  };
  odd(
      [](Writer& writer) {  // a number of another type
        const std::int32_t number = 1;
        type_of<std::int32_t>.write(writer, "packetnumber", &number);
      },
      true);
  odd(
      [](Writer& writer) {  // no value
        const std::uint32_t number = 1;
        type_of<std::uint32_t>.write(writer, "packetnumber", &number);
      },
      false);
  served.client.send(packet_header(), [](Writer& writer) {  // a value of another type
    write_packet(writer, "4", 1, true, [&] { writer.string_element("packet", "x"); });
    return 1U;
  });
  served.client.sync();
  served.client.send(packet_header(), packets({{"77", 1, 1, true}}));
  served.client.sync();
  served.client.send(packet_header(), packets({{"left", 1, 1, true}}));
  served.client.sync();
  EXPECT_EQ(served.end().available(), 0U);
  served.client.send(packet_header(), packets({{"4", 1, 5, false}}));
  served.client.sync();
  EXPECT_EQ(served.end().receive(), 5);
}

TEST(PipeWire, PacketsToWhatIsNotThereAreAnsweredWithAnError) {
  Served served;
  Entry answer = served.client.ask(packet_header("nothing"), packets({{"1", 1, 1, false}}));
  EXPECT_EQ(answer.type, EntryType::pipe_packet_ret);
  EXPECT_EQ(answer.error, 9);
  EntryHeader header = packet_header();
  header.service_path = "board.nothing";
  answer = served.client.ask(header, packets({{"1", 1, 1, false}}));
  EXPECT_EQ(answer.type, EntryType::pipe_packet_ret);
  EXPECT_EQ(answer.error, 9);
}

TEST(PipeWire, AForbiddenPacketIsDroppedAndAcknowledged) {
  Served served;
  served.client.ask_pipe(EntryType::pipe_connect_req, "out", -1);
  const Entry answer = served.client.ask(packet_header("out"), packets({{"1", 1, 1, true}}));
  EXPECT_THAT(acknowledged(answer), ElementsAre(Pair("1", 1U)));
}

TEST(PipeWire, UnreliableEndpointsAreMarkedAsTheReferenceMarksThem) {
  Served served;
  const Entry connected = served.client.ask(
      {.type = EntryType::pipe_connect_req, .service_path = "board", .member = "lossy"},
      [](Writer& writer) {
        const std::int32_t index = -1;
        const std::int32_t is_unreliable = 1;
        type_of<std::int32_t>.write(writer, "unreliable", &is_unreliable);
        type_of<std::int32_t>.write(writer, "index", &index);
        return 2U;
      });
  EXPECT_EQ(connected.element_count, 2U);
  EXPECT_EQ(served.client.metadata(), "");
  const Entry answer = served.client.ask(packet_header("lossy"), packets({{"1", 7, 70, true}}));
  EXPECT_EQ(served.client.metadata(), "unreliable\n");
  EXPECT_EQ(answer.metadata, "");
  EXPECT_THAT(acknowledged(answer), ElementsAre(Pair("1", 7U)));
  served.client.send(packet_header("lossy"), packets({{"1", 3, 30, false}}));
  served.client.sync();
  auto end = served.board->lossy().endpoints().front();
  EXPECT_EQ(end.receive(), 70);
  EXPECT_EQ(end.receive(), 30);
  end.send(1);
  EXPECT_EQ(served.client.receive().metadata, "unreliable\n");
  EXPECT_EQ(served.client.metadata(), "unreliable\n");
}

TEST(PipeWire, PacketsTooFarAheadCloseTheEndpoint) {
  Served served;
  served.client.ask_pipe(EntryType::pipe_connect_req, "numbers", 1);
  for (std::uint32_t i = 0; i < 1024; ++i) {
    served.client.send(packet_header(), packets({{"1", 2 + i, 1, false}}));
  }
  served.client.sync();
  EXPECT_EQ(served.board->numbers().endpoint_count(), 1U);
  const Entry closed = served.client.ask(packet_header(), packets({{"1", 5000, 1, false}}));
  EXPECT_EQ(closed.type, EntryType::pipe_closed);
  EXPECT_EQ(served.board->numbers().endpoint_count(), 0U);
}

TEST(PipeWire, AClientCannotHaveEndpointsWithoutLimit) {
  Served served;
  std::uint16_t error = 0;
  int count = 0;
  for (; error == 0 && count < 10'000; ++count) {
    error = served.client.ask_pipe(EntryType::pipe_connect_req, "numbers", -1).error;
  }
  EXPECT_EQ(error, static_cast<std::uint16_t>(ErrorCode::out_of_system_resource));
  EXPECT_EQ(served.board->numbers().endpoint_count(), 4096U);
}

TEST(PipeWire, TooManyAcknowledgementsDoNoHarm) {
  Served served;
  served.client.ask_pipe(EntryType::pipe_connect_req, "numbers", 1);
  auto end = served.end();
  end.ask_for_acknowledgements();
  end.send(1);
  EXPECT_EQ(served.client.receive().type, EntryType::pipe_packet);
  EXPECT_EQ(end.unacknowledged(), 1U);
  served.client.send(
      {.type = EntryType::pipe_packet_ret, .service_path = "board", .member = "numbers"},
      [](Writer& writer) {
        for (std::uint32_t i = 0; i < 5; ++i) write_acknowledgement(writer, 1, i);
        return 5U;
      });
  served.client.sync();
  EXPECT_EQ(end.unacknowledged(), 0U);
}

// By number in format 4, by name in format 2; packets have names in both.
TEST(PipeWire, ElementsAreNamedAsTheReferenceNamesThem) {
  for (const MessageVersion version : {MessageVersion::v2, MessageVersion::v4}) {
    Writer writer;
    writer.reset(version);
    write_acknowledgement(writer, 4, 9);
    const auto bytes = writer.copy();
    Decoder decoder(version);
    ElementReader elements(decoder, bytes, 1);
    Element element;
    ASSERT_TRUE(elements.next(element));
    EXPECT_EQ(element.index(), 4);
    EXPECT_EQ(element.has_number, version == MessageVersion::v4);
    std::uint32_t number = 0;
    EXPECT_TRUE(read_number(element, number));
    EXPECT_EQ(number, 9U);
  }
}

}  // namespace
}  // namespace rr::endpoint
