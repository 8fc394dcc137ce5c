// SPDX-License-Identifier: Apache-2.0
#include "rr/record.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "rr/time_spec.hpp"
#include "runtime/cpp/src/value/conformance_types.hpp"
#include "runtime/cpp/src/value/testing.hpp"

// Structs, pods and namedarrays (03, sections 6, 9, 10, 11).
namespace rr::testing_values {
namespace {

using namespace conformance::types;  // NOLINT: the types under test

constexpr std::string_view stats_name = "conformance.types.Stats";
constexpr std::string_view sample_name = "conformance.types.Sample";
constexpr std::string_view vector3_name = "conformance.types.Vector3";

Elements stats_fields() {
  return {numbers_of<std::int32_t>("count", {1}), numbers_of<double>("mean", {2.5}),
          text_of("label", "x")};
}
ElementTree stats(Elements fields, std::string_view type_name = stats_name) {
  return nested("value", ElementType::structure, type_name, std::move(fields));
}
const Stats expected_stats{1, 2.5, "x"};

TEST(Struct, IsReadInTheOrderOfItsDefinition) {
  EXPECT_EQ(value_of<Stats>(stats(stats_fields())), expected_stats);
}

TEST(Struct, IsReadInAnyOrder) {
  Elements fields = stats_fields();
  std::sort(fields.begin(), fields.end(),
            [](const ElementTree& a, const ElementTree& b) { return a.name < b.name; });
  do {
    EXPECT_EQ(value_of<Stats>(stats(fields)), expected_stats);
  } while (std::next_permutation(
      fields.begin(), fields.end(),
      [](const ElementTree& a, const ElementTree& b) { return a.name < b.name; }));
}

TEST(Struct, IgnoresUnknownFieldsAnywhere) {
  for (std::size_t at = 0; at <= 3; ++at) {
    Elements fields = stats_fields();
    fields.insert(fields.begin() + static_cast<std::ptrdiff_t>(at), text_of("unknown", "y"));
    EXPECT_EQ(value_of<Stats>(stats(fields)), expected_stats) << at;
  }
}

TEST(Struct, TakesTheFirstOfTwoFieldsOfAName) {
  for (std::size_t at = 1; at <= 3; ++at) {
    Elements fields = stats_fields();
    fields.insert(fields.begin() + static_cast<std::ptrdiff_t>(at),
                  numbers_of<std::int32_t>("count", {99}));
    EXPECT_EQ(value_of<Stats>(stats(fields)), expected_stats) << at;
  }
  Elements fields = stats_fields();
  fields.insert(fields.begin(), text_of("label", "first"));
  EXPECT_EQ(value_of<Stats>(stats(fields)).label, "first");
}

TEST(Struct, NeedsEveryField) {
  for (std::size_t at = 0; at < 3; ++at) {
    Elements fields = stats_fields();
    fields.erase(fields.begin() + static_cast<std::ptrdiff_t>(at));
    EXPECT_EQ(error_of<Stats>(stats(fields)), ErrorCode::message_element_not_found) << at;
  }
}

TEST(Struct, NeedsFieldsThatMayBeNullToo) {
  const ElementTree leaf = nested("value", ElementType::structure, "conformance.types.Leaf",
                                  {text_of("name", ""), numbers_of<std::int32_t>("mode", {0})});
  EXPECT_EQ(error_of<Leaf>(leaf), ErrorCode::message_element_not_found);
}

TEST(Struct, FieldsHaveTheirTypes) {
  Elements fields = stats_fields();
  fields[0] = numbers_of<double>("count", {1});
  EXPECT_EQ(error_of<Stats>(stats(fields)), ErrorCode::data_type_mismatch);
  fields[0] = numbers_of<std::int32_t>("count", {});
  EXPECT_EQ(error_of<Stats>(stats(fields)), ErrorCode::out_of_range);
  fields[0] = null_of("count");
  EXPECT_EQ(error_of<Stats>(stats(fields)), ErrorCode::null_value);
  fields = stats_fields();
  fields[2] = null_of("label");
  EXPECT_EQ(error_of<Stats>(stats(fields)), ErrorCode::data_type_error);
}

TEST(Struct, TakesTheFirstOfSeveralNumbersOfAField) {
  Elements fields = stats_fields();
  fields[0] = numbers_of<std::int32_t>("count", {1, 2, 3});
  EXPECT_EQ(value_of<Stats>(stats(fields)), expected_stats);
}

TEST(Struct, OfAnotherNameFailsAsTheReferenceDoes) {
  const TypeRegistry types(rr_definition);
  const auto error = [&](std::string_view type_name) {
    return error_of<Stats>(stats(stats_fields(), type_name), &types);
  };
  EXPECT_EQ(error("no.such.Type"), ErrorCode::service_error);
  EXPECT_EQ(error("conformance.types.NoSuch"), ErrorCode::service_error);
  EXPECT_EQ(error(sample_name), ErrorCode::service_error);
  EXPECT_EQ(error("Stats"), ErrorCode::invalid_argument);
  EXPECT_EQ(error(""), ErrorCode::invalid_argument);
  EXPECT_EQ(error("conformance.types.Leaf"), ErrorCode::message_element_not_found);
}

TEST(Struct, ThatIsAnotherOneInFullIsAMismatch) {
  const TypeRegistry types(rr_definition);
  const ElementTree leaf =
      nested("value", ElementType::structure, "conformance.types.Leaf",
             {text_of("name", ""), numbers_of<std::int32_t>("mode", {0}), null_of("stats")});
  EXPECT_EQ(error_of<Stats>(leaf, &types), ErrorCode::data_type_mismatch);
}

TEST(Struct, ThatMayNotBeNullRefusesNull) {
  EXPECT_EQ(error_of<Stats>(null_of("value")), ErrorCode::null_value);
  EXPECT_EQ(error_of<std::optional<Stats>>(null_of("value")), ErrorCode::none);
  EXPECT_EQ(error_of<std::optional<Stats>>(text_of("value", "x")), ErrorCode::data_type_mismatch);
}

TEST(Struct, NullAndValueSurvive) {
  EXPECT_TRUE(survives(std::optional<Stats>()));
  EXPECT_TRUE(survives(std::optional<Stats>(expected_stats)));
  EXPECT_TRUE(survives(Leaf{"leaf", Mode::manual, expected_stats}));
  EXPECT_TRUE(survives(TimeSpec{1700000000, 999999999}));
}

TEST(Struct, NullReplacesAnOldValue) {
  std::optional<Stats> value = expected_stats;
  decode(encode(std::optional<Stats>()), value);
  EXPECT_FALSE(value.has_value());
}

TEST(Struct, LongTextsAndArraysInItSurvive) {
  for (const std::size_t size :
       {0UL, 1UL, 7UL, 8UL, 15UL, 16UL, 17UL, 191UL, 192UL, 193UL, 252UL, 253UL, 70000UL}) {
    EXPECT_TRUE(survives(Stats{1, 2, std::string(size, 'x')})) << size;
  }
}

Tree chain(int depth) {
  Tree tree;
  tree.name = "end";
  for (int i = 1; i < depth; ++i) {
    Tree parent;
    parent.name = std::to_string(i);
    parent.child = std::move(tree);
    tree = std::move(parent);
  }
  return tree;
}

TEST(Struct, MayContainItself) {
  Tree tree = chain(3);
  tree.leaves.emplace();
  tree.leaves->emplace_back();
  tree.leaves->emplace_back(Leaf{"a", Mode::idle, std::nullopt});
  tree.by_name.emplace()["b"] = Leaf{"b", Mode::remote, expected_stats};
  EXPECT_TRUE(survives(tree));
}

TEST(Struct, NestingIsBounded) {
  EXPECT_TRUE(survives(chain(63)));
  EXPECT_EQ(sending_error_of(chain(64)), ErrorCode::protocol_error);
  const auto field = [](ElementTree child) {
    child.name = "child";
    return nested("value", ElementType::structure, "conformance.types.Tree",
                  {text_of("name", ""), null_of("main"), null_of("leaves"), null_of("by_name"),
                   std::move(child), null_of("extra")});
  };
  ElementTree tree = null_of("child");
  for (int depth = 1; depth <= 63; ++depth) tree = field(std::move(tree));
  EXPECT_EQ(error_of<Tree>(tree), ErrorCode::none);
  tree = field(std::move(tree));
  EXPECT_EQ(error_of<Tree>(tree), ErrorCode::protocol_error);
}

TEST(Recursive, BehavesLikeOptional) {
  Recursive<Tree> a;
  EXPECT_FALSE(a);
  EXPECT_THROW(static_cast<void>(a.value()), std::bad_optional_access);
  a.emplace().name = "a";
  Recursive<Tree> b = a;
  EXPECT_EQ(a, b);
  EXPECT_NE(&*a, &*b);
  b->name = "b";
  EXPECT_EQ(a->name, "a");
  EXPECT_NE(a, b);
  a = b;
  EXPECT_EQ(a.value().name, "b");
  a = *&a;
  EXPECT_EQ(a->name, "b");
  const Recursive<Tree> c = std::move(b);
  EXPECT_TRUE(c.has_value());
  a.reset();
  EXPECT_FALSE(a.has_value());
  EXPECT_NE(a, c);
  EXPECT_EQ(a, Recursive<Tree>());
  a = std::nullopt;
  EXPECT_EQ(a, Recursive<Tree>());
}

TEST(Recursive, TakesAPartOfItself) {
  Recursive<Tree> tree = chain(3);
  tree = tree->child;
  EXPECT_EQ(tree, Recursive<Tree>(chain(2)));
}

Elements sample_fields() {
  return {numbers_of<std::uint32_t>("seq", {1}), numbers_of<double>("stamp", {0.25}),
          numbers_of<float>("accel", {1.5, -1, 0})};
}
ElementTree sample_item(std::int32_t number, Elements fields) {
  return numbered(number, nested("", ElementType::pod, "", std::move(fields)));
}
ElementTree samples(Elements items, std::string_view type_name = sample_name) {
  return nested("value", ElementType::pod_array, type_name, std::move(items));
}
const Sample expected_sample{1, 0.25, {1.5, -1, 0}};

TEST(Pod, HasTheBytesOfTheStandard) {
  const std::string head =
      "09 05 76 61 6c 75 65 6e 00 18"
      "63 6f 6e 66 6f 72 6d 61 6e 63 65 2e 74 79 70 65 73 2e"
      "53 61 6d 70 6c 65";
  EXPECT_EQ(encode(Array<Sample>()), from_hex("24" + head + "00"));
  EXPECT_EQ(encode(expected_sample),
            from_hex("61" + head + "01 3d 04 00 6d 00 03" +
                     "0d 01 03 73 65 71 08 00 01 01 00 00 00"
                     "13 01 05 73 74 61 6d 70 01 00 01 00 00 00 00 00 00 d0 3f"
                     "17 01 05 61 63 63 65 6c 02 00 03 00 00 c0 3f 00 00 80 bf 00 00 00 00"));
}

TEST(Pod, SurvivesInEveryForm) {
  EXPECT_TRUE(survives(expected_sample));
  EXPECT_TRUE(survives(Array<Sample>{expected_sample, Sample{}}));
  EXPECT_TRUE(survives(std::array<Sample, 2>{expected_sample, Sample{}}));
  EXPECT_TRUE(survives(BoundedArray<Sample, 2>{expected_sample}));
  EXPECT_TRUE(survives(MultiArray<Sample>{{1, 2}, {expected_sample, Sample{}}}));
  EXPECT_TRUE(survives(FixedMultiArray<Sample, 1, 2>{{expected_sample, Sample{}}}));
  Reading reading;
  reading.payload = {1, 2, 3};
  reading.gain(1, 0) = 4;
  reading.head = expected_sample;
  reading.tail = {expected_sample};
  reading.path = {Vector3{1, 2, 3}};
  reading.block(0, 1).green = 7;
  EXPECT_TRUE(survives(reading));
}

TEST(Pod, FieldsComeInAnyOrder) {
  Elements fields = sample_fields();
  std::reverse(fields.begin(), fields.end());
  EXPECT_EQ(value_of<Sample>(samples({sample_item(0, fields)})), expected_sample);
}

TEST(Pod, NeedsEveryField) {
  Elements fields = sample_fields();
  fields.pop_back();
  EXPECT_EQ(error_of<Sample>(samples({sample_item(0, fields)})),
            ErrorCode::message_element_not_found);
}

TEST(Pod, ASingleOneIsExactlyOne) {
  EXPECT_EQ(error_of<Sample>(samples({})), ErrorCode::data_type_error);
  EXPECT_EQ(
      error_of<Sample>(samples({sample_item(0, sample_fields()), sample_item(1, sample_fields())})),
      ErrorCode::data_type_error);
}

TEST(Pod, ItemsAreNumberedInOrder) {
  EXPECT_EQ(error_of<Array<Sample>>(samples({sample_item(1, sample_fields())})),
            ErrorCode::data_type_error);
  ElementTree named = nested("0", ElementType::pod, "", sample_fields());
  EXPECT_EQ(error_of<Array<Sample>>(samples({named})), ErrorCode::none);
  named.name = "x";
  EXPECT_EQ(error_of<Array<Sample>>(samples({named})), ErrorCode::data_type_error);
}

TEST(Pod, OfAnotherTypeIsRefused) {
  EXPECT_EQ(error_of<Sample>(samples({sample_item(0, sample_fields())}, "conformance.types.Other")),
            ErrorCode::data_type_error);
  EXPECT_EQ(error_of<Sample>(nested("value", ElementType::structure, sample_name, sample_fields())),
            ErrorCode::data_type_mismatch);
  EXPECT_EQ(error_of<Sample>(nested("value", ElementType::pod, sample_name, sample_fields())),
            ErrorCode::data_type_mismatch);
  EXPECT_EQ(error_of<Array<Sample>>(
                samples({numbered(0, nested("", ElementType::structure, "", sample_fields()))})),
            ErrorCode::data_type_mismatch);
}

TEST(Pod, NullIsAnErrorOfItsOwn) {
  EXPECT_EQ(error_of<Sample>(null_of("value")), ErrorCode::null_value);
  EXPECT_EQ(error_of<Array<Sample>>(null_of("value")), ErrorCode::null_value);
  EXPECT_EQ(error_of<Array<Sample>>(samples({numbered(0, null_of(""))})), ErrorCode::null_value);
}

TEST(Pod, LengthsOfArraysInItAreChecked) {
  Elements fields = sample_fields();
  fields[2] = numbers_of<float>("accel", {1});
  EXPECT_EQ(error_of<Sample>(samples({sample_item(0, fields)})), ErrorCode::data_type_error);
  const ElementTree two =
      samples({sample_item(0, sample_fields()), sample_item(1, sample_fields())});
  EXPECT_EQ((error_of<std::array<Sample, 1>>(two)), ErrorCode::data_type_error);
  EXPECT_EQ((error_of<BoundedArray<Sample, 1>>(two)), ErrorCode::data_type_error);
}

TEST(Pod, MultidimensionalFieldsAreFlat) {
  Counter counter;
  counter.mask(1, 0) = 7;
  ElementTree tree;
  ASSERT_TRUE(read_element_tree(encode(counter), MessageVersion::v4, tree));
  const ElementTree& mask = tree.elements.at(0).elements.at(3);
  EXPECT_EQ(mask.type, ElementType::uint32);
  EXPECT_EQ(mask.count, 4);
}

ElementTree vectors(const Array<double>& numbers, std::string_view type_name = vector3_name) {
  return nested("value", ElementType::namedarray_array, type_name, {numbers_of("array", numbers)});
}

TEST(NamedArray, SurvivesInEveryForm) {
  const Vector3 vector{1, -2, 0.5};
  EXPECT_TRUE(survives(vector));
  EXPECT_TRUE(survives(Array<Vector3>{vector, Vector3{}}));
  EXPECT_TRUE(survives(Array<Vector3>{}));
  EXPECT_TRUE(survives(std::array<Vector3, 2>{vector, Vector3{}}));
  EXPECT_TRUE(survives(BoundedArray<Vector3, 2>{vector}));
  EXPECT_TRUE(survives(MultiArray<Vector3>{{1, 2}, {vector, Vector3{}}}));
  EXPECT_TRUE(survives(FixedMultiArray<Pixel, 1, 2>{{Pixel{1, 2, 3}, Pixel{4, 5, 6}}}));
  EXPECT_TRUE(survives(Knots{{vector, Vector3{}}, vector}));
}

TEST(NamedArray, NumbersAreItsFields) {
  Vector3 vector{1, 2, 3};
  vector.rr_numbers()[1] = 7;
  EXPECT_EQ(vector, (Vector3{1, 7, 3}));
  const Knots knots{{}, vector};
  EXPECT_EQ(numbers<double>(knots)[7], 7);
}

TEST(NamedArray, ASingleOneHasExactlyItsNumbers) {
  EXPECT_EQ(value_of<Vector3>(vectors({1, 2, 3})), (Vector3{1, 2, 3}));
  EXPECT_EQ(error_of<Vector3>(vectors({1, 2})), ErrorCode::data_type_error);
  EXPECT_EQ(error_of<Vector3>(vectors({1, 2, 3, 4, 5, 6})), ErrorCode::data_type_error);
  EXPECT_EQ(error_of<Vector3>(vectors({})), ErrorCode::data_type_error);
}

TEST(NamedArray, APartOfOneIsRefused) {
  EXPECT_EQ(error_of<Array<Vector3>>(vectors({1, 2, 3, 4})), ErrorCode::data_type_error);
}

TEST(NamedArray, OfAnotherTypeIsRefused) {
  EXPECT_EQ(error_of<Vector3>(vectors({1, 2, 3}, "conformance.types.Other")),
            ErrorCode::data_type_error);
  EXPECT_EQ(error_of<Vector3>(numbers_of<double>("value", {1, 2, 3})),
            ErrorCode::data_type_mismatch);
  EXPECT_EQ(error_of<Vector3>(nested("value", ElementType::namedarray_array, vector3_name,
                                     {numbers_of<float>("array", {1, 2, 3})})),
            ErrorCode::data_type_mismatch);
}

TEST(NamedArray, NeedsItsArray) {
  EXPECT_EQ(error_of<Vector3>(nested("value", ElementType::namedarray_array, vector3_name, {})),
            ErrorCode::message_element_not_found);
}

TEST(NamedArray, NullIsAnErrorOfItsOwn) {
  EXPECT_EQ(error_of<Vector3>(null_of("value")), ErrorCode::null_value);
  EXPECT_EQ(error_of<Array<Vector3>>(null_of("value")), ErrorCode::null_value);
}

TEST(NamedArray, DimsCountItems) {
  const auto grid = [](const Array<std::uint32_t>& dims, std::string_view type_name) {
    ElementTree array = vectors({1, 2, 3, 4, 5, 6});
    array.name = "array";
    return nested("value", ElementType::namedarray_multidimarray, type_name,
                  {numbers_of("dims", dims), array});
  };
  EXPECT_EQ(error_of<MultiArray<Vector3>>(grid({2}, vector3_name)), ErrorCode::none);
  EXPECT_EQ(error_of<MultiArray<Vector3>>(grid({6}, vector3_name)), ErrorCode::data_type_error);
  EXPECT_EQ(error_of<MultiArray<Vector3>>(grid({2}, "conformance.types.Other")),
            ErrorCode::data_type_error);
}

}  // namespace
}  // namespace rr::testing_values
