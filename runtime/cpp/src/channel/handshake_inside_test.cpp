// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "rr/error.hpp"
#include "rr/url.hpp"
#include "rr/writer.hpp"
#include "runtime/cpp/src/channel/carrier.hpp"
#include "runtime/cpp/src/channel/handshake.hpp"
#include "runtime/cpp/src/channel/operations.hpp"

namespace rr::channel {
namespace {

using Bytes = std::vector<std::byte>;

const Url url = Url::parse("rr+tcp://host:2355/?nodename=board&service=s");

// The only entry of a message, and what its header says.
struct Read {
  explicit Read(Bytes given) : bytes(std::move(given)) {
    is_whole = read_message(bytes, {}, false, message, nullptr) && EntryReader(message).next(entry);
  }
  std::string text(std::string_view name) {
    Decoder decoder(message.version, &message.strings);
    Element element;
    if (!find_element(decoder, entry.elements, entry.element_count, name, element)) return {};
    return std::string(element.text());
  }
  Bytes bytes;  // that the message views
  Message message;
  Entry entry;
  bool is_whole = false;
};

class HandshakeTest : public ::testing::Test {
 protected:
  HandshakeTest() { options_.name = "me"; }

  // What a server says of an operation.
  static Bytes answer(std::string_view operation, ErrorCode error, const std::string& node_name,
                      std::span<const std::uint32_t> codes = {}) {
    Writer writer;
    writer.reset(MessageVersion::v2);
    const std::size_t end = writer.position();
    std::uint32_t elements = 0;
    if (error != ErrorCode::none) elements = write_error(writer, "Code", "why");
    if (!codes.empty()) {
      write_codes(writer, "capabilities", codes);
      ++elements;
    }
    writer.entry({.type = EntryType::stream_op_ret,
                  .member = operation,
                  .error = static_cast<std::uint16_t>(error)},
                 elements, end);
    writer.message({.sender_node = server, .sender_name = node_name}, 1);
    return writer.copy();
  }
  ErrorCode failure(const Bytes& bytes) {
    try {
      check_create_connection(bytes, url, options_, "host", agreed_);
    } catch (const Error& error) {
      return error.code();
    }
    return ErrorCode::none;
  }

  static inline const NodeId server = NodeId::random();
  NodeOptions options_;
  Agreed agreed_;
};

TEST_F(HandshakeTest, AClientSaysWhoItIsAndWhomItWants) {
  Read read(create_connection_request(url, options_));
  ASSERT_TRUE(read.is_whole);
  EXPECT_EQ(read.message.version, MessageVersion::v2);
  EXPECT_EQ(read.message.sender_name, "me");
  EXPECT_EQ(read.message.receiver_name, "board");
  EXPECT_EQ(read.entry.type, EntryType::stream_op);
  EXPECT_EQ(read.entry.member, create_connection);
  Decoder decoder(read.message.version, &read.message.strings);
  Element element;
  ASSERT_TRUE(find_element(decoder, read.entry.elements, read.entry.element_count, "capabilities",
                           element));
  EXPECT_EQ(read_codes(element), offered_codes(options_.client_offer));
}

TEST_F(HandshakeTest, TheFirstMessageIsWritten) {
  const std::vector<std::uint32_t> codes = {0x02000001};
  Writer writer;
  write_create_connection(writer, {.sender_name = "x"}, codes);
  Read read(writer.copy());
  ASSERT_TRUE(read.is_whole);
  EXPECT_EQ(read.message.sender_name, "x");
  EXPECT_EQ(read.entry.member, create_connection);
}

TEST_F(HandshakeTest, TheAnswerSaysWhatIsAgreed) {
  const std::vector<std::uint32_t> codes = {0x02000001, 0x04000001};
  const Bytes bytes = answer(create_connection, ErrorCode::none, "board", codes);
  EXPECT_EQ(failure(bytes), ErrorCode::none);
  EXPECT_EQ(agreed_.agreement.version, MessageVersion::v4);
  EXPECT_EQ(agreed_.remote_node, server);
  EXPECT_EQ(agreed_.remote_name, "board");
  EXPECT_EQ(agreed_.answer, bytes);
}

TEST_F(HandshakeTest, AnOldServerIsUsedAsSuch) {
  EXPECT_EQ(failure(answer(create_connection, ErrorCode::protocol_error, "board")),
            ErrorCode::none);
  EXPECT_EQ(agreed_.agreement.version, MessageVersion::v2);
}

TEST_F(HandshakeTest, AnswersThatAreWrongAreRefused) {
  EXPECT_EQ(failure(answer(create_connection, ErrorCode::node_not_found, "board")),
            ErrorCode::node_not_found);
  EXPECT_EQ(failure(answer(create_connection, ErrorCode::none, "another")),
            ErrorCode::connection_error);
  EXPECT_EQ(failure(answer(start_tls, ErrorCode::none, "board")), ErrorCode::protocol_error);
  EXPECT_EQ(failure(Bytes(10)), ErrorCode::protocol_error);
  const std::vector<std::uint32_t> more = {0x02000001, 0x04000001};
  options_.client_offer.message_v4 = false;
  EXPECT_EQ(failure(answer(create_connection, ErrorCode::none, "board", more)),
            ErrorCode::protocol_error);
  agreed_.certified_node = NodeId::random();
  EXPECT_EQ(failure(answer(create_connection, ErrorCode::none, "board")),
            ErrorCode::connection_error);
}

TEST_F(HandshakeTest, MemoryIsAskedForWithSlots) {
  Agreed agreed;
  agreed.remote_node = server;
  Read read(share_memory_request(agreed, options_));
  ASSERT_TRUE(read.is_whole);
  EXPECT_EQ(read.entry.member, share_memory);
  Decoder decoder(read.message.version, &read.message.strings);
  EXPECT_TRUE(has_slots_level(decoder, read.entry));

  const auto without =
      check_share_memory(answer(share_memory, ErrorCode::none, "board"), agreed, options_, "here");
  ASSERT_TRUE(without);
  EXPECT_FALSE(without->has_slots);
  EXPECT_FALSE(check_share_memory(answer(share_memory, ErrorCode::out_of_system_resource, "board"),
                                  agreed, options_, "here"));
  Writer writer;
  writer.reset(MessageVersion::v2);
  const std::size_t end = writer.position();
  write_slots_level(writer);
  writer.entry({.type = EntryType::stream_op_ret, .member = share_memory}, 1, end);
  writer.message({}, 1);
  EXPECT_TRUE(check_share_memory(writer.copy(), agreed, options_, "here")->has_slots);
}

TEST_F(HandshakeTest, TlsIsAskedForAndAnswered) {
  Read mutual(start_tls_request(url, true));
  ASSERT_TRUE(mutual.is_whole);
  EXPECT_EQ(mutual.entry.member, start_tls);
  EXPECT_EQ(mutual.message.receiver_name, "board");
  EXPECT_EQ(mutual.text("mutualauth"), "true");
  Read plain(start_tls_request(url, false));
  EXPECT_EQ(plain.entry.element_count, 0U);
  EXPECT_EQ(check_start_tls(answer(start_tls, ErrorCode::none, "board"), url, options_, "host"),
            server);
  EXPECT_THROW(
      check_start_tls(answer(start_tls, ErrorCode::protocol_error, "board"), url, options_, "host"),
      Error);
}

}  // namespace
}  // namespace rr::channel
