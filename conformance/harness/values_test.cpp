// SPDX-License-Identifier: Apache-2.0
#include "conformance/harness/values.hpp"

#include <gtest/gtest.h>

#include "conformance/harness/numbers.hpp"

namespace rr::conformance {
namespace {

Json json(const char* text) { return Json::parse(text); }

TEST(Values, AVarvalueOfOneNumberArrivesAsAnArray) {
  EXPECT_TRUE(
      same_value(json(R"({"type":"int32","value":5})"), json(R"({"type":"int32[]","value":[5]})")));
  EXPECT_FALSE(same_value(json(R"({"type":"int32","value":5})"),
                          json(R"({"type":"int32[]","value":[5,6]})")));
  EXPECT_FALSE(
      same_value(json(R"({"type":"int32","value":5})"), json(R"({"type":"int64[]","value":[5]})")));
}

TEST(Values, ATypedContainerInAVarvalueArrivesAsOneOfVarvalues) {
  EXPECT_TRUE(same_value(
      json(R"({"type":"int32{string}","value":[["a",1],["b",2]]})"),
      json(
          R"({"type":"varvalue{string}","value":[["b",{"type":"int32[]","value":[2]}],["a",{"type":"int32[]","value":[1]}]]})")));
}

TEST(Values, TheOrderOfAMapIsFreeThatOfAListIsNot) {
  EXPECT_TRUE(same_value(json(R"([["a",1.5],["b",2.5]])"), json(R"([["b",2.5],["a",1.5]])")));
  EXPECT_FALSE(same_value(json("[1,2]"), json("[2,1]")));
}

TEST(Values, ASingleIsTheSameAsTheDoubleItWidensTo) {
  EXPECT_TRUE(same_value(json("0.1"), json("0.10000000149011612")));
  EXPECT_TRUE(same_value(json("-2.5902094"), json("-2.5902095")));
  EXPECT_FALSE(same_value(json("0.1"), json("0.1000000001")));
}

TEST(Values, TheSignOfZeroCounts) {
  EXPECT_FALSE(same_value(json("0.0"), json("-0.0")));
  EXPECT_TRUE(same_value(json("-0.0"), json("-0.0")));
}

TEST(Values, NullAndEmptyAreDifferent) {
  EXPECT_FALSE(same_value(json("null"), json("[]")));
  EXPECT_FALSE(same_value(json(R"({"a":null})"), json("{}")));
}

TEST(Values, ThingsThatArriveHaveNoOrderButACount) {
  EXPECT_TRUE(same_things(json("[1,2,2]"), json("[2,1,2]")));
  EXPECT_FALSE(same_things(json("[1,2,2]"), json("[1,1,2]")));
}

TEST(Values, AnArrayRecordedWithoutItsDimsIsTheSame) {
  EXPECT_TRUE(same_value(json("[1,2]"), json(R"({"dims":[2,1],"array":[1,2]})")));
  EXPECT_FALSE(same_value(json("[1,3]"), json(R"({"dims":[2,1],"array":[1,2]})")));
  EXPECT_FALSE(same_value(json(R"({"dims":[2,1],"array":[1,2]})"), json("[1,2]")));
}

TEST(Numbers, EveryKindComesBackWithTheSameBits) {
  using rr::ElementType;
  const std::pair<ElementType, const char*> samples[] = {
      {ElementType::double_, R"([0.1,-0.0,"NaN","-Infinity","NaN:0x7ff8000000000001",5e-324])"},
      {ElementType::single, R"([0.1,16777216.0,1e-45,"NaN:0xffc00000"])"},
      {ElementType::int64, R"(["-9223372036854775808","5"])"},
      {ElementType::uint64, R"(["18446744073709551615"])"},
      {ElementType::bool_, "[true,false]"},
      {ElementType::csingle, R"([[0.1,"Infinity"],[1.0,2.0]])"},
  };
  for (const auto& [type, text] : samples) {
    const Json list = json(text);
    EXPECT_EQ(json_of_numbers(type, numbers_of_json(type, list)).dump(), list.dump());
  }
}

TEST(Numbers, ABoolByteThatIsNeitherIsNoNumber) {
  EXPECT_TRUE(json_of_numbers(rr::ElementType::bool_, bytes_of_hex("0102")).is_null());
}

TEST(Numbers, AnIntegerThatDoesNotFitIsRefused) {
  EXPECT_THROW(integer_of_json<std::int8_t>(Json(128)), std::runtime_error);
  EXPECT_THROW(integer_of_json<std::int8_t>(Json("x")), std::runtime_error);
  EXPECT_EQ(integer_of_json<std::uint64_t>(Json("18446744073709551615")), ~std::uint64_t{0});
}

}  // namespace
}  // namespace rr::conformance
