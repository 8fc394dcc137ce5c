// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <limits>

#include "rr/number.hpp"
#include "runtime/cpp/src/value/conformance_types.hpp"
#include "runtime/cpp/src/value/testing.hpp"

// Numbers, bool, complex numbers, strings and enumerations (03, sections 3, 4, 11, 12).
namespace rr::testing_values {
namespace {

using conformance::types::Mode;

TEST(Scalar, HasTheBytesOfTheStandard) {
  EXPECT_EQ(encode(-1), from_hex("0f 01" + value_name + "07 00 01 ff ff ff ff"));
  EXPECT_EQ(encode(Mode::faulted), from_hex("0f 01" + value_name + "07 00 01 ff ff ff ff"));
  EXPECT_EQ(encode(true), from_hex("0c 01" + value_name + "0e 00 01 01"));
  EXPECT_EQ(encode(std::string("hi")), from_hex("0d 01" + value_name + "0b 00 02 68 69"));
}

template <class T>
void survives_at_its_limits() {
  EXPECT_TRUE(survives(std::numeric_limits<T>::min()));
  EXPECT_TRUE(survives(std::numeric_limits<T>::max()));
  EXPECT_TRUE(survives(T{1}));
}

TEST(Scalar, IsFoundByItsTypeAndNamedAsInDefinitions) {
  int count = 0;
  for (std::uint16_t i = 0; i < 200; ++i) {
    const auto type = static_cast<ElementType>(i);
    if (!is_number(type)) continue;
    ++count;
    with_number(type, [&]<class T>(std::type_identity<T>) {
      EXPECT_EQ(type_of<T>.element_type(), type) << word_of(type);
      EXPECT_EQ(sizeof(T), item_size(type)) << word_of(type);
    });
  }
  EXPECT_EQ(count, 13);
  EXPECT_EQ(word_of(ElementType::csingle), "csingle");
  EXPECT_EQ(word_of(ElementType::bool_), "bool");
  EXPECT_EQ(word_of(ElementType::pod_array), "pod_array");
  EXPECT_EQ(word_of(static_cast<ElementType>(104)), "");
}

TEST(Scalar, EveryNumberSurvives) {
  survives_at_its_limits<double>();
  survives_at_its_limits<float>();
  survives_at_its_limits<std::int8_t>();
  survives_at_its_limits<std::uint8_t>();
  survives_at_its_limits<std::int16_t>();
  survives_at_its_limits<std::uint16_t>();
  survives_at_its_limits<std::int32_t>();
  survives_at_its_limits<std::uint32_t>();
  survives_at_its_limits<std::int64_t>();
  survives_at_its_limits<std::uint64_t>();
  EXPECT_TRUE(survives(true));
  EXPECT_TRUE(survives(false));
  EXPECT_TRUE(survives(std::complex<double>(1.5, -2)));
  EXPECT_TRUE(survives(std::complex<float>(1.5F, -2)));
  EXPECT_TRUE(survives(Mode::automatic));
  EXPECT_TRUE(survives(std::string("a\0b", 3)));
  EXPECT_TRUE(survives(std::string(70000, 'x')));
}

TEST(Scalar, AnotherTypeIsAMismatch) {
  EXPECT_EQ(error_of<double>(text_of("value", "1.0")), ErrorCode::data_type_mismatch);
  EXPECT_EQ(error_of<double>(numbers_of<std::int32_t>("value", {1})),
            ErrorCode::data_type_mismatch);
  EXPECT_EQ(error_of<std::int32_t>(numbers_of<std::int64_t>("value", {5})),
            ErrorCode::data_type_mismatch);
  EXPECT_EQ(error_of<Mode>(numbers_of<double>("value", {1})), ErrorCode::data_type_mismatch);
  EXPECT_EQ(error_of<std::string>(numbers_of<double>("value", {1})), ErrorCode::data_type_mismatch);
}

TEST(Scalar, NullIsNoNumberAndNoString) {
  EXPECT_EQ(error_of<double>(null_of("value")), ErrorCode::null_value);
  EXPECT_EQ(error_of<Mode>(null_of("value")), ErrorCode::null_value);
  EXPECT_EQ(error_of<std::string>(null_of("value")), ErrorCode::data_type_error);
}

TEST(Scalar, OfNoNumbersIsOutOfRange) {
  EXPECT_EQ(error_of<double>(numbers_of<double>("value", {})), ErrorCode::out_of_range);
}

TEST(Scalar, TakesTheFirstOfSeveralNumbers) {
  EXPECT_EQ(value_of<double>(numbers_of<double>("value", {4, 5})), 4);
}

TEST(Scalar, AnyByteButZeroIsTrue) {
  ElementTree element = numbers_of<bool>("value", {true});
  element.payload[0] = std::byte{2};
  EXPECT_EQ(encode(value_of<bool>(element)), encode(true));
}

TEST(Scalar, UnknownValuesOfAnEnumPassThrough) {
  EXPECT_EQ(value_of<Mode>(numbers_of<std::int32_t>("value", {12345})), static_cast<Mode>(12345));
}

TEST(Scalar, TextNeedNotBeUtf8) {
  EXPECT_EQ(value_of<std::string>(text_of("value", "\xc3\x28\xff")), "\xc3\x28\xff");
}

TEST(Codec, RefusesMoreThanOneElement) {
  std::vector<std::byte> bytes = encode(1.5);
  bytes.push_back(std::byte{0});
  try {
    static_cast<void>(decode<double>(bytes));
    FAIL() << "took a byte too many";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::protocol_error);
  }
}

TEST(Codec, RefusesNothingAtAll) { EXPECT_THROW(static_cast<void>(decode<double>({})), Error); }

TEST(Codec, ErrorNamesTheElement) {
  try {
    static_cast<void>(decode<double>(encode(std::string("x"), MessageVersion::v4, "speed")));
    FAIL() << "took a string for a double";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::data_type_mismatch);
    EXPECT_EQ(error.name(), "RobotRaconteur.DataTypeMismatch");
    EXPECT_EQ(error.message(), "another type than expected: element `speed`");
  }
}

TEST(Codec, WritesIntoAWriterAgainAndAgain) {
  Writer writer;
  encode(writer, std::string("long enough to take room"));
  encode(writer, 1.5, MessageVersion::v2, "x");
  EXPECT_EQ(decode<double>(writer.copy(), MessageVersion::v2), 1.5);
}

TEST(Codec, RefusesNamesThatAreTooLong) {
  EXPECT_THROW(static_cast<void>(encode(1.5, MessageVersion::v2, std::string(65536, 'n'))), Error);
}

}  // namespace
}  // namespace rr::testing_values
