// SPDX-License-Identifier: Apache-2.0
#include "conformance/harness/explanation.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "conformance/harness/decoded.hpp"

namespace rr::conformance {
namespace {

const Frame& title_of_second_folder() {
  static const Captures all = read_captures(CONFORMANCE_SECOND);
  return all.find("properties", "v2")->frames.at(5);
}

TEST(Explanation, NamesTheEntryAndTheElement) {
  const Json recorded = title_of_second_folder().decoded;
  Json live = recorded;
  live["entries"][0]["elements"][0]["value"] = "other";
  EXPECT_EQ(
      describe_difference(recorded, live),
      "entry 1 (PropertyGetRes oven.title), element value: \"µ-oven\" recorded, \"other\" came");
  live = recorded;
  live["header"]["message_id"] = 7;
  live["entries"][0].erase("elements");
  const std::string text = describe_difference(recorded, live);
  EXPECT_NE(text.find("header, message_id: "), std::string::npos) << text;
  EXPECT_NE(text.find(", nothing came"), std::string::npos) << text;
}

TEST(Explanation, NamesItemsAndWhatCameOnTop) {
  EXPECT_EQ(describe_difference(Json::parse(R"({"value": [1, 2]})"),
                                Json::parse(R"({"value": [1, 3, 4]})")),
            "item 2: 2 recorded, 3 came; one item more: nothing recorded, 4 came");
  EXPECT_EQ(describe_difference(1, 1), "");
  EXPECT_EQ(describe_difference(1, 2), "1 recorded, 2 came");
}

TEST(Explanation, ShowsThreePlaces) {
  const std::string text =
      describe_difference(Json::parse("[1, 2, 3, 4, 5]"), Json::parse("[6, 7, 8, 9, 10]"));
  EXPECT_TRUE(text.ends_with("; and 2 more")) << text;
}

TEST(Explanation, ShowsWhereBytesBeginToDiffer) {
  EXPECT_EQ(describe_bytes(bytes_of_hex("010203"), bytes_of_hex("0104")),
            "byte 1 of 3: 0203 recorded, 04 came");
  EXPECT_EQ(describe_bytes(bytes_of_hex("0102"), bytes_of_hex("010203")),
            "byte 2 of 2: the end recorded, 03 came");
}

TEST(Explanation, AFrameThatContradictsItselfIsSaidToBeAtFault) {
  Frame frame = title_of_second_folder();
  EXPECT_EQ(contradiction(frame), std::nullopt);
  frame.bytes.back() = std::byte{'m'};
  EXPECT_EQ(contradiction(frame),
            "the recording contradicts itself: entry 1 (PropertyGetRes oven.title), element value: "
            "\"µ-oven\" in its `decoded`, \"µ-ovem\" in its `hex`");
  frame.bytes.resize(3);
  EXPECT_EQ(contradiction(frame), "the recording's `hex` is not a message");
}

Json element(ElementType type, const Json& value) {
  return {{"type", static_cast<int>(type)}, {"value", {value}}};
}

TEST(Explanation, FloatsMayLackTheirLastDigit) {
  const double tenth = 0.1;
  EXPECT_TRUE(is_nearly(element(ElementType::double_, std::nextafter(tenth, 1)),
                        element(ElementType::double_, tenth)));
  EXPECT_FALSE(is_nearly(element(ElementType::double_, tenth + 1e-15),
                         element(ElementType::double_, tenth)));
  EXPECT_TRUE(
      is_nearly(element(ElementType::double_, 4.9e-324), element(ElementType::double_, 0.0)));
  // A float as those write it who have made a double of it, and with few digits.
  const double single = 0.1F;
  EXPECT_TRUE(is_nearly(element(ElementType::single, single), element(ElementType::single, 0.1)));
  EXPECT_FALSE(is_nearly(element(ElementType::single, 16777216.0),
                         element(ElementType::single, 16777214.0)));
  EXPECT_TRUE(
      is_nearly(element(ElementType::single, 0.10000001), element(ElementType::single, 0.1)));
}

TEST(Explanation, WholeNumbersAndTextsMayNot) {
  EXPECT_FALSE(is_nearly(element(ElementType::int32, 1), element(ElementType::int32, 2)));
  EXPECT_FALSE(is_nearly(element(ElementType::string, "a"), element(ElementType::string, "b")));
  EXPECT_FALSE(is_nearly(element(ElementType::double_, 1.0), element(ElementType::single, 1.0)));
  EXPECT_FALSE(is_nearly(Json::parse(R"({"type": 1})"), element(ElementType::double_, 1.0)));
}

}  // namespace
}  // namespace rr::conformance
