// SPDX-License-Identifier: Apache-2.0
#include "compiler/output/prose.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace robdef {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

TEST(Prose, PutsTheMarkBeforeEachLine) {
  EXPECT_THAT(prose("One.\nTwo.", "/// ", 40), ElementsAre("/// One.", "/// Two."));
  EXPECT_THAT(prose("", "/// ", 40), IsEmpty());
}

TEST(Prose, BreaksLongLinesAtBlanks) {
  EXPECT_THAT(prose("aaaa bbbb cccc dddd", "// ", 12), ElementsAre("// aaaa bbbb", "// cccc dddd"));
  EXPECT_THAT(prose("aaaa bbbb cccc", "// ", 11), ElementsAre("// aaaa", "// bbbb", "// cccc"));
}

TEST(Prose, KeepsEmptyLinesAndIndentation) {
  EXPECT_THAT(prose("List:\n\n  - aaa bbb\n", "/// ", 12),
              ElementsAre("/// List:", "///", "///   - aaa", "///   bbb"));
}

TEST(Prose, LetsALongWordStandAlone) {
  EXPECT_THAT(prose("a bbbbbbbbbbbbbbbbb c", "// ", 10),
              ElementsAre("// a", "// bbbbbbbbbbbbbbbbb", "// c"));
}

TEST(Prose, DropsBlanksAtLineEnds) {
  EXPECT_THAT(prose("a  \r\n   \nb\t", "/// ", 40), ElementsAre("/// a", "///", "/// b"));
}

}  // namespace
}  // namespace robdef
