// SPDX-License-Identifier: Apache-2.0
#include "compiler/backends/cpp/names.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "compiler/backends/cpp/view.hpp"
#include "compiler/model/compiled.hpp"

namespace robdef::cpp {
namespace {

using model::Compiled;
using testing::ElementsAre;
using testing::IsEmpty;

/// Codes of the backend's own findings for these files.
std::vector<std::string> codes_of(const std::vector<std::string>& texts) {
  const Compiled compiled = model::compiled(texts);
  EXPECT_THAT(compiled.errors(), IsEmpty());
  Report report;
  (void)make_view(compiled.model, report);
  std::vector<std::string> codes;
  for (const Diagnostic* finding : report.sorted()) {
    codes.emplace_back(entry_of(finding->code()).name);
  }
  return codes;
}

std::string service(const std::string& name, const std::string& lines) {
  return "service " + name + "\nstdver 0.10\n" + lines;
}

TEST(Names, AddAnUnderscoreToReservedWords) {
  EXPECT_EQ(identifier("class"), "class_");
  EXPECT_EQ(identifier("xor_eq"), "xor_eq_");
  EXPECT_EQ(identifier("errno"), "errno_");
  EXPECT_EQ(identifier("INT32_MAX"), "INT32_MAX_");
  EXPECT_EQ(identifier("SIGINT"), "SIGINT_");
  EXPECT_EQ(identifier("Class"), "Class");
  EXPECT_EQ(identifier("max"), "max");
  EXPECT_EQ(identifier("SIGNAL"), "SIGNAL");
}

TEST(Names, TurnServicesIntoNamespacesAndPaths) {
  EXPECT_EQ(namespace_of("experimental.mount"), "experimental::mount");
  EXPECT_EQ(namespace_of("example.new.std"), "example::new_::std");
  EXPECT_EQ(namespace_of("std.vector"), "std_::vector");
  EXPECT_EQ(namespace_of("time"), "time_");
  EXPECT_EQ(namespace_of("gamma.camera"), "gamma_::camera");
  EXPECT_EQ(namespace_of("abort"), "abort_");
  EXPECT_EQ(namespace_of("yn"), "yn_");
  EXPECT_EQ(namespace_of("example.time"), "example::time");
  EXPECT_EQ(path_of("example.new"), "example/new");
}

TEST(Names, OfGeneratedClassesCollideWithThoseOfTheDefinition) {
  EXPECT_THAT(codes_of({service("a.b", "struct FooStub\n field int32 x\nend\nobject Foo\nend\n")}),
              ElementsAre("R0901"));
  EXPECT_THAT(
      codes_of({service("a.b", "struct FooDefault\n field int32 x\nend\nobject Foo\nend\n")}),
      IsEmpty());
}

TEST(Names, OfTypesCollideWithInnerNamespaces) {
  const std::string outer = service("a.b", "struct c\n field int32 x\nend\n");
  EXPECT_THAT(codes_of({outer, service("a.b.c", "")}), ElementsAre("R0901"));
  EXPECT_THAT(codes_of({outer, service("a.b.d", "")}), IsEmpty());
}

TEST(Names, AreReportedWhenTheyAreChanged) {
  EXPECT_THAT(codes_of({service("a.b",
                                "object Foo\n property int32 class\n function void new()\n"
                                " event FooStub()\nend\n")}),
              ElementsAre("R0903", "R0903"));
}

TEST(Names, OfParametersHideNothing) {
  const Compiled compiled =
      model::compiled({service("a.b", "constant int32 LIMIT 1\nobject Foo\nend\n")});
  Report report;
  const Names names(compiled.definition(0), compiled.model, report);
  std::set<std::string> taken;
  EXPECT_EQ(names.local("LIMIT", taken), "LIMIT_");
  EXPECT_EQ(names.local("value", taken), "value");
  EXPECT_EQ(names.local("value", taken), "value_");
  EXPECT_EQ(names.local("1st", taken), "p_1st");
  EXPECT_EQ(names.local("rr_request", taken), "p_rr_request");
  EXPECT_EQ(names.local("int", taken), "int_");
}

TEST(Limits, RefuseWhatCannotBeExpressed) {
  EXPECT_THAT(codes_of({service("a.b", "struct S\n field double[200000]{list} x\nend\n")}),
              ElementsAre("R0902"));
}

TEST(Limits, WarnOfEachMemberThatIsLeftOut) {
  EXPECT_THAT(codes_of({service("a.b",
                                "object Foo\n pipe int32 a\n wire int32 b\n memory int32[] c\n"
                                " callback void d()\n function int32{generator} e()\n"
                                " memory int32[]{list} f\n memory int32[*]{string} g\nend\n")}),
              ElementsAre("R0904", "R0904"));
}

}  // namespace
}  // namespace robdef::cpp
