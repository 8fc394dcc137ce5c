// SPDX-License-Identifier: Apache-2.0
#include "rr/varvalue.hpp"

#include <gtest/gtest.h>

#include "rr/time_spec.hpp"
#include "runtime/cpp/src/value/conformance_types.hpp"
#include "runtime/cpp/src/value/testing.hpp"

// Values whose type is known on receipt only (03, section 8).
namespace rr::testing_values {
namespace {

using conformance::types::Mode;
using conformance::types::rr_definition;
using conformance::types::Sample;
using conformance::types::Stats;
using conformance::types::Vector3;

class VarValues : public testing::Test {
 protected:
  template <class T>
  VarValue received(const T& sent) {
    const VarValue v2 =
        decode<VarValue>(encode(sent, MessageVersion::v2), MessageVersion::v2, &types_);
    VarValue v4 = decode<VarValue>(encode(sent), MessageVersion::v4, &types_);
    EXPECT_EQ(v2, v4);
    return v4;
  }
  ErrorCode error(const ElementTree& tree) { return error_of<VarValue>(tree, &types_); }

  TypeRegistry types_{rr_definition};
};

TEST_F(VarValues, NullIsAValue) {
  EXPECT_TRUE(received(VarValue()).is_null());
  EXPECT_EQ(encode(VarValue()), encode(std::optional<Stats>()));
}

TEST_F(VarValues, NumbersArriveAsArrays) {
  const VarValue value = received(VarValue(1.5));
  EXPECT_EQ(value.get<Array<double>>(), (Array<double>{1.5}));
  EXPECT_EQ(value.number<double>(), 1.5);
  EXPECT_EQ(value.get_if<double>(), nullptr);
  EXPECT_THROW(static_cast<void>(value.number<float>()), Error);
  EXPECT_EQ(received(VarValue(Mode::manual)).number<Mode>(), Mode::manual);
  EXPECT_EQ(received(VarValue(true)).number<bool>(), true);
}

TEST_F(VarValues, SeveralNumbersAreNotOne) {
  EXPECT_THROW(static_cast<void>(received(Array<double>{1, 2}).number<double>()), Error);
  EXPECT_THROW(static_cast<void>(received(Array<double>{}).number<double>()), Error);
}

template <class T>
T round_trip(const T& value, const TypeRegistry& types) {
  return decode<VarValue>(encode(VarValue(value)), MessageVersion::v4, &types).get<T>();
}

TEST_F(VarValues, EveryKindArrivesAsItself) {
  const auto same = [&](const auto& value) { return round_trip(value, types_) == value; };
  EXPECT_TRUE(same(std::string("text")));
  EXPECT_TRUE(same(Array<double>{1}));
  EXPECT_TRUE(same(Array<float>{1}));
  EXPECT_TRUE(same(Array<std::int8_t>{1}));
  EXPECT_TRUE(same(Array<std::uint8_t>{1}));
  EXPECT_TRUE(same(Array<std::int16_t>{1}));
  EXPECT_TRUE(same(Array<std::uint16_t>{1}));
  EXPECT_TRUE(same(Array<std::int32_t>{1}));
  EXPECT_TRUE(same(Array<std::uint32_t>{1}));
  EXPECT_TRUE(same(Array<std::int64_t>{1}));
  EXPECT_TRUE(same(Array<std::uint64_t>{1}));
  EXPECT_TRUE(same(Array<bool>{true}));
  EXPECT_TRUE(same(Array<std::complex<double>>{{1, 2}}));
  EXPECT_TRUE(same(Array<std::complex<float>>{{1, 2}}));
  EXPECT_TRUE(same(MultiArray<double>{{1}, {1}}));
  EXPECT_TRUE(same(MultiArray<float>{{1}, {1}}));
  EXPECT_TRUE(same(MultiArray<std::int8_t>{{1}, {1}}));
  EXPECT_TRUE(same(MultiArray<std::uint8_t>{{1}, {1}}));
  EXPECT_TRUE(same(MultiArray<std::int16_t>{{1}, {1}}));
  EXPECT_TRUE(same(MultiArray<std::uint16_t>{{1}, {1}}));
  EXPECT_TRUE(same(MultiArray<std::int32_t>{{1}, {1}}));
  EXPECT_TRUE(same(MultiArray<std::uint32_t>{{1}, {1}}));
  EXPECT_TRUE(same(MultiArray<std::int64_t>{{1}, {1}}));
  EXPECT_TRUE(same(MultiArray<std::uint64_t>{{1}, {1}}));
  EXPECT_TRUE(same(MultiArray<bool>{{1}, {true}}));
  EXPECT_TRUE(same(MultiArray<std::complex<double>>{{1}, {{1, 2}}}));
  EXPECT_TRUE(same(MultiArray<std::complex<float>>{{1}, {{1, 2}}}));
  EXPECT_TRUE(same(Stats{1, 2, "x"}));
  EXPECT_TRUE(same(TimeSpec{1, 2}));
  EXPECT_TRUE(same(Array<Sample>{Sample{1, 2, {}}}));
  EXPECT_TRUE(same(MultiArray<Sample>{{1}, {Sample{1, 2, {}}}}));
  EXPECT_TRUE(same(Array<Vector3>{Vector3{1, 2, 3}}));
  EXPECT_TRUE(same(MultiArray<Vector3>{{1}, {Vector3{1, 2, 3}}}));
  EXPECT_TRUE(same(VarList{Array<double>{1}, VarValue()}));
  EXPECT_TRUE(same(VarIntMap{{-3, Array<double>{1}}}));
  EXPECT_TRUE(same(VarStringMap{{"k", std::string("v")}}));
}

TEST_F(VarValues, ContainersOfAnythingArriveAsContainersOfVarvalues) {
  EXPECT_EQ(received(VarValue(std::optional<std::vector<double>>({1, 2}))).get<VarList>(),
            (VarList{Array<double>{1}, Array<double>{2}}));
  EXPECT_EQ(received(VarValue(std::map<std::string, std::string>{{"k", "v"}})).get<VarStringMap>(),
            (VarStringMap{{"k", "v"}}));
}

TEST_F(VarValues, SinglePodsArriveAsArrays) {
  EXPECT_EQ(received(VarValue(Sample{1, 2, {}})).get<Array<Sample>>(),
            (Array<Sample>{Sample{1, 2, {}}}));
  EXPECT_EQ(received(VarValue(Vector3{1, 2, 3})).get<Array<Vector3>>(),
            (Array<Vector3>{Vector3{1, 2, 3}}));
}

TEST_F(VarValues, NullStructsAreNull) {
  EXPECT_TRUE(received(VarValue(std::optional<Stats>())).is_null());
}

TEST_F(VarValues, NamedTypesMustBeKnown) {
  const ElementTree unknown = nested("value", ElementType::structure, "no.such.Type", {});
  EXPECT_EQ(error(unknown), ErrorCode::service_error);
  EXPECT_EQ(error(nested("value", ElementType::structure, "Stats", {})),
            ErrorCode::invalid_argument);
  EXPECT_EQ(error(nested("value", ElementType::pod_array, "conformance.types.NoSuch", {})),
            ErrorCode::service_error);
  EXPECT_EQ(
      error_of<VarValue>(nested("value", ElementType::structure, "conformance.types.Stats", {})),
      ErrorCode::service_error);
}

TEST_F(VarValues, NamesOfAnotherKindAreRefused) {
  const auto named = [&](ElementType type, std::string_view name) {
    return error(nested("value", type, name, {}));
  };
  EXPECT_EQ(named(ElementType::structure, "conformance.types.Sample"), ErrorCode::data_type_error);
  EXPECT_EQ(named(ElementType::pod_array, "conformance.types.Stats"), ErrorCode::data_type_error);
  EXPECT_EQ(named(ElementType::pod_array, "conformance.types.Vector3"), ErrorCode::data_type_error);
  EXPECT_EQ(named(ElementType::namedarray_multidimarray, "conformance.types.Sample"),
            ErrorCode::data_type_error);
}

TEST_F(VarValues, OtherTypesAreErrors) {
  EXPECT_EQ(error(nested("value", ElementType::pod, "", {})), ErrorCode::data_type_error);
  EXPECT_EQ(error(nested("value", ElementType::multidimarray, "", {})),
            ErrorCode::message_element_not_found);
  EXPECT_EQ(error(nested("value", ElementType::multidimarray, "",
                         {numbers_of<std::uint32_t>("dims", {1}), text_of("array", "x")})),
            ErrorCode::data_type_mismatch);
}

VarValue lists(int depth, VarValue innermost) {
  VarValue value = std::move(innermost);
  for (int i = 0; i < depth; ++i) value = VarList{value};
  return value;
}

TEST_F(VarValues, NestingIsBounded) {
  EXPECT_TRUE(survives(lists(63, VarValue())));
  EXPECT_EQ(sending_error_of(lists(64, VarValue())), ErrorCode::protocol_error);
  // Bytes that other senders may make.
  ElementTree list = nested("value", ElementType::list, "", {});
  for (int depth = 1; depth < 63; ++depth) {
    list = nested("value", ElementType::list, "", {numbered(0, list)});
  }
  EXPECT_EQ(error(list), ErrorCode::none);
  EXPECT_EQ(error(nested("value", ElementType::list, "", {numbered(0, list)})),
            ErrorCode::protocol_error);
}

// What is sent must be within what a receiver takes.
TEST_F(VarValues, NestingCountsAllElements) {
  EXPECT_EQ(sending_error_of(lists(63, Array<double>{1})), ErrorCode::none);
  EXPECT_EQ(sending_error_of(lists(63, Vector3{})), ErrorCode::protocol_error);
  EXPECT_EQ(sending_error_of(lists(62, Vector3{})), ErrorCode::none);
  EXPECT_EQ(sending_error_of(lists(62, Sample{})), ErrorCode::protocol_error);
  EXPECT_EQ(sending_error_of(lists(61, Sample{})), ErrorCode::none);
  EXPECT_EQ(sending_error_of(lists(62, MultiArray<Vector3>{})), ErrorCode::protocol_error);
  EXPECT_EQ(sending_error_of(lists(61, MultiArray<Vector3>{})), ErrorCode::none);
}

TEST_F(VarValues, CopiesShareTheValue) {
  const VarValue value = Stats{1, 2, "x"};
  const VarValue copy = value;  // NOLINT(performance-unnecessary-copy-initialization)
  EXPECT_EQ(&value.get<Stats>(), &copy.get<Stats>());
  EXPECT_EQ(value, copy);
}

TEST_F(VarValues, CompareByTypeAndValue) {
  EXPECT_EQ(VarValue("a"), VarValue(std::string("a")));
  EXPECT_NE(VarValue("a"), VarValue("b"));
  EXPECT_NE(VarValue(1.0), VarValue(Array<double>{1}));
  EXPECT_NE(VarValue(), VarValue(1.0));
  EXPECT_EQ(VarValue(), VarValue());
}

TEST_F(VarValues, AskedForAnotherTypeThrow) {
  EXPECT_THROW(static_cast<void>(VarValue(1.0).get<std::string>()), Error);
  EXPECT_THROW(static_cast<void>(VarValue().get<std::string>()), Error);
}

TEST(Error, HasTheNameOfItsCode) {
  const Error error(ErrorCode::object_locked_error, "taken");
  EXPECT_EQ(error.name(), "RobotRaconteur.ObjectLockedError");
  EXPECT_STREQ(error.what(), "RobotRaconteur.ObjectLockedError: taken");
  EXPECT_TRUE(error.parameter().is_null());
}

TEST(Error, CarriesAParameter) {
  const Error error(ErrorCode::remote_error, "a.b.Fault", "broken", "sub", VarValue("why"));
  const Error copy = error;  // NOLINT(performance-unnecessary-copy-initialization)
  EXPECT_EQ(copy.name(), "a.b.Fault");
  EXPECT_EQ(copy.message(), "broken");
  EXPECT_EQ(copy.subname(), "sub");
  EXPECT_EQ(copy.parameter(), VarValue("why"));
  EXPECT_STREQ(Error(ErrorCode::unknown_error, "", "only this").what(), "only this");
}

}  // namespace
}  // namespace rr::testing_values
