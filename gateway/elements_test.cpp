// SPDX-License-Identifier: Apache-2.0
#include "gateway/elements.hpp"

#include <gtest/gtest.h>

#include <random>

#include "gateway/testing/bench_service.hpp"
#include "rr/codec.hpp"

namespace rr::gateway {
namespace {

using dynamic::Value;

class GatewayElements : public ::testing::Test {
 protected:
  [[nodiscard]] std::vector<dynamic::ParameterDescription> parameters() const {
    for (const auto& member : definitions.members("test.bench.Bench")) {
      if (member.name == "describe") return member.parameters;
    }
    return {};
  }
  const dynamic::Definitions definitions{{testing::bench_definition}};
  const Value pose = Value::record({{"x", 1.5}, {"q", dynamic::List{1, 2, 3}}});
};

TEST_F(GatewayElements, AreThoseOfTheRuntime) {
  const auto type = dynamic::ValueType::parse("double");
  EXPECT_EQ(encode_element(type, 2.5), encode(2.5));
  EXPECT_EQ(decode_element(definitions, type, encode(2.5)).as<double>(), 2.5);
  EXPECT_TRUE(encode_element({}, 2.5).empty());
}

TEST_F(GatewayElements, ArgumentsAreReadAsTheyAreWritten) {
  const Bytes bytes = encode_arguments(parameters(), {"arm", pose});
  const dynamic::List list = decode_arguments(definitions, parameters(), bytes);
  ASSERT_EQ(list.size(), 2U);
  EXPECT_EQ(list[0].text(), "arm");
  EXPECT_EQ(list[1]["q"].at(2).as<double>(), 3.0);
  EXPECT_EQ(type_text(parameters()), "string,test.bench.Pose");
  EXPECT_TRUE(decode_arguments(definitions, {}, {}).empty());
  EXPECT_THROW(static_cast<void>(encode_arguments(parameters(), {"arm"})), Error);
}

TEST_F(GatewayElements, ACutPayloadIsRefused) {
  const Bytes whole = encode_arguments(parameters(), {"arm", pose});
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const Bytes cut(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
    EXPECT_THROW(static_cast<void>(decode_arguments(definitions, parameters(), cut)), Error)
        << size;
  }
  Bytes longer = whole;
  longer.push_back(std::byte{0});
  EXPECT_THROW(static_cast<void>(decode_arguments(definitions, parameters(), longer)), Error);
}

TEST_F(GatewayElements, AnyBytesAreReadOrRefused) {
  std::mt19937 random(5);
  const Bytes whole = encode_arguments(parameters(), {"arm", pose});
  int refused = 0;
  for (int i = 0; i < 20'000; ++i) {
    Bytes changed = whole;
    changed[random() % changed.size()] = static_cast<std::byte>(random());
    try {
      static_cast<void>(decode_arguments(definitions, parameters(), changed));
    } catch (const Error&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 1'000);
}

TEST_F(GatewayElements, ErrorsKeepWhatTheySay) {
  Message answer;
  EXPECT_EQ(error_of(answer), nullptr);
  set_error(answer, std::make_exception_ptr(Error(ErrorCode::remote_error, "a.B", "text", "sub")),
            "robot");
  EXPECT_EQ(answer.find("error-at"), "robot");
  try {
    std::rethrow_exception(error_of(answer));
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::remote_error);
    EXPECT_EQ(error.name(), "a.B");
    EXPECT_EQ(error.message(), "text");
    EXPECT_EQ(error.subname(), "sub");
    EXPECT_TRUE(error.parameter().is_null());
  }
}

TEST_F(GatewayElements, ErrorsKeepTheirParameter) {
  Message answer;
  set_error(answer,
            std::make_exception_ptr(Error(ErrorCode::remote_error, "a.B", "text", "sub",
                                          VarValue(Array<double>{0.5, -0.25}))),
            "robot");
  const auto parameter = [&] {
    try {
      std::rethrow_exception(error_of(answer));
    } catch (const Error& error) {
      return error.parameter();
    }
  };
  EXPECT_EQ(parameter(), VarValue(Array<double>{0.5, -0.25}));
  // What is no element is no parameter.
  answer.payload.resize(answer.payload.size() - 1);
  EXPECT_TRUE(parameter().is_null());
}

}  // namespace
}  // namespace rr::gateway
