// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "runtime/cpp/src/dynamic/testing.hpp"

namespace rr::dynamic {
namespace {

using ::testing::ElementsAre;
using testing::error_text;
using ::testing::HasSubstr;
using testing::refusal;
using testing::types;

std::vector<std::string> texts_of(std::initializer_list<const char*> names) {
  std::vector<std::string> texts;
  for (const std::string name : names) {
    texts.push_back(testing::text_of_file(std::string(RR_DEFINITIONS_DIR) + "/experimental." +
                                          name + ".robdef"));
  }
  return texts;
}

TEST(Definitions, AreReadInAnyOrderWithTheirImports) {
  const Definitions definitions(texts_of({"members", "pods", "namedarrays"}));
  EXPECT_THAT(definitions.services(),
              ElementsAre("experimental.members", "experimental.namedarrays", "experimental.pods"));
  const auto members = definitions.members("experimental.members.Sensor");
  ASSERT_EQ(members.size(), 5U);
  EXPECT_EQ(members[0].name, "frames");
  EXPECT_EQ(members[0].kind, MemberKind::pipe);
  EXPECT_EQ(members[0].access, readonly);
  EXPECT_EQ(members[0].declaration, "pipe Frame frames [readonly]");
  EXPECT_EQ(members[0].documentation, "Each picture when it is taken.");
  EXPECT_EQ(members[0].type.text(), "experimental.members.Frame");
  EXPECT_EQ(members[2].type.text(), "double[3]");
  EXPECT_EQ(members[4].generator, GeneratorForm::returns);
  EXPECT_EQ(members[4].parameters.at(0).name, "limit");
  EXPECT_THAT(definitions.outline("experimental.pods"), HasSubstr("Recorder"));
  EXPECT_THAT(definitions.documentation("experimental.members.Station"),
              HasSubstr("members of two others"));
}

TEST(Definitions, WithMistakesAreRefusedWithThePlace) {
  EXPECT_EQ(error_text([] {
              Definitions({"service a.b\nstruct S\n  field Nothing x\nend\n"});
            }).substr(0, 36),
            "28: definition 1(3,9): error: R0203 ");
  EXPECT_THAT(error_text([] { Definitions({"service a.b\nimport c.d\n"}); }), HasSubstr("c.d"));
}

TEST(Definitions, RecordsLargerThanAnyMessageAreRefused) {
  EXPECT_EQ(error_text([] {
              Definitions({"service a.b\nstdver 0.10\npod P\n  field double[1000000000] x\nend\n"});
            }),
            "28: `a.b.P` is larger than any message");
}

TEST(Types, AreFoundByTheirTexts) {
  for (const char* const text :
       {"double", "uint8[]", "double[3]", "double[3-]", "single[*]", "int32[2,3]", "string",
        "string{list}", "bool{int32}", "varvalue", "varvalue{string}", "conformance.types.Vector3",
        "conformance.types.Sample[4]{list}", "conformance.types.Mode{string}"}) {
    EXPECT_EQ(types().type(text).text(), text);
  }
  EXPECT_EQ(types().type(" double [ 3 ] ").text(), "double[3]");
  for (const char* const text : {"", "doubl", "double[", "double[x]", "double{set}", "string[]",
                                 "conformance.types.Stats[]", "Vector3", "double[3]{list}x"}) {
    EXPECT_EQ(error_text([&] { (void)types().type(text); }).substr(0, 12), "18: no type:") << text;
  }
  EXPECT_EQ(ValueType::parse("double[]").item().text(), "double");
}

TEST(Types, TellWhatTheyConsistOf) {
  const ValueType type = types().type("conformance.types.Twist[*]{list}");
  EXPECT_EQ(type.kind(), Kind::list);
  EXPECT_EQ(type.item().kind(), Kind::array);
  EXPECT_TRUE(type.item().has_dims());
  EXPECT_EQ(type.item().name(), "conformance.types.Twist");
  const auto fields = type.item().item().fields();
  ASSERT_EQ(fields.size(), 2U);
  EXPECT_EQ(fields[1].name, "linear");
  EXPECT_EQ(fields[1].type.text(), "single[3]");
  EXPECT_EQ(types().type("conformance.types.Mode").enum_values().at(1).first, "manual");
  EXPECT_EQ(ValueType().text(), "void");
}

TEST(Types, AndValuesOutliveTheirDefinitions) {
  Value value;
  ValueType type;
  {
    const Definitions definitions({"service a.b\nstdver 0.10\npod P\n  field int32 x\nend\n"});
    type = definitions.type("a.b.P");
    value = definitions.type("a.b.P[]").from_json(R"([{"x":4}])");
  }
  EXPECT_EQ(value.at(0)["x"].as<int>(), 4);
  EXPECT_EQ(type.convert(StringMap{{"x", 5}})["x"].as<int>(), 5);
}

TEST(Definitions, TellTheirConstants) {
  const Definitions definitions(texts_of({"constants"}));
  const Fields constants = definitions.constants("experimental.constants");
  ASSERT_EQ(constants.size(), 14U);
  EXPECT_EQ(constants[0].first, "LOWEST");
  EXPECT_EQ(constants[0].second.type_text(), "int8");
  EXPECT_EQ(constants[0].second.as<int>(), -128);
  EXPECT_EQ(constants[5].second.as<std::uint64_t>(), 18446744073709551615U);
  EXPECT_THAT(constants[9].second.array<double>(), ElementsAre(0.25, -0.5, 1e-3));
  EXPECT_EQ(constants[11].second.size(), 0U);
  EXPECT_EQ(constants[13].first, "LIMITS");
  EXPECT_EQ(constants[13].second["trim"].as<int>(), -100);
  EXPECT_EQ(definitions.constants("experimental.constants.Machine").at(1).second.text(), "machine");
  EXPECT_THAT(definitions.declared("experimental.constants").objects,
              ElementsAre("experimental.constants.Machine"));
  EXPECT_EQ(error_text([&] { (void)definitions.constants("experimental.none"); }).substr(0, 3),
            "30:");
}

TEST(Definitions, MakeNamedarraysOfNumbersWithOneDimensionMore) {
  const ValueType points = types().type("conformance.types.Vector3[]");
  const Array<double> flat{1, 2, 3, 4, 5, 6};
  const Value two = points.convert(MultiArray<double>{{3, 2}, flat});
  EXPECT_EQ(two.size(), 2U);
  EXPECT_EQ(two.at(1)["x"].as<double>(), 4);
  EXPECT_EQ(two.array<double>().data(), flat.data());  // not copied
  const Value grid =
      types()
          .type("conformance.types.Vector3[*]")
          .convert(MultiArray<std::int32_t>{{3, 1, 2}, Array<std::int32_t>{1, 2, 3, 4, 5, 6}});
  EXPECT_THAT(grid.dims(), ElementsAre(1, 2));
  EXPECT_EQ(grid.at(1)["z"].as<double>(), 6);
  EXPECT_EQ(refusal("conformance.types.Vector3[]", MultiArray<double>{{2, 3}, flat}),
            "11: member pose: expected conformance.types.Vector3[], got double[*]");
}

TEST(Json, ThatDoesNotFitIsRefused) {
  EXPECT_EQ(
      error_text([] { (void)types().type("double").from_json("[1", "member pan"); }).substr(0, 12),
      "18: no JSON:");
  EXPECT_EQ(error_text([] { (void)types().type("double").from_json("\"1x\"", "member pan"); }),
            "11: member pan: expected double, got string");
  EXPECT_EQ(error_text([] { (void)types().type("double{int32}").from_json(R"({"a":1})", "m"); }),
            "11: m, item [\"a\"]: expected a key of type int32");
  EXPECT_EQ(error_text([] {
              (void)types().type("varvalue").from_json(R"({"type":"x.Y","value":1})", "m");
            }),
            "11: m: no type: `x.Y`");
  const std::string deep = std::string(100, '[') + std::string(100, ']');
  EXPECT_EQ(error_text([&] { (void)types().type("varvalue").from_json(deep); }),
            "18: the JSON is too deep");
}

// Whoever sends an array says how many dimensions it has.
TEST(Json, OfArraysWithManyDimensionsIsNotNested) {
  const ValueType type = types().type("double[*]");
  const auto json_of = [&](std::size_t dims) {
    const MultiArray<double> array{std::vector<std::uint32_t>(dims, 1), Array<double>{2.5}};
    const std::string json = type.to_json(Value(array));
    EXPECT_EQ(type.from_json(json).dims().size(), dims);
    EXPECT_EQ(type.to_json(type.from_json(json)), json);
    return json;
  };
  EXPECT_EQ(json_of(32), std::string(32, '[') + "2.5" + std::string(32, ']'));
  EXPECT_EQ(json_of(33).substr(0, 26), R"({"array":[2.5],"dims":[1,1)");
  json_of(200'000);
}

TEST(Json, KeepsTheSignOfZero) {
  const ValueType type = types().type("double[]");
  const std::string json = type.to_json(Value(Array<double>{0.0, -0.0}));
  EXPECT_EQ(json, "[0,-0.0]");
  EXPECT_EQ(type.to_json(type.from_json(json)), json);
}

TEST(Json, TakesNumbersAsTextsToo) {
  EXPECT_EQ(types().type("int64").from_json("\"-9007199254740993\"").as<std::int64_t>(),
            -9007199254740993);
  EXPECT_EQ(types().type("uint64").from_json("\"18446744073709551615\"").as<std::uint64_t>(),
            18446744073709551615U);
}

TEST(Json, IsWrittenWithoutATypeToo) {
  EXPECT_EQ(Value(List{1, "a", Value(), true}).to_json(), R"([1,"a",null,true])");
  EXPECT_EQ(Value::record({{"b", 1}, {"a", Array<double>{0.5}}}).to_json(), R"({"b":1,"a":[0.5]})");
  EXPECT_EQ(Value::from_json("{\"a\":[1]}").at("a").at(0).as<int>(), 1);
  EXPECT_EQ(Value("\xff").to_json(), "\"\xef\xbf\xbd\"");
}

}  // namespace
}  // namespace rr::dynamic
