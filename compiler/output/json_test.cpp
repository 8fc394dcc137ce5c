// SPDX-License-Identifier: Apache-2.0
#include "compiler/output/json.hpp"

#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

#include "gtest/gtest.h"

namespace robdef {
namespace {

TEST(Json, IndentsByTwoAndKeepsTheOrderOfTheCalls) {
  JsonWriter json;
  json.begin_object().member("b", 1).key("a").begin_array().value("x").value(true).end_array();
  json.key("empty").begin_object().end_object().key("none").null().end_object();
  EXPECT_EQ(std::move(json).text(),
            "{\n"
            "  \"b\": 1,\n"
            "  \"a\": [\n"
            "    \"x\",\n"
            "    true\n"
            "  ],\n"
            "  \"empty\": {},\n"
            "  \"none\": null\n"
            "}\n");
}

TEST(Json, OneLineHasNoBlanksAndNoLineEnd) {
  JsonWriter json(JsonWriter::Layout::one_line);
  json.begin_array().begin_object().member("a", 1).member("b", "c d").end_object().end_array();
  EXPECT_EQ(std::move(json).text(), R"([{"a":1,"b":"c d"}])");
}

TEST(Json, EscapesWhatJsonRequiresAndNothingElse) {
  EXPECT_EQ(json_string("a\"b\\c/d"), R"("a\"b\\c/d")");
  EXPECT_EQ(json_string("\n\r\t\x01\x7f"), R"("\n\r\t\u0001\u007f")");
  EXPECT_EQ(json_string("\xC3\xA9 \xF0\x9F\x98\x80"), "\"\xC3\xA9 \xF0\x9F\x98\x80\"");
}

TEST(Json, ReplacesBytesThatAreNotUtf8) {
  EXPECT_EQ(json_string("a\xFF"), "\"a\xEF\xBF\xBD\"");
  EXPECT_EQ(json_string("\xC3"), "\"\xEF\xBF\xBD\"");
  EXPECT_EQ(json_string("\xC0\x80"), "\"\xEF\xBF\xBD\xEF\xBF\xBD\"");
  EXPECT_EQ(json_string("\xED\xA0\x80"), "\"\xEF\xBF\xBD\xEF\xBF\xBD\xEF\xBF\xBD\"");
}

TEST(Json, WritesNumbersExactly) {
  JsonWriter json(JsonWriter::Layout::one_line);
  json.begin_array();
  json.value(std::numeric_limits<std::int64_t>::min());
  json.value(std::numeric_limits<std::uint64_t>::max());
  json.value(0.1).value(1e300).value(-0.0);
  json.value(std::numeric_limits<double>::infinity());
  json.end_array();
  EXPECT_EQ(std::move(json).text(),
            "[-9223372036854775808,18446744073709551615,0.1,1e+300,-0,null]");
}

TEST(Json, RefusesWhatWouldNotBeOneDocument) {
  EXPECT_THROW(JsonWriter().begin_object().value(1), std::logic_error);
  EXPECT_THROW(JsonWriter().begin_array().end_object(), std::logic_error);
  EXPECT_THROW(JsonWriter().begin_array().key("a"), std::logic_error);
  EXPECT_THROW(JsonWriter().value(1).value(2), std::logic_error);
  JsonWriter open;
  open.begin_array();
  EXPECT_THROW((void)std::move(open).text(), std::logic_error);
}

}  // namespace
}  // namespace robdef
