// SPDX-License-Identifier: Apache-2.0
#include "rr/writer.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "runtime/cpp/src/codec/captures.hpp"

namespace rr {
namespace {

using captures::from_hex;
using ::testing::SizeIs;

MessageHeader example_header() {
  MessageHeader header;
  header.sender_node = *NodeId::parse("00112233-4455-6677-8899-aabbccddeeff");
  header.receiver_node = *NodeId::parse("ffeeddcc-bbaa-9988-7766-554433221100");
  header.sender_endpoint = 0x01020304;
  header.receiver_endpoint = 0x0a0b0c0d;
  header.message_id = 7;
  return header;
}

EntryHeader call_addone() {
  EntryHeader entry;
  entry.type = EntryType::function_call_req;
  entry.service_path = "svc";
  entry.member = "addone";
  entry.request_id = 42;
  return entry;
}

template <class T>
void scalar(Writer& writer, const ElementName& name, ElementType type, T value) {
  const std::size_t end = writer.position();
  writer.prepend_bytes(&value, sizeof value);
  writer.element(name, type, {}, 1, end);
}

std::vector<std::byte> call_addone_message(MessageVersion version, bool routing) {
  Writer writer;
  writer.reset(version);
  scalar(writer, "x", ElementType::double_, 1.5);
  writer.entry(call_addone(), 1, 0);
  MessageHeader header = example_header();
  header.routing = routing;
  writer.message(header, 1);
  EXPECT_FALSE(writer.failed());
  return writer.copy();
}

template <class Write>
std::vector<std::byte> written(MessageVersion version, const Write& write) {
  Writer writer;
  writer.reset(version);
  write(writer);
  EXPECT_FALSE(writer.failed());
  return writer.copy();
}

void list_of_two(Writer& writer) {
  scalar(writer, ElementName(1), ElementType::double_, 2.0);
  scalar(writer, ElementName(0), ElementType::double_, 1.0);
  writer.element("value", ElementType::list, {}, 2, 0);
}

void structure_sub(Writer& writer) {
  scalar(writer, "n", ElementType::int32, std::int32_t{5});
  writer.element("value", ElementType::structure, "experimental.probe.sub", 1, 0);
}

// 01, section 10.
TEST(Writer, WritesTheFunctionCallOfTheSpecificationInFormat2) {
  EXPECT_EQ(call_addone_message(MessageVersion::v2, true),
            from_hex("52524143 78000000 0200 4000"
                     "00112233445566778899aabbccddeeff ffeeddccbbaa99887766554433221100"
                     "04030201 0d0c0b0a 0000 0000 0000 0100 0700 0000"
                     "38000000 6104 0000 0300737663 06006164646f6e65 2a000000 0000 0000 0100"
                     "19000000 010078 0100 0000 0000 01000000 000000000000f83f"));
}

// 01, section 12.
TEST(Writer, WritesTheFirstMessageOfAConnection) {
  Writer writer;
  writer.reset(MessageVersion::v2);
  constexpr std::array<std::uint32_t, 3> capabilities = {0x02000003, 0x04000003, 0x04100007};
  writer.prepend_array(std::as_bytes(std::span(capabilities)), {});
  writer.element("capabilities", ElementType::uint32, {}, 3, 0);
  EntryHeader entry;
  entry.type = EntryType::stream_op;
  entry.member = "CreateConnection";
  writer.entry(entry, 1, 0);
  MessageHeader header;
  header.sender_node = *NodeId::parse("99999999-8888-7777-6666-555555555555");
  header.sender_name = "probe_client";
  header.receiver_name = "probe_server";
  writer.message(header, 1);
  EXPECT_EQ(writer.copy(), from_hex("52524143a600000002005800 99999999888877776666555555555555"
                                    "00000000000000000000000000000000 0000000000000000"
                                    "0c0070726f62655f636c69656e74 0c0070726f62655f736572766572"
                                    "0000010000000000 4e000000010000000000"
                                    "1000437265617465436f6e6e656374696f6e 00000000000000000100"
                                    "280000000c006361706162696c697469657308000000000003000000"
                                    "030000020300000407001004"));
}

// 02, section 9.1.
TEST(Writer, LeavesRoutingOutInFormat4) {
  EXPECT_EQ(call_addone_message(MessageVersion::v4, false),
            from_hex("52524143 31000000 0400 11 10 00 0700 0000"
                     "20 15 6104 03737663 066164646f6e65 2a 01"
                     "0f 01 0178 0100 01 000000000000f83f"));
}

// 02, section 9.1.
TEST(Writer, WritesFullRoutingInFormat4) {
  EXPECT_EQ(call_addone_message(MessageVersion::v4, true),
            from_hex("52524143 5d000000 0400 3d 13"
                     "00112233445566778899aabbccddeeff ffeeddccbbaa99887766554433221100"
                     "0000 fe04030201 fe0d0c0b0a 0007000000"
                     "20 15 6104 03737663 066164646f6e65 2a 01"
                     "0f 01 0178 0100 01 000000000000f83f"));
}

// 02, section 9.3.
TEST(Writer, WritesTheShortestHeader) {
  MessageHeader header;
  header.routing = false;
  EntryHeader entry;
  entry.type = EntryType::connection_test_ret;
  EXPECT_EQ(written(MessageVersion::v4,
                    [&](Writer& writer) {
                      writer.entry(entry, 0, 0);
                      writer.message(header, 1);
                    }),
            from_hex("52524143 13000000 0400 0c 00 07 05 7000 00 00 00"));
}

// 01, section 11.
TEST(Writer, WritesNestedElementsInFormat2) {
  EXPECT_EQ(written(MessageVersion::v2, list_of_two),
            from_hex("47000000 050076616c7565 6c00 0000 0000 02000000"
                     "19000000 010030 0100 0000 0000 01000000 000000000000f03f"
                     "19000000 010031 0100 0000 0000 01000000 0000000000000040"));
  EXPECT_EQ(written(MessageVersion::v2, structure_sub),
            from_hex("40000000 050076616c7565 6500"
                     "1600 6578706572696d656e74616c2e70726f62652e737562 0000 01000000"
                     "15000000 01006e 0700 0000 0000 01000000 05000000"));
}

// 02, section 9.3.
TEST(Writer, WritesNestedElementsInFormat4) {
  EXPECT_EQ(written(MessageVersion::v4, list_of_two),
            from_hex("27 01 0576616c7565 6c00 02"
                     "0e 04 00 0100 01 000000000000f03f 0e 04 01 0100 01 0000000000000040"));
  EXPECT_EQ(written(MessageVersion::v4, structure_sub),
            from_hex("2d 09 0576616c7565 6500"
                     "16 6578706572696d656e74616c2e70726f62652e737562 01"
                     "0b 01 016e 0700 01 05000000"));
}

// 01, section 11 and 02, section 9.3.
TEST(Writer, WritesNullAndStrings) {
  const auto null = [](Writer& writer) { writer.null_element("value"); };
  const auto text = [](Writer& writer) { writer.string_element("value", "h\xc3\xa9"); };
  EXPECT_EQ(written(MessageVersion::v2, null),
            from_hex("15000000 050076616c7565 0000 0000 0000 00000000"));
  EXPECT_EQ(written(MessageVersion::v4, null), from_hex("0b 01 0576616c7565 0000 00"));
  EXPECT_EQ(written(MessageVersion::v2, text),
            from_hex("18000000 050076616c7565 0b00 0000 0000 03000000 68c3a9"));
  EXPECT_EQ(written(MessageVersion::v4, text), from_hex("0e 01 0576616c7565 0b00 03 68c3a9"));
}

// 02, section 1.2: the number of an element without payload is all that varies.
TEST(Writer, WritesNumbersInTheirShortestForm) {
  const auto numbered = [](std::int32_t number) {
    return written(MessageVersion::v4,
                   [&](Writer& writer) { writer.null_element(ElementName(number)); });
  };
  EXPECT_EQ(numbered(-129), from_hex("08 04 7d7fff 0000 00"));
  EXPECT_EQ(numbered(-128), from_hex("06 04 80 0000 00"));
  EXPECT_EQ(numbered(-3), from_hex("06 04 fd 0000 00"));
  EXPECT_EQ(numbered(124), from_hex("06 04 7c 0000 00"));
  EXPECT_EQ(numbered(125), from_hex("08 04 7d7d00 0000 00"));
  EXPECT_EQ(numbered(127), from_hex("08 04 7d7f00 0000 00"));
  EXPECT_EQ(numbered(128), from_hex("08 04 7d8000 0000 00"));
  EXPECT_EQ(numbered(200), from_hex("08 04 7dc800 0000 00"));
  EXPECT_EQ(numbered(32767), from_hex("08 04 7dff7f 0000 00"));
  EXPECT_EQ(numbered(32768), from_hex("0a 04 7e00800000 0000 00"));
  EXPECT_EQ(numbered(-40000), from_hex("0a 04 7ec063ffff 0000 00"));
  EXPECT_EQ(numbered(std::numeric_limits<std::int32_t>::min()), from_hex("0a047e00000080000000"));
}

TEST(Writer, SpellsNumbersInFormat2) {
  EXPECT_EQ(written(MessageVersion::v2,
                    [](Writer& writer) { writer.null_element(ElementName(-2147483647 - 1)); }),
            from_hex("1b000000 0b00 2d32313437343833363438 0000 0000 0000 00000000"));
}

// 02, section 1.3: a size counts its own bytes, which depend on it.
TEST(Writer, CountsTheBytesOfASizeInIt) {
  const auto start = [](std::size_t others) {
    // Flags, a name of one byte, type and count take 6 bytes, and more for long texts.
    const std::size_t count_bytes = others < 255 ? 0 : 2;
    const std::string text(others - 6 - count_bytes, 't');
    const auto bytes =
        written(MessageVersion::v4, [&](Writer& writer) { writer.string_element("s", text); });
    return std::vector<std::byte>(bytes.begin(), bytes.begin() + 5);
  };
  EXPECT_EQ(start(251), from_hex("fc 01 0173 0b"));
  EXPECT_EQ(start(252), from_hex("fdff00 01 01"));
  EXPECT_EQ(start(65532), from_hex("fdffff 01 01"));
  EXPECT_EQ(start(65533), from_hex("fe02000100"));
}

TEST(Writer, CopiesAPreparedPrefix) {
  static constexpr ScalarPrefix prefix("speed", ElementType::double_);
  const auto bytes = written(MessageVersion::v4, [](Writer& writer) {
    writer.prepend_scalar(prefix, 2.5);
    writer.prepend_scalar(prefix, 1.5);
  });
  const auto general = written(MessageVersion::v4, [](Writer& writer) {
    scalar(writer, "speed", ElementType::double_, 2.5);
    scalar(writer, "speed", ElementType::double_, 1.5);
  });
  EXPECT_EQ(bytes, general);
  static constexpr ScalarPrefix too_long("a_name_that_does_not_fit_into_it", ElementType::double_);
  EXPECT_EQ(too_long.length, 0);
}

TEST(Writer, GathersLargeArraysAndCopiesSmallOnes) {
  const std::vector<std::byte> large(Writer::attach_threshold, std::byte{7});
  const std::vector<std::byte> small(Writer::attach_threshold - 1, std::byte{9});
  Writer writer;
  writer.reset(MessageVersion::v4);
  const auto array = [&](const std::vector<std::byte>& data) {
    const std::size_t end = writer.position();
    writer.prepend_array(data, {});
    writer.element("a", ElementType::uint8, {}, static_cast<std::uint32_t>(data.size()), end);
  };
  array(large);
  array(small);
  array(large);
  writer.entry({}, 3, 0);
  writer.message({}, 1);

  const auto pieces = writer.pieces();
  ASSERT_THAT(pieces, SizeIs(4));
  EXPECT_EQ(pieces[1].data, large.data());
  EXPECT_EQ(pieces[3].data, large.data());
  std::size_t total = 0;
  for (const Piece& piece : pieces) total += piece.size;
  EXPECT_EQ(total, writer.size());

  const std::vector<std::byte> whole = writer.copy();
  EXPECT_EQ(whole.size(), writer.size());
  EXPECT_EQ(std::vector(whole.end() - 20000, whole.end() - 20000 + 10),
            std::vector(10, std::byte{9}));
  EXPECT_EQ(whole.back(), std::byte{7});
}

TEST(Writer, KeepsAnAttachedArrayAliveUntilReset) {
  Allocation allocation = allocate(Writer::attach_threshold);
  Writer writer;
  writer.reset(MessageVersion::v4);
  writer.prepend_array({allocation.bytes, Writer::attach_threshold}, allocation.owner);
  EXPECT_FALSE(allocation.owner.is_unique());
  writer.reset(MessageVersion::v4);
  EXPECT_TRUE(allocation.owner.is_unique());
}

TEST(Writer, RefusesWhatTheFormatsCannotHold) {
  const std::string longest(65535, 'n');
  const std::string too_long(65536, 'n');
  for (const MessageVersion version : {MessageVersion::v2, MessageVersion::v4}) {
    Writer writer;
    writer.reset(version);
    writer.null_element(longest);
    EXPECT_FALSE(writer.failed());
    // Format 2 spells the size of a text in two bytes, the elements of format 4 do not.
    const bool is_short = version == MessageVersion::v2;
    writer.null_element(too_long);
    EXPECT_EQ(writer.failed(), is_short);

    writer.reset(version);
    EXPECT_FALSE(writer.failed());
    EXPECT_EQ(writer.size(), 0U);
    writer.element("e", ElementType::structure, too_long, 0, 0);
    EXPECT_EQ(writer.failed(), is_short);

    writer.reset(version);
    EntryHeader entry;
    entry.member = too_long;
    writer.entry(entry, 0, 0);
    EXPECT_TRUE(writer.failed());
    EXPECT_EQ(writer.code(), ErrorCode::protocol_error);

    writer.reset(version);
    MessageHeader header;
    header.metadata = too_long;
    writer.message(header, 1);
    EXPECT_TRUE(writer.failed());

    writer.reset(version);
    writer.message({}, 65536);
    EXPECT_TRUE(writer.failed());
  }
}

TEST(Writer, BoundsElementCountAndHeaderSizeOfFormat2) {
  Writer writer;
  writer.reset(MessageVersion::v2);
  writer.entry({}, 65536, 0);
  EXPECT_TRUE(writer.failed());

  writer.reset(MessageVersion::v4);
  writer.entry({}, 65536, 0);
  EXPECT_FALSE(writer.failed());

  const std::string name(40000, 'n');
  MessageHeader header;
  header.sender_name = name;
  header.receiver_name = name;
  writer.reset(MessageVersion::v2);
  writer.message(header, 1);
  EXPECT_TRUE(writer.failed());
}

}  // namespace
}  // namespace rr
