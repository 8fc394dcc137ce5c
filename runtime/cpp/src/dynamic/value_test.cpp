// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "rr/reader.hpp"
#include "rr/writer.hpp"
#include "runtime/cpp/src/dynamic/definition_tables.hpp"
#include "runtime/cpp/src/dynamic/testing.hpp"

namespace rr::dynamic {
namespace {

using ::testing::ElementsAre;
using testing::error_text;
using testing::refusal;
using testing::types;

// Written by its type and read again, in both formats.
Value travelled(const ValueType& type, const Value& value) {
  Value result;
  for (const MessageVersion version : {MessageVersion::v2, MessageVersion::v4}) {
    Writer writer;
    writer.reset(version);
    type.node()->write(writer, "value", &value);
    EXPECT_FALSE(writer.failed()) << type.text() << ": " << writer.message();
    const std::vector<std::byte> bytes = writer.copy();
    Decoder decoder(version, nullptr, {}, &types().tables()->registry());
    ElementReader reader(decoder, bytes, 1);
    Element element;
    EXPECT_TRUE(reader.next(element) && type.node()->read(decoder, element, &result))
        << type.text() << ": " << decoder.message();
  }
  return result;
}

// From JSON to the type, over the wire, and to JSON again.
std::string round_trip(const std::string& type_text, const std::string& json) {
  const ValueType type = types().type(type_text);
  const Value value = type.from_json(json);
  const Value received = travelled(type, value);
  EXPECT_TRUE(received == value) << type_text << " " << json << " became "
                                 << type.to_json(received);
  EXPECT_EQ(type.to_json(value), type.to_json(received));
  return type.to_json(received);
}

void expect_round_trip(const std::string& type, const std::string& json) {
  EXPECT_EQ(round_trip(type, json), json) << type;
}

TEST(DynamicValue, NumbersOfEveryTypeTravel) {
  expect_round_trip("double", "-1.5");
  expect_round_trip("single", "0.1");
  expect_round_trip("int8", "-128");
  expect_round_trip("uint8", "255");
  expect_round_trip("int16", "-32768");
  expect_round_trip("uint16", "65535");
  expect_round_trip("int32", "-2147483648");
  expect_round_trip("uint32", "4294967295");
  expect_round_trip("int64", "-9223372036854775808");
  expect_round_trip("uint64", "18446744073709551615");
  expect_round_trip("bool", "true");
  expect_round_trip("cdouble", "[1.5,-2]");
  expect_round_trip("csingle", "[0.1,0.2]");
  expect_round_trip("double", "\"NaN\"");
  expect_round_trip("single", "\"-Infinity\"");
  expect_round_trip("cdouble", "[\"Infinity\",\"NaN\"]");
}

TEST(DynamicValue, ArraysOfEveryFormTravel) {
  for (const char* const type : {"double", "single", "int8", "uint8", "int16", "uint16", "int32",
                                 "uint32", "int64", "uint64"}) {
    const std::string number = type;
    expect_round_trip(number + "[]", "[1,2,3]");
    expect_round_trip(number + "[]", "[]");
    expect_round_trip(number + "[3]", "[1,2,3]");
    expect_round_trip(number + "[3-]", "[1,2]");
    expect_round_trip(number + "[*]", "[[1,2,3],[4,5,6]]");
    expect_round_trip(number + "[2,3]", "[[1,2,3],[4,5,6]]");
  }
  expect_round_trip("bool[*]", "[[true,false]]");
  expect_round_trip("cdouble[]", "[[1,2],[3,4]]");
  expect_round_trip("csingle[*]", "[[[1,2],[3,4]],[[5,6],[7,8]]]");
  expect_round_trip("cdouble[2,1]", "[[[1,2]],[[3,4]]]");
  expect_round_trip("double[*]", "[[[1,2]],[[3,4]]]");
  expect_round_trip("double[*]", R"({"array":[],"dims":[0,3]})");
  expect_round_trip("double[*]", R"({"array":[],"dims":[4294967295,4294967295,4294967295,0]})");
}

TEST(DynamicValue, TheFirstIndexIsTheOuterList) {
  const Value matrix = types().type("double[*]").from_json("[[1,2,3],[4,5,6]]");
  EXPECT_THAT(matrix.dims(), ElementsAre(2, 3));
  EXPECT_THAT(matrix.array<double>(), ElementsAre(1, 4, 2, 5, 3, 6));
  EXPECT_EQ(matrix, Value(MultiArray<double>{{2, 3}, {1, 4, 2, 5, 3, 6}}));
}

TEST(DynamicValue, TextsEnumsAndContainersTravel) {
  expect_round_trip("string", R"("a \" b")");
  expect_round_trip("conformance.types.Mode", "\"automatic\"");
  expect_round_trip("conformance.types.Mode", "77");
  EXPECT_EQ(round_trip("conformance.types.Mode", "10"), "\"manual\"");
  expect_round_trip("double{list}", "[1,2.5]");
  expect_round_trip("double{list}", "[]");
  expect_round_trip("double{list}", "null");
  expect_round_trip("string{int32}", R"({"-3":"a","200":"b"})");
  expect_round_trip("int32[]{string}", R"({"":[],"x":[1,2]})");
  expect_round_trip("bool{string}", "{}");
  expect_round_trip("conformance.types.Mode{list}", R"(["idle","faulted"])");
}

TEST(DynamicValue, RecordsTravel) {
  const std::string stats = R"({"count":3,"mean":0.5,"label":"x"})";
  expect_round_trip("conformance.types.Stats", stats);
  expect_round_trip("conformance.types.Stats", "null");
  expect_round_trip("conformance.types.Stats{list}", "[" + stats + ",null]");
  const std::string sample = R"({"seq":1,"stamp":0.25,"accel":[1.5,-1,0]})";
  expect_round_trip("conformance.types.Sample", sample);
  expect_round_trip("conformance.types.Sample[]", "[" + sample + "," + sample + "]");
  expect_round_trip("conformance.types.Sample[2-]", "[" + sample + "]");
  expect_round_trip("conformance.types.Sample[*]", "[[" + sample + "],[" + sample + "]]");
  expect_round_trip("conformance.types.Sample[1,2]", "[[" + sample + "," + sample + "]]");
  expect_round_trip("conformance.types.Sample{int32}", R"({"4":)" + sample + "}");
  const std::string vector = R"({"x":1,"y":2,"z":3})";
  expect_round_trip("conformance.types.Vector3", vector);
  expect_round_trip("conformance.types.Vector3[]", "[" + vector + "]");
  expect_round_trip("conformance.types.Vector3[*]", "[[" + vector + "]]");
  expect_round_trip("conformance.types.Vector3{list}", "[" + vector + "]");
  expect_round_trip("conformance.types.Knots",
                    R"({"inner":[)" + vector + "," + vector + R"(],"last":)" + vector + "}");
  expect_round_trip("conformance.types.Twist", R"({"angular":[1,2,3],"linear":[4,5,6]})");
}

TEST(DynamicValue, APodWithEveryKindOfFieldTravels) {
  const std::string sample = R"({"seq":1,"stamp":0.25,"accel":[1.5,-1,0]})";
  const std::string vector = R"({"x":1,"y":2,"z":3})";
  const std::string pixel = R"({"red":1,"green":2,"blue":255})";
  expect_round_trip("conformance.types.Reading",
                    R"({"kind":-1,"valid":1,"payload":[7,8],"gain":[[1,2],[3,4]],"head":)" +
                        sample + R"(,"pair":[)" + sample + "," + sample + R"(],"tail":[)" + sample +
                        R"(],"origin":)" + vector + R"(,"base":[)" + vector + "," + vector +
                        R"(],"path":[],"block":[[)" + pixel + "," + pixel + "],[" + pixel + "," +
                        pixel + "]]}");
}

TEST(DynamicValue, VarvaluesKeepTheTypeOfWhatTheyHold) {
  expect_round_trip("varvalue", "null");
  expect_round_trip("varvalue", "\"text\"");
  expect_round_trip("varvalue", R"({"type":"double[]","value":[3]})");
  expect_round_trip("varvalue", R"({"type":"int32[*]","value":[[1],[2]]})");
  expect_round_trip("varvalue", R"([null,"a",{"type":"uint8[]","value":[1]},[]])");
  expect_round_trip("varvalue", R"({"a":"b","c":null})");
  expect_round_trip("varvalue", R"({"type":"varvalue{int32}","value":{"3":"x"}})");
  expect_round_trip(
      "varvalue",
      R"({"type":"conformance.types.Stats","value":{"count":3,"mean":0.5,"label":""}})");
  expect_round_trip(
      "varvalue{string}",
      R"({"p":{"type":"conformance.types.Vector3[]","value":[{"x":1,"y":2,"z":3}]}})");
  // What JSON leaves open; a number is an array of one when it has travelled.
  const Value sent = types().type("varvalue").from_json("[1,2.5,true,5000000000]");
  EXPECT_EQ(travelled(types().type("varvalue"), sent).to_json(), "[[1],[2.5],[true],[5000000000]]");
  EXPECT_EQ(sent.at(0).type_text(), "int32");
  EXPECT_EQ(sent.at(3).type_text(), "int64");
}

TEST(DynamicValue, PlainValuesBecomeWhatIsDeclared) {
  const ValueType stats = types().type("conformance.types.Stats");
  const Value value = stats.convert(Value::record({{"label", "a"}, {"count", 2.0}, {"mean", 3}}));
  EXPECT_EQ(value["count"].as<int>(), 2);
  EXPECT_EQ(value["mean"].type_text(), "double");
  EXPECT_EQ(value.fields()[0].first, "count");  // in the order of the definition
  EXPECT_EQ(stats.convert(StringMap{{"label", "a"}, {"count", 2}, {"mean", 3.0}}), value);
  const ValueType vector = types().type("conformance.types.Vector3");
  EXPECT_EQ(vector.convert(List{1, 2, 3})["z"].as<double>(), 3);
  EXPECT_EQ(vector.convert(Array<float>{1, 2, 3})["y"].as<double>(), 2);
  EXPECT_THAT(types().type("uint8[]").convert(List{1, 2.0}).array<std::uint8_t>(),
              ElementsAre(1, 2));
  EXPECT_THAT(types().type("double[2]").convert(Array<std::int16_t>{1, 2}).array<double>(),
              ElementsAre(1, 2));
  EXPECT_EQ(types().type("conformance.types.Mode").convert("remote").as<int>(), 0x20);
  EXPECT_EQ(types().type("double{list}").convert(Array<int>{1, 2}).list().size(), 2U);
}

TEST(DynamicValue, WhatDoesNotFitIsRefusedByPlaceAndType) {
  EXPECT_EQ(refusal("double", "x"), "11: member pose: expected double, got string");
  EXPECT_EQ(refusal("int8", 128), "11: member pose: expected int8, which cannot hold 128");
  EXPECT_EQ(refusal("uint32", -1), "11: member pose: expected uint32, which cannot hold -1");
  EXPECT_EQ(refusal("int32", 1.5), "11: member pose: expected int32, which cannot hold 1.5");
  EXPECT_EQ(refusal("bool", 1), "11: member pose: expected bool, got int32");
  EXPECT_EQ(refusal("int32", true), "11: member pose: expected int32, got bool");
  EXPECT_EQ(refusal("double", std::int64_t{9007199254740993}),
            "11: member pose: expected double, which cannot hold 9007199254740993");
  EXPECT_EQ(refusal("string", 1), "11: member pose: expected string, got int32");
  EXPECT_EQ(refusal("string", Value()), "11: member pose: expected string, got null");
  EXPECT_EQ(refusal("double[3]", List{1, 2}), "11: member pose: expected double[3], got 2 items");
  EXPECT_EQ(refusal("double[1-]", List{1, 2}), "11: member pose: expected double[1-], got 2 items");
  EXPECT_EQ(refusal("double[]", List{1, 2, "x"}),
            "11: member pose, item [2]: expected double, got string");
  EXPECT_EQ(refusal("double[2,2]", MultiArray<double>{{1, 4}, Array<double>(4)}),
            "11: member pose: expected double[2,2], got 1x4");
  EXPECT_EQ(refusal("double[*]", List{List{1, 2}, List{1}}),
            "11: member pose, item [1]: expected a list of 2 items, got 1 item");
  EXPECT_EQ(refusal("conformance.types.Mode", "no"),
            "11: member pose: expected conformance.types.Mode (idle, manual, automatic, remote, "
            "faulted), got \"no\"");
  EXPECT_EQ(refusal("conformance.types.Stats", StringMap{{"count", 1}, {"mean", 1}}),
            "11: member pose, field label: missing, expected string");
  EXPECT_EQ(refusal("conformance.types.Stats", StringMap{{"counts", 1}}),
            "11: member pose: `conformance.types.Stats` has no field `counts`");
  EXPECT_EQ(refusal("conformance.types.Twist",
                    Value::record({{"angular", List{1, 2, "x"}}, {"linear", List{1, 2, 3}}})),
            "11: member pose, field angular[2]: expected single, got string");
  EXPECT_EQ(refusal("conformance.types.Vector3", List{1, 2}),
            "11: member pose: expected conformance.types.Vector3, which has 3 numbers, got 2");
  EXPECT_EQ(refusal("conformance.types.Vector3", Value()),
            "11: member pose: expected conformance.types.Vector3, got null");
  EXPECT_EQ(refusal("double{string}", StringMap{{"a", "b"}}),
            "11: member pose, item [\"a\"]: expected double, got string");
  EXPECT_EQ(refusal("double{int32}", StringMap{{"a", 1}}),
            "11: member pose: expected double{int32}, got map");
  EXPECT_EQ(refusal("double", "x", ""), "11: expected double, got string");
}

TEST(DynamicValue, AccessorsNameWhatTheyWant) {
  EXPECT_EQ(error_text([] { (void)Value("x").as<double>(); }), "11: expected double, got string");
  EXPECT_EQ(error_text([] { (void)Value(300).as<std::uint8_t>(); }), "11: uint8 cannot hold 300");
  EXPECT_EQ(error_text([] { (void)Value(1).text(); }), "11: expected string, got int32");
  EXPECT_EQ(error_text([] { (void)Value(List{1}).at(1); }), "29: no item 1 of 1");
  EXPECT_EQ(error_text([] { (void)Value(StringMap{}).at("a"); }), "30: no item `a`");
  EXPECT_EQ(error_text([] { (void)Value::record({}).at("a"); }), "30: `fields` has no field `a`");
  EXPECT_EQ(error_text([] { (void)Value(Array<double>{1}).array<int>(); }),
            "11: expected int32[], got double[]");
  EXPECT_EQ(error_text([] { (void)Value(1).list(); }), "11: expected a list, got int32");
  EXPECT_EQ(error_text([] {
              Value(MultiArray<double>{{2}, {1}});
            }),
            "18: dims do not fit the items");
}

TEST(DynamicValue, NumbersAreReadAsWhatIsWanted) {
  EXPECT_EQ(Value(3).as<double>(), 3.0);
  EXPECT_EQ(Value(Array<std::int16_t>{7}).as<long long>(), 7);
  EXPECT_EQ(Value(std::complex<double>(1, 0)).as<float>(), 1.0F);
  EXPECT_EQ(Value(true).as<bool>(), true);
  EXPECT_EQ(types().type("conformance.types.Mode").convert(10).text(), "manual");
}

TEST(DynamicValue, NamedarraysAreNumbersToo) {
  const Value path = types().type("conformance.types.Vector3[]").from_json("[[1,2,3],[4,5,6]]");
  EXPECT_THAT(path.array<double>(), ElementsAre(1, 2, 3, 4, 5, 6));
  EXPECT_EQ(path.at(1)["y"].as<double>(), 5);
}

// A definition may be anybody's: such a record takes no room on the wire, but has a place in
// memory.
TEST(DynamicValue, PodsWithoutFieldsTravel) {
  const Definitions definitions(
      {"service a.b\nstdver 0.10\npod Nothing\nend\npod Outer\n"
       "  field Nothing one\n  field Nothing[3] three\nend\n"});
  const std::pair<const char*, const char*> cases[] = {
      {"a.b.Nothing", "{}"},
      {"a.b.Nothing[]", "[{},{}]"},
      {"a.b.Nothing[2]", "[{},{}]"},
      {"a.b.Nothing[*]", "[[{}],[{}]]"},
      {"a.b.Outer[]", R"([{"one":{},"three":[{},{},{}]}])"}};
  for (const auto& [text, json] : cases) {
    const ValueType type = definitions.type(text);
    const Value value = type.from_json(json);
    EXPECT_EQ(type.to_json(travelled(type, value)), type.to_json(value)) << text;
  }
  EXPECT_EQ(definitions.type("a.b.Nothing[]").from_json("[{},{}]").size(), 2U);
}

TEST(DynamicValue, HostileBytesAreRefused) {
  const ValueType type = types().type("conformance.types.Stats");
  Writer writer;
  writer.reset(MessageVersion::v4);
  writer.string_element("value", "text");
  const std::vector<std::byte> bytes = writer.copy();
  Decoder decoder(MessageVersion::v4);
  ElementReader reader(decoder, bytes, 1);
  Element element;
  ASSERT_TRUE(reader.next(element));
  Value value;
  EXPECT_FALSE(type.node()->read(decoder, element, &value));
  EXPECT_EQ(decoder.code(), ErrorCode::data_type_mismatch);
}

}  // namespace
}  // namespace rr::dynamic
