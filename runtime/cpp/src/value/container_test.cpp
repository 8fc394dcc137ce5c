// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "runtime/cpp/src/value/conformance_types.hpp"
#include "runtime/cpp/src/value/testing.hpp"

// Lists and maps (03, sections 3, 7, 11, 12).
namespace rr::testing_values {
namespace {

using conformance::types::Mode;
using conformance::types::Sample;
using conformance::types::Stats;
using conformance::types::Vector3;

template <class T>
using List = std::optional<std::vector<T>>;
template <class T>
using IntMap = std::optional<std::map<std::int32_t, T>>;
template <class T>
using StringMap = std::optional<std::map<std::string, T>>;

// Containers that are not null.
template <class T>
List<T> list(std::vector<T> items) {
  return items;
}
template <class T>
IntMap<T> int_map(std::map<std::int32_t, T> items) {
  return items;
}
template <class T>
StringMap<T> string_map(std::map<std::string, T> items) {
  return items;
}

ElementTree container(ElementType type, Elements items) {
  return nested("value", type, "", std::move(items));
}
ElementTree item(std::int32_t number, double value) {
  return numbered(number, numbers_of<double>("", {value}));
}
ElementTree item(std::string_view name, double value) { return numbers_of<double>(name, {value}); }

TEST(Container, HasTheBytesOfTheStandard) {
  const StringMap<std::int32_t> map(std::map<std::string, std::int32_t>{{"", 1}});
  EXPECT_EQ(encode(map),
            from_hex("15 01 05 76 61 6c 75 65 67 00 01 0a 01 00 07 00 01 01 00 00 00"));
}

TEST(Container, NullEmptyAndFilledAreThreeValues) {
  EXPECT_TRUE(survives(List<double>()));
  EXPECT_TRUE(survives(list<double>({})));
  EXPECT_TRUE(survives(list<double>({1, 2})));
  EXPECT_TRUE(survives(IntMap<double>()));
  EXPECT_TRUE(survives(int_map<double>({})));
  EXPECT_TRUE(survives(int_map<double>({{-3, 1}, {200, 2}, {70000, 3}})));
  EXPECT_TRUE(survives(StringMap<double>()));
  EXPECT_TRUE(survives(string_map<double>({{"", 1}, {"a b", 2}})));
}

TEST(Container, HoldsEveryType) {
  const Stats stats{1, 2, "x"};
  EXPECT_TRUE(survives(list<bool>({true, false, true})));
  EXPECT_TRUE(survives(list<Mode>({Mode::remote, Mode::idle})));
  EXPECT_TRUE(survives(list<std::string>({"a", ""})));
  EXPECT_TRUE(survives(list<Array<std::int32_t>>({{1, 2}, {}})));
  EXPECT_TRUE(survives(list<std::array<double, 2>>({{1, 2}})));
  EXPECT_TRUE(survives(list<MultiArray<double>>({{{1, 2}, {3, 4}}})));
  EXPECT_TRUE(survives(list<std::optional<Stats>>({stats, std::nullopt})));
  EXPECT_TRUE(survives(list<Sample>({Sample{1, 2, {}}})));
  EXPECT_TRUE(survives(list<Vector3>({Vector3{1, 2, 3}})));
  EXPECT_TRUE(survives(int_map<bool>({{1, true}})));
  EXPECT_TRUE(survives(int_map<std::optional<Stats>>({{1, stats}, {2, std::nullopt}})));
  EXPECT_TRUE(survives(string_map<Array<Sample>>({{"k", {Sample{}}}})));
}

TEST(List, ItemsComeInOrder) {
  EXPECT_EQ(error_of<List<double>>(container(ElementType::list, {item(0, 1), item(1, 2)})),
            ErrorCode::none);
  EXPECT_EQ(error_of<List<double>>(container(ElementType::list, {item("0", 1), item("1", 2)})),
            ErrorCode::none);
  for (const Elements& items :
       {Elements{item(1, 1), item(0, 2)}, Elements{item(0, 1), item(2, 2)}, Elements{item("x", 1)},
        Elements{item("", 1)}, Elements{item(-1, 1)}}) {
    EXPECT_EQ(error_of<List<double>>(container(ElementType::list, items)),
              ErrorCode::data_type_error);
  }
  EXPECT_EQ(error_of<List<bool>>(
                container(ElementType::list, {numbered(1, numbers_of<bool>("", {true}))})),
            ErrorCode::data_type_error);
}

TEST(List, ItemsHaveTheirType) {
  EXPECT_EQ(error_of<List<double>>(container(ElementType::list, {numbered(0, text_of("", "x"))})),
            ErrorCode::data_type_mismatch);
  EXPECT_EQ((error_of<List<std::array<double, 2>>>(container(ElementType::list, {item(0, 1)}))),
            ErrorCode::data_type_error);
  EXPECT_EQ((error_of<List<std::array<double, 2>>>(
                container(ElementType::list, {numbered(0, null_of(""))}))),
            ErrorCode::null_value);
}

TEST(Container, AnotherOneIsAMismatch) {
  const ElementTree list = container(ElementType::list, {});
  EXPECT_EQ(error_of<IntMap<double>>(list), ErrorCode::data_type_mismatch);
  EXPECT_EQ(error_of<StringMap<double>>(list), ErrorCode::data_type_mismatch);
  EXPECT_EQ(error_of<List<double>>(container(ElementType::vector, {})),
            ErrorCode::data_type_mismatch);
}

TEST(IntMap, TakesNumbersAndDecimalNames) {
  const IntMap<double> expected = int_map<double>({{-7, 1}, {5, 2}});
  EXPECT_EQ(value_of<IntMap<double>>(container(ElementType::vector, {item(5, 2), item(-7, 1)})),
            expected);
  EXPECT_EQ(value_of<IntMap<double>>(container(ElementType::vector, {item("5", 2), item("-7", 1)})),
            expected);
}

TEST(IntMap, RefusesOtherKeys) {
  for (const std::string_view key : {"x", "99999999999", "", "1.5"}) {
    EXPECT_EQ(error_of<IntMap<double>>(container(ElementType::vector, {item(key, 1)})),
              ErrorCode::data_type_error)
        << key;
  }
}

TEST(StringMap, RefusesNumbers) {
  EXPECT_EQ(error_of<StringMap<double>>(container(ElementType::dictionary, {item(3, 1)})),
            ErrorCode::data_type_error);
}

TEST(Map, KeepsTheFirstOfTwoItemsOfAKey) {
  EXPECT_EQ(value_of<IntMap<double>>(container(ElementType::vector, {item(5, 1), item(5, 2)})),
            int_map<double>({{5, 1}}));
  EXPECT_EQ(value_of<StringMap<double>>(
                container(ElementType::dictionary, {item("b", 1), item("a", 3), item("b", 2)})),
            string_map<double>({{"a", 3}, {"b", 1}}));
}

TEST(Map, IsWrittenInAscendingOrder) {
  ElementTree tree;
  const StringMap<double> map = string_map<double>({{"b", 1}, {"a", 2}, {"", 3}});
  ASSERT_TRUE(read_element_tree(encode(map), MessageVersion::v4, tree));
  ASSERT_EQ(tree.elements.size(), 3);
  EXPECT_EQ(tree.elements[0].name, "");
  EXPECT_EQ(tree.elements[1].name, "a");
  EXPECT_EQ(tree.elements[2].name, "b");
}

TEST(Container, ReadingReplacesAnOldValue) {
  StringMap<double> map = string_map<double>({{"old", 1}});
  decode(encode(string_map<double>({{"new", 2}})), map);
  EXPECT_EQ(map, string_map<double>({{"new", 2}}));
  List<double> values = list<double>({1, 2, 3});
  decode(encode(list<double>({4})), values);
  EXPECT_EQ(values, list<double>({4}));
}

TEST(Container, MemoryIsBounded) {
  Decoder decoder(MessageVersion::v4);
  EXPECT_TRUE(decoder.reserve(Decoder::container_limit - 1, "a"));
  EXPECT_TRUE(decoder.reserve(1, "b"));
  EXPECT_FALSE(decoder.reserve(1, "c"));
  EXPECT_EQ(decoder.code(), ErrorCode::out_of_system_resource);
}

}  // namespace
}  // namespace rr::testing_values
