// SPDX-License-Identifier: Apache-2.0
#include "rr/reader.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "runtime/cpp/src/codec/captures.hpp"

namespace rr {
namespace {

using captures::from_hex;
using ::testing::Optional;

// 01, section 10.
constexpr std::string_view call_in_format_2 =
    "52524143 78000000 0200 4000"
    "00112233445566778899aabbccddeeff ffeeddccbbaa99887766554433221100"
    "04030201 0d0c0b0a 0000 0000 0000 0100 0700 0000"
    "38000000 6104 0000 0300737663 06006164646f6e65 2a000000 0000 0000 0100"
    "19000000 010078 0100 0000 0000 01000000 000000000000f83f";
// 02, section 9.1.
constexpr std::string_view call_in_format_4 =
    "52524143 31000000 0400 11 10 00 0700 0000"
    "20 15 6104 03737663 066164646f6e65 2a 01"
    "0f 01 0178 0100 01 000000000000f83f";

bool accepts(std::span<const std::byte> bytes, bool standard_strings = false) {
  Message message;
  const char* what = nullptr;
  const bool accepted = read_message(bytes, Limits{}, standard_strings, message, &what);
  EXPECT_EQ(accepted, what == nullptr);
  return accepted;
}

void expect_call(const std::vector<std::byte>& bytes, MessageVersion version) {
  Message message;
  ASSERT_TRUE(read_message(bytes, Limits{}, false, message, nullptr));
  EXPECT_EQ(message.version, version);
  EXPECT_EQ(message.message_id, 7);
  EXPECT_EQ(message.entry_count, 1U);

  EntryReader entries(message);
  Entry entry;
  ASSERT_TRUE(entries.next(entry));
  EXPECT_EQ(entry.type, EntryType::function_call_req);
  EXPECT_EQ(entry.service_path, "svc");
  EXPECT_EQ(entry.member, "addone");
  EXPECT_EQ(entry.request_id, 42U);
  EXPECT_EQ(entry.error, 0);
  EXPECT_EQ(entry.element_count, 1U);

  Decoder decoder(message.version, &message.strings);
  ElementReader elements(decoder, entry.elements, entry.element_count);
  Element element;
  ASSERT_TRUE(elements.next(element));
  EXPECT_EQ(element.name, "x");
  EXPECT_EQ(element.type, ElementType::double_);
  EXPECT_EQ(element.count, 1U);
  // A view of the message, not a copy.
  EXPECT_EQ(element.payload.data(), bytes.data() + bytes.size() - 8);
  EXPECT_EQ(element.payload.size(), 8U);
  EXPECT_FALSE(elements.next(element));
  EXPECT_TRUE(elements.at_end());
  EXPECT_FALSE(decoder.failed());
  EXPECT_FALSE(entries.next(entry));
}

TEST(Reader, ReadsTheFunctionCallOfTheSpecificationInBothFormats) {
  expect_call(from_hex(call_in_format_2), MessageVersion::v2);
  expect_call(from_hex(call_in_format_4), MessageVersion::v4);
}

TEST(Reader, SaysWhetherRoutingWasThere) {
  const std::vector<std::byte> with = from_hex(call_in_format_2);
  const std::vector<std::byte> without = from_hex(call_in_format_4);
  Message message;
  ASSERT_TRUE(read_message(with, Limits{}, false, message, nullptr));
  EXPECT_TRUE(message.has_routing);
  EXPECT_TRUE(message.has_endpoints);
  EXPECT_EQ(message.sender_endpoint, 0x01020304U);
  EXPECT_EQ(message.receiver_node.text(), "ffeeddcc-bbaa-9988-7766-554433221100");
  ASSERT_TRUE(read_message(without, Limits{}, false, message, nullptr));
  EXPECT_FALSE(message.has_routing);
  EXPECT_FALSE(message.has_endpoints);
  EXPECT_EQ(message.sender_endpoint, 0U);
  EXPECT_TRUE(message.receiver_node.is_any());
}

// 02, section 9.2.
TEST(Reader, ResolvesStringCodes) {
  const std::vector<std::byte> bytes = from_hex(
      "52524143 30000000 0400 1a 20 02 03 03737663 01 066164646f6e65"
      "16 1a 6204 03 01 02 01 0e 02 e4 0100 01 0000000000000440");
  Message message;
  ASSERT_TRUE(read_message(bytes, Limits{}, true, message, nullptr));
  EntryReader entries(message);
  Entry entry;
  ASSERT_TRUE(entries.next(entry));
  EXPECT_EQ(entry.service_path, "svc");
  EXPECT_EQ(entry.member, "addone");
  Decoder decoder(message.version, &message.strings);
  Element element;
  ASSERT_TRUE(ElementReader(decoder, entry.elements, 1).next(element));
  EXPECT_EQ(element.name, "return");

  // The code of `return` is a standard one.
  const char* what = nullptr;
  EXPECT_FALSE(read_message(bytes, Limits{}, false, message, &what));
  EXPECT_STREQ(what, "unknown code of an element name");
}

TEST(Reader, TheTextOfANameWinsOverItsCode) {
  Decoder decoder(MessageVersion::v4);
  Element element;
  const auto both = from_hex("08 03 0178 05 0000 00");
  ASSERT_TRUE(ElementReader(decoder, both, 1).next(element));
  EXPECT_EQ(element.name, "x");
  EXPECT_EQ(element.name_code, 5U);
}

Element read_one(const std::vector<std::byte>& bytes, MessageVersion version) {
  Decoder decoder(version);
  Element element;
  EXPECT_TRUE(ElementReader(decoder, bytes, 1).next(element)) << decoder.message();
  return element;
}

TEST(Reader, AnIndexIsANumberOrADecimalName) {
  const auto v4 = MessageVersion::v4;
  EXPECT_THAT(read_one(from_hex("08 04 7d7fff 0000 00"), v4).index(), Optional(-129));
  EXPECT_THAT(read_one(from_hex("08 01 022d33 0000 00"), v4).index(), Optional(-3));
  EXPECT_THAT(read_one(from_hex("08 01 022b33 0000 00"), v4).index(), Optional(3));
  EXPECT_EQ(read_one(from_hex("09 01 032b2d33 0000 00"), v4).index(), std::nullopt);
  EXPECT_EQ(read_one(from_hex("08 01 022033 0000 00"), v4).index(), std::nullopt);
  EXPECT_EQ(read_one(from_hex("06 01 00 0000 00"), v4).index(), std::nullopt);
  EXPECT_EQ(read_one(from_hex("11 01 0b 3939393939393939393939 0000 00"), v4).index(),
            std::nullopt);
  EXPECT_EQ(read_one(from_hex("05 00 0000 00"), v4).index(), std::nullopt);
  EXPECT_THAT(
      read_one(from_hex("12000000 02002d31 0000 0000 0000 00000000"), MessageVersion::v2).index(),
      Optional(-1));
}

TEST(Reader, AcceptsLongerFormsOfSmallNumbersButNotTheNineByteForm) {
  EXPECT_EQ(read_one(from_hex("fd0c00 01 0178 0b00 03 616263"), MessageVersion::v4).text(), "abc");
  EXPECT_EQ(read_one(from_hex("fe0e000000 01 0178 0b00 03 616263"), MessageVersion::v4).text(),
            "abc");
  EXPECT_EQ(read_one(from_hex("0d 04 7e05000000 0b00 03 616263"), MessageVersion::v4).number, 5);
  for (const char* hex :
       {"ff1200000000000000 01 0178 0b00 03 616263", "11 04 7f0500000000000000 0b00 03 616263"}) {
    const auto bytes = from_hex(hex);
    Decoder decoder(MessageVersion::v4);
    Element element;
    EXPECT_FALSE(ElementReader(decoder, bytes, 1).next(element)) << hex;
    EXPECT_EQ(decoder.code(), ErrorCode::protocol_error);
  }
}

TEST(Reader, ANullMayHaveACountButNoPayload) {
  const Element null = read_one(from_hex("0b 01 0576616c7565 0000 05"), MessageVersion::v4);
  EXPECT_EQ(null.type, ElementType::void_);
  EXPECT_TRUE(null.payload.empty());
  Decoder decoder(MessageVersion::v4);
  Element element;
  const auto with_payload = from_hex("0c 01 0576616c7565 0000 01 00");
  EXPECT_FALSE(ElementReader(decoder, with_payload, 1).next(element));
}

TEST(Reader, MatchesAPreparedPrefixAndOtherwiseStays) {
  static constexpr ScalarPrefix x("x", ElementType::double_);
  static constexpr ScalarPrefix y("y", ElementType::double_);
  const auto bytes = from_hex("0f 01 0178 0100 01 000000000000f83f 0f 01 0179 0100 01");
  Decoder decoder(MessageVersion::v4);
  ElementReader reader(decoder, bytes, 2);
  double value = 0;
  EXPECT_FALSE(reader.match(y, value));
  EXPECT_EQ(reader.left(), 2U);
  EXPECT_TRUE(reader.match(x, value));
  EXPECT_EQ(value, 1.5);
  EXPECT_EQ(reader.left(), 1U);
  EXPECT_FALSE(reader.match(y, value));  // its number is missing
}

TEST(Reader, FindsTheFirstElementOfAName) {
  const auto bytes = from_hex("0801 0161 0400 01 01 0801 0162 0400 01 02 0801 0162 0400 01 03");
  Decoder decoder(MessageVersion::v4);
  Element element;
  ASSERT_TRUE(find_element(decoder, bytes, 3, "b", element));
  EXPECT_EQ(element.payload[0], std::byte{2});
  EXPECT_FALSE(find_element(decoder, bytes, 3, "c", element));
  EXPECT_FALSE(decoder.failed());
}

TEST(Reader, FirstTenBytesSayHowLongAMessageIs) {
  const auto size = [](std::string_view hex) { return message_size(from_hex(hex), Limits{}); };
  EXPECT_EQ(size("52524143 78000000 0200"), 120U);
  EXPECT_EQ(size("52524143 10000000 0400"), 16U);
  EXPECT_EQ(size("52524143 0f000000 0400"), 0U);
  EXPECT_EQ(size("52524143 0000c000 0400"), 12U * 1024 * 1024);
  EXPECT_EQ(size("52524143 0100c000 0400"), 0U);
  EXPECT_EQ(size("52524143 78000000 0300"), 0U);
  EXPECT_EQ(size("72524143 78000000 0200"), 0U);
}

TEST(Reader, RefusesAMessageWithoutEntries) {
  EXPECT_FALSE(accepts(from_hex("52524143 12000000 0400 12 50 00 2400 0000 00")));
  EXPECT_FALSE(accepts(
      from_hex("5252414340000000020040000000000000000000000000000000000000000000000000000000"
               "000000000000000000000000000000000000000000000000000000")));
}

TEST(Reader, WantsTheExactHeaderSize) {
  const std::vector<std::byte> v2 = from_hex(call_in_format_2);
  const std::vector<std::byte> v4 = from_hex(call_in_format_4);
  for (int size = 0; size < 256; ++size) {
    std::vector<std::byte> changed = v2;
    changed[10] = static_cast<std::byte>(size);
    EXPECT_EQ(accepts(changed), size == 64) << size;
    changed = v4;
    changed[10] = static_cast<std::byte>(size);
    EXPECT_EQ(accepts(changed), size == 17) << size;
  }
}

TEST(Reader, IgnoresReservedFieldsAndFlags) {
  std::vector<std::byte> v2 = from_hex(call_in_format_2);
  v2[70] = v2[71] = std::byte{0xff};  // of the entry
  EXPECT_TRUE(accepts(v2));
  std::vector<std::byte> v4 = from_hex(call_in_format_4);
  v4[11] |= std::byte{0x08};  // UNRELIABLE
  v4[35] |= std::byte{0x40};  // of the element
  EXPECT_TRUE(accepts(v4));
}

TEST(Reader, ToleratesEvenAndRepeatedCodesOfATableButNeverUsesThem) {
  EXPECT_TRUE(
      accepts(from_hex("52524143 1a000000 0400 13 20 02 02 0161 01 0162 07 05 6f00 00 00 00")));
  EXPECT_TRUE(
      accepts(from_hex("52524143 1a000000 0400 13 20 02 01 0161 01 0162 07 05 6f00 00 00 00")));
  EXPECT_FALSE(accepts(from_hex("52524143 17000000 0400 10 20 01 02 0161 07 06 6f00 02 00 00")));
}

std::vector<std::byte> nested(MessageVersion version, std::uint32_t depth) {
  Writer writer;
  writer.reset(version);
  writer.null_element(ElementName(0));
  for (std::uint32_t i = 1; i < depth; ++i) {
    writer.element(ElementName(0), ElementType::list, {}, 1, 0);
  }
  writer.entry({}, 1, 0);
  writer.message({}, 1);
  return writer.copy();
}

TEST(Reader, BoundsTheDepth) {
  for (const MessageVersion version : {MessageVersion::v2, MessageVersion::v4}) {
    EXPECT_TRUE(accepts(nested(version, 64)));
    EXPECT_FALSE(accepts(nested(version, 65)));
    EXPECT_FALSE(accepts(nested(version, 100'000)));

    Limits limits;
    limits.depth = 3;
    Message message;
    EXPECT_TRUE(read_message(nested(version, 3), limits, false, message, nullptr));
    EXPECT_FALSE(read_message(nested(version, 4), limits, false, message, nullptr));
    limits.depth = 1'000'000;
    EXPECT_FALSE(read_message(nested(version, 65), limits, false, message, nullptr));
  }
}

// Who checks a large message may let others go first, however its elements are nested.
TEST(Reader, SaysThatItGoesOnAfterEachThousandElements) {
  static int calls = 0;
  const auto calls_for = [](MessageVersion version, int lists, int items) {
    Writer writer;
    writer.reset(version);
    const std::size_t end = writer.position();
    for (int i = 0; i < lists; ++i) {
      const std::size_t list_end = writer.position();
      for (int k = 0; k < items; ++k) {
        writer.element(ElementName(k), ElementType::void_, {}, 0, writer.position());
      }
      writer.element(ElementName(i), ElementType::list, {}, static_cast<std::uint32_t>(items),
                     list_end);
    }
    writer.element("value", ElementType::list, {}, static_cast<std::uint32_t>(lists), end);
    writer.entry({.type = EntryType::function_call_req, .service_path = "svc", .member = "f"}, 1,
                 end);
    writer.message({}, 1);
    Message message;
    Entry first;
    calls = 0;
    EXPECT_TRUE(read_message(writer.copy(), Limits{}, false, message, first, [] { ++calls; }));
    return calls;
  };
  for (const MessageVersion version : {MessageVersion::v2, MessageVersion::v4}) {
    EXPECT_EQ(calls_for(version, 1, 1'000), 0);
    EXPECT_EQ(calls_for(version, 1, 1'022), 1);
    EXPECT_EQ(calls_for(version, 100, 100), 9);
  }
}

TEST(Reader, ChecksElementsFromElsewhere) {
  const auto list = from_hex(
      "27 01 0576616c7565 6c00 02"
      "0e 04 00 0100 01 000000000000f03f 0e 04 01 0100 01 0000000000000040");
  Decoder good(MessageVersion::v4);
  EXPECT_TRUE(check_elements(good, list, 1, Limits{}));
  Decoder bad(MessageVersion::v4);
  EXPECT_FALSE(check_elements(bad, list, 2, Limits{}));
  EXPECT_EQ(bad.code(), ErrorCode::protocol_error);
  Decoder cut(MessageVersion::v4);
  EXPECT_FALSE(check_elements(cut, std::span(list).first(38), 1, Limits{}));
}

TEST(Reader, RefusesABeginningThatContradictsItsSize) {
  for (const std::string_view hex : {call_in_format_2, call_in_format_4}) {
    std::vector<std::byte> bytes = from_hex(hex);
    const std::size_t whole = bytes.size();
    for (std::size_t size = 10; size <= whole; ++size) {
      EXPECT_TRUE(can_be_message(std::span(bytes).first(size), whole)) << size;
    }
    // With the size of its only entry in sight, it is clear where the message ends.
    const std::size_t entry_seen = hex == call_in_format_2 ? 68 : 18;
    EXPECT_TRUE(can_be_message(std::span(bytes).first(entry_seen - 1), whole + 1));
    EXPECT_FALSE(can_be_message(std::span(bytes).first(entry_seen), whole + 1));
    EXPECT_FALSE(can_be_message(std::span(bytes).first(entry_seen), whole - 1));
    EXPECT_FALSE(can_be_message(bytes, whole + 100));
  }
}

TEST(Reader, SeesTheLargestArrayBeforeTheMessageIsThere) {
  const std::vector<double> small(10, 1.0);
  const std::vector<double> large(5000, 2.0);
  const std::vector<std::uint8_t> bytes(100'000, 3);
  for (const MessageVersion version : {MessageVersion::v2, MessageVersion::v4}) {
    Writer writer;
    writer.reset(version);
    const auto array = [&](const ElementName& name, ElementType type, const auto& items) {
      const std::size_t end = writer.position();
      writer.prepend_array(std::as_bytes(std::span(items)), {});
      writer.element(name, type, {}, static_cast<std::uint32_t>(items.size()), end);
    };
    array("bytes", ElementType::uint8, bytes);
    array("large", ElementType::double_, large);
    const std::size_t end = writer.position();
    array("small", ElementType::double_, small);
    writer.element("s", ElementType::structure, "a.b", 1, end);
    writer.entry({}, 3, 0);
    writer.message({}, 1);
    const std::vector<std::byte> whole = writer.copy();

    const std::size_t offset = largest_array_offset(whole, whole.size());
    double first = 0;
    ASSERT_LE(offset + sizeof first, whole.size());
    std::memcpy(&first, whole.data() + offset, sizeof first);
    EXPECT_EQ(first, 2.0);
    EXPECT_EQ(largest_array_offset(std::span(whole).first(offset), whole.size()), offset);
    // One byte less, and the count of the array is not there yet.
    const std::size_t before =
        largest_array_offset(std::span(whole).first(offset - 1), whole.size());
    ASSERT_NE(before, 0U);
    std::memcpy(&first, whole.data() + before, sizeof first);
    EXPECT_EQ(first, 1.0);
    EXPECT_EQ(largest_array_offset(std::span(whole).first(20), whole.size()), 0U);
  }
}

}  // namespace
}  // namespace rr
