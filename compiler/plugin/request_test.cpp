// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "compiler/model/compiled.hpp"
#include "compiler/plugin/plugin.hpp"

namespace robdef::plugin {
namespace {

using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

std::string request_for(const model::Compiled& compiled, const Plugin& plugin = {}) {
  EXPECT_TRUE(compiled.codes().empty());
  return request_text(plugin, compiled.model, *compiled.sources);
}

TEST(PluginRequest, BeginsWithItsVersionAndTheOptions) {
  const auto text = request_for(model::compiled_lines("enum E\n    one = 1\nend\n"),
                                {.program = "x", .options = {{"a", "1"}, {"b", "\""}}});
  EXPECT_THAT(text, StartsWith(R"({"robdef_plugin":1,"options":{"a":"1","b":"\""},"definitions":[)"
                               R"({"name":"example.t","file":"0.robdef","is_import":false,)"));
  EXPECT_EQ(text.find('\n'), text.size() - 1) << "one line";
  EXPECT_THAT(text, Not(HasSubstr("\"span\"")));
  EXPECT_THAT(text, Not(HasSubstr("\"tokens\"")));
}

TEST(PluginRequest, PlacesAreWhereTheTextHasThem) {
  const auto text = request_for(model::compiled_lines("enum E\n    one = 1\nend\n"));
  EXPECT_THAT(text, HasSubstr(R"("name":"one","code_name":"one","value":1,"is_hexadecimal":false,)"
                              R"("documentation":"","at":{"file":"0.robdef","line":4,"column":5,)"
                              R"("length":3})"));
}

TEST(PluginRequest, TypesSayWhereTheyAreDeclared) {
  const auto text = request_for(model::compiled(
      {"service example.a\nstdver 0.10\nstruct S\n    field double x\nend\n",
       "service example.b\nstdver 0.10\nimport example.a\nobject O\n"
       "    property example.a.S{list} s\n    wire double[2,3] w [readonly]\nend\n"}));
  EXPECT_THAT(text, HasSubstr(R"({"text":"example.a.S{list}","kind":"struct","name":"example.a.S",)"
                              R"("array":"none","dimensions":[],"container":"list",)"));
  EXPECT_THAT(text, HasSubstr(R"("element_count":1,"definition":"example.a"})"));
  EXPECT_THAT(text, HasSubstr(R"("element_count":6,"definition":null})"));
}

TEST(PluginRequest, MembersHaveTheSharedFacts) {
  const auto text = request_for(
      model::compiled_lines("object A\n    property double p [readonly]\nend\n"
                            "object B\n    implements A\n    property double p [readonly]\n"
                            "    event e(int32 x)\nend\n"));
  EXPECT_THAT(text,
              HasSubstr(R"("origin":null,"full_name":"example.t.A.p","facts":{"wire_name":"p",)"
                        R"("kind":"property","is_property":true)"));
  EXPECT_THAT(text, HasSubstr(R"("origin":"example.t.A","full_name":"example.t.A.p","facts":)"));
  EXPECT_THAT(text, HasSubstr(R"("is_served":true,"is_inherited":true,"number":"0")"));
  EXPECT_THAT(text, HasSubstr(R"("can_get":true,"can_set":false)"));
  EXPECT_THAT(text, HasSubstr(R"("wire_name":"example.t.B"})"));
}

}  // namespace
}  // namespace robdef::plugin
