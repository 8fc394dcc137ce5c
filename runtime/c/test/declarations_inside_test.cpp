// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "runtime/cpp/src/client/definition_text.hpp"

namespace rr::client {
namespace {

TEST(Declarations, AreReadFromTheLinesOfObjects) {
  const auto objects = declared_members(
      "service a.b\n"
      "struct S\n"
      "  field double x\n"
      "end\n"
      "object O\n"
      "  implements P\n"
      "  property double[3, 4] pose [readonly]\n"
      "  function int32{generator} count( int32 limit )\n"
      "  event moved(double pan)\n"
      "  wire double [2] level [ readonly, \\\n"
      "    urgent ]\n"
      "  pipe string{list} words\n"
      "  callback void ask()\n"
      "  objref O{int32} child\n"
      "end\n"
      "object Q\n"
      "end\n");
  ASSERT_EQ(objects.size(), 2U);
  EXPECT_TRUE(objects.at("Q").empty());
  std::vector<std::pair<std::string, std::string>> found;
  for (const DeclaredMember& member : objects.at("O")) found.emplace_back(member.kind, member.name);
  const std::vector<std::pair<std::string, std::string>> expected = {
      {"property", "pose"}, {"function", "count"}, {"event", "moved"}, {"wire", "level"},
      {"pipe", "words"},    {"callback", "ask"},   {"objref", "child"}};
  EXPECT_EQ(found, expected);
  EXPECT_EQ(objects.at("O")[0].modifiers, "[readonly]");
  EXPECT_EQ(objects.at("O")[3].modifiers, "[readonly,urgent]");
}

TEST(Declarations, MayBeAnything) {
  EXPECT_TRUE(declared_members("").empty());
  EXPECT_TRUE(declared_members("wire double x\n").empty());
  EXPECT_TRUE(declared_members("object O\nwire\nwire double\nwire double[ x\n").at("O").empty());
  EXPECT_EQ(declared_version("service a.b\noption version 0.8\nstdver 0.10\n"), "0.10");
  EXPECT_EQ(declared_version("service a.b\noption version 0.8\n"), "0.8");
  EXPECT_EQ(declared_version("service a.b\n"), "");
}

}  // namespace
}  // namespace rr::client
