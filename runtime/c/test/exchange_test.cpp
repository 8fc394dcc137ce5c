// SPDX-License-Identifier: Apache-2.0
// C against C++, in both roles and both formats; values that are large, and those of named types.
#include <gtest/gtest.h>

#include <cstring>

#include "runtime/c/test/handles.hpp"
#include "runtime/cpp/src/node/testing/all_members.hpp"
#include "runtime/cpp/src/node/testing/pair.hpp"

namespace rr::testing::c {
namespace {

class Exchange : public ::testing::TestWithParam<bool> {};

TEST_P(Exchange, ACClientUsesAllMembersOfACppService) {
  NodeOptions options;
  options.server_offer.message_v4 = GetParam();
  Node server(options);
  const AllMembers offered(server);
  const NodeHandle node = make_node();
  const char* const wrong = all_members_use(node.get(), offered.port());
  EXPECT_STREQ(wrong == nullptr ? "" : wrong, "");
}

TEST_P(Exchange, ACppClientUsesAllMembersOfACService) {
  const NodeHandle server = make_node();
  all_members* const offered = all_members_offer(server.get());
  NodeOptions options;
  options.client_offer.message_v4 = GetParam();
  {
    Node client(options);
    AllMembers::use(client, listen(server));
  }
  all_members_release(offered);
}

// Codes of a string table are spelled out for programs that know nothing of them.
TEST_P(Exchange, StringTablesAreNotSeen) {
  NodeOptions options;
  options.server_offer.message_v4 = GetParam();
  options.server_offer.string_table = true;
  Node server(options);
  const AllMembers offered(server);
  const NodeHandle node = make_node();
  const char* const wrong = all_members_use(node.get(), offered.port());
  EXPECT_STREQ(wrong == nullptr ? "" : wrong, "");
}

INSTANTIATE_TEST_SUITE_P(Formats, Exchange, ::testing::Values(true, false));

TEST(Values, OfNamedTypesGoThroughAsTheyAre) {
  Node server;
  auto service = server.register_service("counter", std::make_shared<Counter>());
  const std::uint16_t port = server.listen_tcp(0, "127.0.0.1");
  rr_node_options options{};
  options.size = sizeof options;
  for (const std::uint32_t without : {0U, std::uint32_t{RR_WITHOUT_V4}}) {
    options.client_without = without;
    const NodeHandle node = make_node(&options);
    const ClientHandle client = connect(node, port, "counter");
    ASSERT_TRUE(client);
    EXPECT_EQ(rr_client_message_version(client.get()), without == 0 ? 4U : 2U);
    Packed picture;
    picture.number("value", 7.5).words("label", "hall").bytes("picture", std::string(30'000, 'x'));
    packer reading{};
    pack_nested(&reading, "value", 101, "test.counter.Reading", &picture.content());
    const rr_elements argument = packed(&reading);
    const Outcome outcome = call(root_of(client), "any", &argument);
    packer_free(&reading);
    ASSERT_EQ(outcome.status, RR_OK) << outcome.message;
    const rr_elements answer = rr_data_elements(outcome.data.get());
    unpacked value{};
    ASSERT_TRUE(unpack(&answer, "return", &value));
    EXPECT_EQ(value.type, 101);
    const rr_elements fields{value.payload, value.size, value.count, answer.version};
    EXPECT_EQ(unpack_double(&fields, "value"), 7.5);
    EXPECT_TRUE(unpack_is_text(&fields, "label", "hall"));
    unpacked bytes{};
    ASSERT_TRUE(unpack(&fields, "picture", &bytes));
    EXPECT_EQ(bytes.count, 30'000U);
  }
}

// A value that has `reference` for its array, in a struct or not.
std::vector<std::byte> with_reference(MessageVersion version, const rr_array_reference& reference,
                                      bool in_struct) {
  const std::span<const std::byte> bytes = std::as_bytes(std::span(&reference, 1));
  Writer writer;
  writer.reset(version);
  const std::size_t end = writer.position();
  writer.prepend_array(bytes, {});
  writer.element(in_struct ? "picture" : "value", ElementType::uint8, {}, RR_REFERENCE, {},
                 static_cast<std::uint32_t>(bytes.size()), end);
  if (in_struct) {
    writer.string_element("label", "hall");
    const std::size_t number = writer.position();
    const double value = 7.5;
    writer.prepend_array(std::as_bytes(std::span(&value, 1)), {});
    writer.element("value", ElementType::double_, {}, 1, number);
    writer.element("value", ElementType::structure, "test.counter.Reading", 3, end);
  }
  return writer.copy();
}

rr_elements elements_of(const std::vector<std::byte>& bytes, std::uint32_t version) {
  return {reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size(), 1,
          version | RR_WITH_REFERENCES};
}

TEST(Values, MayReferToArraysThatLieElsewhere) {
  Node server;
  auto service = server.register_service("counter", std::make_shared<Counter>());
  const std::uint16_t port = server.listen_tcp(0, "127.0.0.1");
  std::vector<std::uint8_t> items(100'000);
  for (std::size_t i = 0; i < items.size(); ++i) items[i] = static_cast<std::uint8_t>(i * 31);
  const rr_array_reference reference{items.data(), items.size(), 4, 0};
  rr_node_options options{};
  options.size = sizeof options;
  for (const std::uint32_t without : {0U, std::uint32_t{RR_WITHOUT_V4}}) {
    options.client_without = without;
    const NodeHandle node = make_node(&options);
    const ClientHandle client = connect(node, port, "counter");
    ASSERT_TRUE(client);
    for (const std::uint32_t version : {2U, 4U}) {
      for (const bool in_struct : {false, true}) {
        const auto bytes =
            with_reference(static_cast<MessageVersion>(version), reference, in_struct);
        const rr_elements argument = elements_of(bytes, version);
        const Outcome outcome = call(root_of(client), "any", &argument);
        ASSERT_EQ(outcome.status, RR_OK) << outcome.message;
        rr_elements answer = rr_data_elements(outcome.data.get());
        unpacked value{};
        ASSERT_TRUE(unpack(&answer, "return", &value));
        if (in_struct) {
          answer = {value.payload, value.size, value.count, answer.version};
          EXPECT_TRUE(unpack_is_text(&answer, "label", "hall"));
          ASSERT_TRUE(unpack(&answer, "picture", &value));
        }
        EXPECT_EQ(value.type, 4);
        ASSERT_EQ(value.count, items.size());
        EXPECT_EQ(std::memcmp(value.payload, items.data(), value.size), 0);
      }
    }
  }
}

TEST(Values, ThatReferToNoArrayAreRefused) {
  Pair pair;
  const double item = 1;
  const auto refused = [&](const rr_array_reference& reference) {
    for (const bool in_struct : {false, true}) {
      const auto bytes = with_reference(MessageVersion::v4, reference, in_struct);
      const rr_elements argument = elements_of(bytes, 4);
      rr_data* data = nullptr;
      EXPECT_EQ(rr_elements_convert(&argument, 2, &data, nullptr), RR_DATA_SERIALIZATION_ERROR);
      EXPECT_EQ(call(pair.root, "any", &argument).status, RR_DATA_SERIALIZATION_ERROR);
    }
  };
  refused({nullptr, 1, 1, 0});
  refused({&item, 1, 101, 0});      // a struct
  refused({&item, 1, 0x10001, 0});  // no type at all
  refused({&item, 1ULL << 32, 1, 0});
  auto bytes = with_reference(MessageVersion::v4, {&item, 1, 1, 0}, false);
  rr_elements argument = elements_of(bytes, 4);
  rr_data* data = nullptr;
  ASSERT_EQ(rr_elements_convert(&argument, 4, &data, nullptr), RR_OK);
  const DataHandle followed(data);
  const rr_elements elements = rr_data_elements(data);
  EXPECT_EQ(unpack_double(&elements, "value"), 1);
  argument.version = 4;  // nothing special then
  ASSERT_EQ(rr_elements_convert(&argument, 4, &data, nullptr), RR_OK);
  const DataHandle kept(data);
  EXPECT_EQ(rr_data_elements(data).size, bytes.size());
}

TEST(Values, StayWhileTheyAreHeld) {
  Pair pair;
  packer size{};
  pack_uint32(&size, "size", 1'000'000);
  const rr_elements argument = packed(&size);
  Outcome outcome = call(pair.root, "blob", &argument);
  packer_free(&size);
  ASSERT_EQ(outcome.status, RR_OK);
  const DataHandle again(rr_data_retain(outcome.data.get()));
  outcome.data.reset();
  pair.client.reset();
  const rr_elements elements = rr_data_elements(again.get());
  unpacked bytes{};
  ASSERT_TRUE(unpack(&elements, "return", &bytes));
  ASSERT_EQ(bytes.count, 1'000'000U);
  EXPECT_EQ(bytes.payload[999'999], static_cast<std::uint8_t>(999'999 * 31 + 7));
}

TEST(Values, AreConvertedBetweenFormats) {
  Packed inner;
  inner.number("a", 1).words("b", "two");
  packer outer{};
  pack_nested(&outer, "map", PACK_DICTIONARY, nullptr, &inner.content());
  pack_int32(&outer, "number", 3);
  const rr_elements given = packed(&outer);
  rr_data* old_format = nullptr;
  ASSERT_EQ(rr_elements_convert(&given, 2, &old_format, nullptr), RR_OK);
  const DataHandle first(old_format);
  const rr_elements two = rr_data_elements(first.get());
  EXPECT_EQ(two.version, 2U);
  EXPECT_EQ(two.count, 2U);
  rr_data* new_format = nullptr;
  ASSERT_EQ(rr_elements_convert(&two, 4, &new_format, nullptr), RR_OK);
  const DataHandle second(new_format);
  const rr_elements four = rr_data_elements(second.get());
  ASSERT_EQ(four.size, given.size);
  EXPECT_EQ(std::memcmp(four.data, given.data, given.size), 0);
  packer_free(&outer);
}

TEST(Values, ThatAreNoElementsAreRefused) {
  Pair pair;
  Packed argument;
  argument.words("text", "hello");
  rr_elements wrong = *&argument;
  wrong.size -= 1;
  EXPECT_EQ(call(pair.root, "echo", &wrong).status, RR_DATA_SERIALIZATION_ERROR);
  wrong = *&argument;
  wrong.count = 2;
  EXPECT_EQ(call(pair.root, "echo", &wrong).status, RR_DATA_SERIALIZATION_ERROR);
  wrong = *&argument;
  wrong.version = 3;
  EXPECT_EQ(call(pair.root, "echo", &wrong).status, RR_DATA_SERIALIZATION_ERROR);
  wrong = *&argument;
  wrong.data = nullptr;
  EXPECT_EQ(call(pair.root, "echo", &wrong).status, RR_DATA_SERIALIZATION_ERROR);
  EXPECT_EQ(call(pair.root, "echo", &argument).status, RR_OK);
}

}  // namespace
}  // namespace rr::testing::c
