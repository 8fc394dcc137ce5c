// SPDX-License-Identifier: Apache-2.0
#include "compiler/backends/cpp/view.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "compiler/backends/cpp/backend.hpp"
#include "compiler/backends/cpp/order.hpp"
#include "compiler/model/compiled.hpp"

namespace robdef::cpp {
namespace {

using model::Compiled;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

DefinitionView view_of(const Compiled& compiled, std::size_t index = 0) {
  Report report;
  return make_view(compiled.model, report).definitions.at(index);
}

/// Names of records and objects in the order of the header.
std::vector<std::string> order_of(const std::string& lines) {
  const Compiled compiled = model::compiled_lines(lines);
  std::vector<std::string> names;
  for (const DeclarationView& declaration : view_of(compiled).declarations) {
    if (declaration.record) names.push_back(declaration.record->name);
    if (declaration.object) names.push_back(declaration.object->short_name);
  }
  return names;
}

/// The type of the only field of the last struct.
FieldView field_of(const std::string& type, const std::string& before = "") {
  const Compiled compiled =
      model::compiled_lines(before + "struct S\n field " + type + " x\nend\n");
  return view_of(compiled).declarations.back().record->fields.at(0);
}

TEST(Order, KeepsTheDefinitionsWhereItCan) {
  EXPECT_THAT(order_of("object O\nend\nstruct A\n field int32 x\nend\nstruct B\n field A a\nend\n"),
              ElementsAre("O", "A", "B"));
}

TEST(Order, PutsWhatIsUsedFirst) {
  EXPECT_THAT(order_of("struct A\n field B{list} b\nend\nstruct B\n field int32 x\nend\n"),
              ElementsAre("B", "A"));
  EXPECT_THAT(order_of("object O\n property A a\nend\nstruct A\n field int32 x\nend\n"),
              ElementsAre("A", "O"));
  EXPECT_THAT(order_of("object O\n implements P\nend\nobject P\nend\n"), ElementsAre("P", "O"));
}

TEST(Order, DeclaresWhatIsNamedEarly) {
  const Compiled compiled = model::compiled_lines(
      "struct A\n field B b\nend\nstruct B\n field A a\nend\n"
      "object O\n objref P p\n objref O o\nend\nobject P\nend\n");
  std::vector<std::string> forwards;
  for (const ForwardView& forward : view_of(compiled).forwards) {
    forwards.push_back((forward.is_struct ? "struct " : "class ") + forward.name);
  }
  EXPECT_THAT(forwards, ElementsAre("struct B", "class PStub", "class PSkeleton"));
}

TEST(Types, FollowTheTable) {
  EXPECT_EQ(field_of("single").type, "float");
  EXPECT_EQ(field_of("string").type, "::std::string");
  EXPECT_EQ(field_of("cdouble[]").type, "::rr::Array<::std::complex<double>>");
  EXPECT_EQ(field_of("uint8[4]").type, "::std::array<::std::uint8_t, 4>");
  EXPECT_EQ(field_of("double[3,3]").type, "::rr::FixedMultiArray<double, 3, 3>");
  EXPECT_EQ(field_of("int16[8-]").type, "::rr::BoundedArray<::std::int16_t, 8>");
  EXPECT_EQ(field_of("bool[*]").type, "::rr::MultiArray<bool>");
  EXPECT_EQ(field_of("varvalue{string}").type,
            "::std::optional<::std::map<::std::string, ::rr::VarValue>>");
}

// What variables of these types begin with.
TEST(Types, KnowTheFirstValueOfAVariable) {
  EXPECT_EQ(field_of("single").initial.literal, "0");
  EXPECT_EQ(field_of("bool").initial.literal, "false");
  EXPECT_EQ(field_of("string").initial.literal, "");
  EXPECT_EQ(field_of("double[2048]").initial.length, "");
  EXPECT_EQ(field_of("double[2049]").initial.length, "2049");
  EXPECT_EQ(field_of("double[2049]").initial.item, "");
  EXPECT_EQ(field_of("double[2049]{list}").initial.length, "");
  EXPECT_EQ(field_of("uint8[20000-]").initial.length, "");
  const InitialView of_several = field_of("uint8[200,100]").initial;
  EXPECT_EQ(of_several.length, "20000");
  EXPECT_EQ(of_several.shape, "200, 100");
  EXPECT_EQ(of_several.item, "::std::uint8_t");
}

TEST(Types, StoreLongArraysOutside) {
  EXPECT_EQ(field_of("double[2048]").type, "::std::array<double, 2048>");
  const FieldView fixed = field_of("double[2049]");
  EXPECT_EQ(fixed.type, "::rr::Array<double>");
  EXPECT_EQ(fixed.descriptor, "::rr::FixedLength<double, 2049>");
  EXPECT_EQ(field_of("uint8[20000-]").descriptor, "::rr::MaximumLength<::std::uint8_t, 20000>");
  EXPECT_EQ(field_of("uint8[200,100]").descriptor, "::rr::FixedShape<::std::uint8_t, 200, 100>");
  EXPECT_EQ(field_of("double[2049]{list}").type,
            "::std::optional<::std::vector<::std::array<double, 2049>>>");
}

TEST(Types, MakeStructsNullableAndCyclesRecursive) {
  const std::string point = "struct P\n field double y\nend\n";
  EXPECT_EQ(field_of("P", point).type, "::std::optional<P>");
  EXPECT_EQ(field_of("P{int32}", point).type,
            "::std::optional<::std::map<::std::int32_t, ::std::optional<P>>>");
  EXPECT_EQ(field_of("S").type, "::rr::Recursive<S>");
  EXPECT_EQ(field_of("S{list}").type, "::std::optional<::std::vector<::rr::Recursive<S>>>");
}

TEST(Types, AreQualifiedWhereAMemberHasTheirName) {
  const Compiled compiled = model::compiled_lines(
      "enum Color\n red = 0\nend\nstruct S\n field Color Color\n field Color other\nend\n"
      "object O\n function Color Color(Color Color)\nend\n");
  const DefinitionView view = view_of(compiled);
  EXPECT_EQ(view.declarations.at(1).record->fields.at(1).type, "::example::t::Color");
  const MemberView& function = view.declarations.at(2).object->members.at(0);
  EXPECT_EQ(function.type, "::example::t::Color");
  EXPECT_EQ(function.parameters.at(0).name, "Color_");
}

TEST(Types, AreWrittenByTheirAlias) {
  const Compiled compiled = model::compiled(
      {"service a.b\nstdver 0.10\nstruct P\n field int32 x\nend\nstruct Q\n field int32 x\nend\n",
       "service c.d\nstdver 0.10\nimport a.b\nusing a.b.P as R\nstruct S\n field R r\n"
       " field a.b.Q q\nend\n"});
  const DefinitionView view = view_of(compiled, 1);
  EXPECT_EQ(view.aliases.at(0).name, "R");
  EXPECT_EQ(view.aliases.at(0).target, "::a::b::P");
  const std::vector<FieldView>& fields = view.declarations.at(0).record->fields;
  EXPECT_EQ(fields.at(0).type, "::std::optional<R>");
  EXPECT_EQ(fields.at(1).type, "::std::optional<::a::b::Q>");
}

TEST(Members, OfOneImplementedObjectAreInherited) {
  const Compiled compiled = model::compiled_lines(
      "object A\n property int32 x\nend\n"
      "object B\n implements A\n property int32 x\n property int32 y\nend\n"
      "object C\n implements B\n implements A\n property int32 x\n property int32 y\nend\n");
  const DefinitionView view = view_of(compiled);
  const std::vector<MemberView>& members = view.declarations.at(2).object->members;
  EXPECT_TRUE(members.at(0).is_inherited);
  EXPECT_TRUE(members.at(1).is_inherited);
  EXPECT_FALSE(view.declarations.at(1).object->members.at(1).is_inherited);
}

TEST(Members, OfTwoImplementedObjectsAreMadeAnew) {
  const Compiled compiled = model::compiled_lines(
      "object A\n property int32 x\nend\nobject B\n property int32 x\nend\n"
      "object C\n implements A\n implements B\n property int32 x\nend\n");
  EXPECT_FALSE(view_of(compiled).declarations.at(2).object->members.at(0).is_inherited);
}

MemberView member_of(const std::string& line) {
  const Compiled compiled =
      model::compiled_lines("pod P\n field double x\nend\nobject O\n " + line + "\nend\n");
  return view_of(compiled).declarations.back().object->members.at(0);
}

TEST(Members, AreReachedThroughHandles) {
  EXPECT_EQ(member_of("pipe P{list} x").handle, "::rr::Pipe<::std::optional<::std::vector<P>>>");
  EXPECT_EQ(member_of("pipe P x").served, "::rr::PipeServer<P>");
  EXPECT_EQ(member_of("wire double[3] x").served, "::rr::WireServer<::std::array<double, 3>>");
  EXPECT_EQ(member_of("callback void x()").handle, "::rr::Callback<void()>");
  EXPECT_EQ(member_of("callback P x(string a, P[] b)").handle,
            "::rr::Callback<P(::std::string, ::rr::Array<P>)>");
  EXPECT_EQ(member_of("memory P[] x").handle, "::rr::ArrayMemory<P>");
  EXPECT_EQ(member_of("memory bool[*] x").served,
            "::std::shared_ptr<::rr::MultiMemorySource<bool>>");
}

TEST(Members, OfGeneratorsNameWhatAStepGivesAndTakes) {
  EXPECT_EQ(member_of("function P{generator} x()").handle, "::rr::Generator<P>");
  EXPECT_EQ(member_of("function void x(P{generator} y)").handle, "::rr::Generator<void, P>");
  EXPECT_EQ(member_of("function bool{generator} x(P{generator} y)").served,
            "::rr::Sequence<bool, P>");
}

// All files of an object with this member.
std::string printed_for(const std::string& line) {
  const Compiled compiled =
      model::compiled_lines("pod P\n field double x\nend\nobject O\n " + line + "\nend\n");
  Report report;
  std::string printed;
  const FileSet files = CppBackend().generate(compiled.model, {}, report);
  for (const auto& [path, content] : files.files()) printed += content;
  return printed;
}

// A coroutine lives longer than the call that made it.
TEST(Members, OfGeneratorsGetTheirParametersForThemselves) {
  const MemberView view = member_of("function P{generator} x(string a, int32 b)");
  EXPECT_FALSE(view.parameters.at(0).is_by_value);
  EXPECT_TRUE(view.parameters.at(1).is_by_value);
  const std::string printed = printed_for("function P{generator} x(string a, int32 b)");
  EXPECT_THAT(printed, HasSubstr("virtual ::rr::Sequence<P> x(::std::string a, "
                                 "::std::int32_t b) = 0;"));
  EXPECT_THAT(printed, HasSubstr("return rr_request.answer(x(::std::move(a), b));"));
}

TEST(Members, ThatCannotBeServedHaveNoLines) {
  const MemberView view = member_of("memory double[]{list} x");
  EXPECT_FALSE(view.is_served);
  EXPECT_EQ(view.handle, "");
  EXPECT_THAT(printed_for("memory double[]{list} x"), Not(HasSubstr("rr_memory_")));
}

TEST(Members, SayWhatTheirRowHas) {
  const MemberView view = member_of("function bool{generator} x(P{generator} y) [nolock,urgent]");
  EXPECT_THAT(view.described, ElementsAre("bool", "P"));
  EXPECT_THAT(view.access, ElementsAre("nolock", "urgent"));
  EXPECT_TRUE(view.has_no_table);
  EXPECT_THAT(printed_for("function bool{generator} x(P{generator} y) [nolock,urgent]"),
              HasSubstr("::rr::generator<bool, P>(\"x\", {}, ::rr::nolock | ::rr::urgent),"));
  EXPECT_THAT(member_of("objref O x [urgent]").access, ElementsAre());
}

// Nothing of the language's but names, types and literals: a struct constant has a line for each.
TEST(Constants, AreNamesTypesAndLiterals) {
  const Compiled compiled = model::compiled_lines(
      "constant int32 A 0x10\nconstant int32[] B {1,-2}\nconstant string C \"x\"\n"
      "constant struct D {a: A}\nconstant struct E {d: D, c: C}\nconstant struct F {}\n");
  std::vector<ConstantView> constants;
  for (const DeclarationView& view : view_of(compiled).declarations) {
    constants.push_back(view.constant.value());
  }
  EXPECT_EQ(constants.at(0).type, "::std::int32_t");
  EXPECT_EQ(constants.at(0).value, "0x10");
  EXPECT_TRUE(constants.at(1).is_array);
  EXPECT_EQ(constants.at(1).value, "");
  EXPECT_THAT(constants.at(1).items, ElementsAre("1", "-2"));
  EXPECT_EQ(constants.at(2).value, "\"x\"");
  std::vector<std::string> lines;
  for (const ConstantPartView& part : constants.at(4).parts) {
    lines.push_back(part.margin +
                    (part.closes  ? "end"
                     : part.opens ? "struct"
                                  : part.type) +
                    " " + part.name);
  }
  EXPECT_THAT(lines, ElementsAre("struct E", "  struct d", "    ::std::int32_t a", "  end ",
                                 "  ::std::string_view c", "end "));
  ASSERT_EQ(constants.at(5).parts.size(), 1U);
  EXPECT_TRUE(constants.at(5).parts.at(0).is_empty);
}

// A text with a NUL would end there.
TEST(Constants, TellTheSizeOfATextWithANul) {
  const Compiled compiled = model::compiled_lines("constant string C \"x\\u0000y\"\n");
  const ConstantView view = view_of(compiled).declarations.at(0).constant.value();
  EXPECT_EQ(view.value, "\"x\\000y\"");
  EXPECT_EQ(view.size, "3");
}

TEST(View, IncludesOnlyWhatMembersNeed) {
  const auto includes_of = [](const std::string& line) {
    return view_of(model::compiled_lines("object O\n " + line + "\nend\n")).includes;
  };
  EXPECT_THAT(includes_of("pipe double x"), Contains("<rr/pipes.hpp>"));
  EXPECT_THAT(includes_of("wire double x"), Contains("<rr/wires.hpp>"));
  EXPECT_THAT(includes_of("wire double x"), Not(Contains("<rr/pipes.hpp>")));
  EXPECT_THAT(includes_of("callback void x()"), Contains("<rr/callbacks.hpp>"));
  EXPECT_THAT(includes_of("memory double[] x"), Contains("<rr/memories.hpp>"));
  EXPECT_THAT(includes_of("memory double[]{list} x"), Not(Contains("<rr/memories.hpp>")));
  EXPECT_THAT(includes_of("function double{generator} x()"), Contains("<rr/generators.hpp>"));
}

TEST(View, IsPrintedAsJson) {
  const Compiled compiled = model::compiled_lines("object O\n wire double w [readonly]\nend\n");
  Report report;
  const std::string json = CppBackend().view(compiled.model, report);
  EXPECT_THAT(json, HasSubstr("\"wire_name\": \"example.t\""));
  EXPECT_THAT(json, HasSubstr("\"is_wire\": true,"));
  EXPECT_THAT(json, HasSubstr("\"served\": \"::rr::WireServer<double>\","));
}

}  // namespace
}  // namespace robdef::cpp
