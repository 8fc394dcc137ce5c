// SPDX-License-Identifier: Apache-2.0
#include "compiler/model/layout.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <limits>
#include <string>

#include "compiler/model/compiled.hpp"
#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace robdef::model {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

TEST(Layout, ANamedarrayCountsTheNumbersOfItsParts) {
  const Compiled result = compiled_lines(
      "namedarray Pose\nfield Vector3[2] axes\nfield Vector3 position\nfield double[4] q\nend\n"
      "namedarray Vector3\nfield double x\nfield double y\nfield double z\nend\n");
  EXPECT_THAT(result.codes(), IsEmpty());
  EXPECT_EQ(result.record("Vector3").number_count, 3u);
  EXPECT_EQ(result.record("Pose").number_count, 13u);
  EXPECT_EQ(result.record("Pose").number, Primitive::double_);
}

TEST(Layout, APodIsAsLargeAsItsLargestElement) {
  const Compiled result = compiled_lines(
      "pod Small\nfield int8 i\nend\n"
      "namedarray V\nfield single a\nfield single b\nend\n"
      "pod P\nfield double d\nfield int32[3-] a\nfield double[2,2] m\nfield Small s\n"
      "field Small[11-] t\nfield V v\nfield V[2] w\nend\n");
  EXPECT_THAT(result.codes(), IsEmpty());
  // An item: 16 and an index of up to 10 digits. A field: 16, its name, its payload.
  constexpr std::uint64_t item_of_small = 16 + 16 + 1 + 1;
  EXPECT_EQ(result.record("Small").packed_size, 10 + item_of_small);
  const std::uint64_t pod_header = 16 + 1 + std::string("example.t.Small").size();
  const std::uint64_t named_header = 16 + 1 + std::string("example.t.V").size();
  const std::uint64_t expected = 26 +                                          // item
                                 (17 + 8) +                                    // d
                                 (17 + 3 * 4) +                                // a
                                 (17 + 4 * 8) +                                // m
                                 (pod_header + item_of_small + 1) +            // s: index 0
                                 (pod_header + 11 * item_of_small + 10 + 2) +  // t: 0 to 10
                                 (named_header + 16 + 5 + 2 * 4) +             // v
                                 (named_header + 16 + 5 + 4 * 4);              // w
  EXPECT_EQ(result.record("P").packed_size, expected);
}

TEST(Layout, SizesThatDoNotFitBecomeTheLargestNumber) {
  const Compiled result = compiled_lines(
      "pod A\nfield double[2147483647,2147483647] a\nend\npod B\nfield A[2147483647] a\nend\n"
      "pod C\nfield B[2147483647] a\nend\n");
  EXPECT_THAT(result.codes(), IsEmpty());
  EXPECT_EQ(result.record("C").packed_size, std::numeric_limits<std::uint64_t>::max());
}

TEST(Layout, StructsThatReachThemselvesAreRecursive) {
  const Compiled result = compiled_lines(
      "struct List\nfield List next\nend\n"
      "struct A\nfield B{list} b\nend\nstruct B\nfield A a\nend\n"
      "struct Leaf\nfield double x\nend\nstruct Holder\nfield A a\nfield Leaf l\nend\n");
  EXPECT_THAT(result.codes(), IsEmpty());
  EXPECT_TRUE(result.record("List").is_recursive);
  EXPECT_TRUE(result.record("A").is_recursive);
  EXPECT_TRUE(result.record("B").is_recursive);
  EXPECT_FALSE(result.record("Leaf").is_recursive);
  EXPECT_FALSE(result.record("Holder").is_recursive);
}

TEST(Layout, APodMayHoldAnImportedPodOfTheSameName) {
  const Compiled result =
      compiled({"service example.t\nstdver 0.10\nimport example.base\n"
                "pod P\nfield example.base.P a\nend\n",
                "service example.base\nstdver 0.10\npod P\nfield double a\n"
                "end\n"});
  EXPECT_THAT(result.codes(), IsEmpty());
  EXPECT_GT(result.definition(0).records[0].packed_size,
            result.definition(1).records[0].packed_size);
}

TEST(Layout, APodCycleIsFoundWhereverItIsAndReportedOnce) {
  const Compiled result =
      compiled_lines("pod C\nfield A a\nend\npod A\nfield B[2] b\nend\npod B\nfield A a\nend\n");
  EXPECT_THAT(result.codes(), ElementsAre("R0402"));
  EXPECT_EQ(result.marked(0), "B[2]");
  EXPECT_EQ(result.record("A").packed_size, 0u);
}

TEST(Layout, MixedNumbersAreReportedAtEachFieldThatDiffers) {
  const Compiled result =
      compiled_lines("namedarray V\nfield double x\nfield single y\nfield int32 z\nend\n");
  EXPECT_THAT(result.codes(), ElementsAre("R0404", "R0404"));
  EXPECT_EQ(result.marked(0), "single");
  EXPECT_EQ(result.marked(1), "int32");
}

TEST(Layout, AFieldOfTheWrongFormIsNotReportedAsMixedToo) {
  const Compiled result = compiled_lines("namedarray V\nfield double x\nfield string y\nend\n");
  EXPECT_THAT(result.codes(), ElementsAre("R0403"));
}

TEST(Layout, AChainOfPodsLongerThanTheCallStackIsFine) {
  std::string lines;
  constexpr int length = 20'000;
  for (int i = 0; i + 1 < length; ++i) {
    lines += fmt::format("pod P{}\nfield P{} a\nend\n", i, i + 1);
  }
  lines += fmt::format("pod P{}\nfield double a\nend\n", length - 1);
  EXPECT_THAT(compiled_lines(lines).codes(), IsEmpty());
}

}  // namespace
}  // namespace robdef::model
