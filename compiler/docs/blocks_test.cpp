// SPDX-License-Identifier: Apache-2.0
#include "compiler/docs/blocks.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace robdef::docs {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

TEST(Blocks, EmptyLinesSeparateParagraphs) {
  EXPECT_THAT(blocks_of("One\ngoes on.\n\n\nTwo. "),
              ElementsAre(Block{BlockKind::paragraph, {"One", "goes on."}},
                          Block{BlockKind::paragraph, {"Two."}}));
  EXPECT_THAT(blocks_of(""), IsEmpty());
  EXPECT_THAT(blocks_of(" \n\n"), IsEmpty());
}

TEST(Blocks, MarksMakeListsAndIndentedLinesContinueItems) {
  EXPECT_THAT(blocks_of("Modes:\n- off\n- on, which\n  is usual\n* too\nEnd."),
              ElementsAre(Block{BlockKind::paragraph, {"Modes:"}},
                          Block{BlockKind::bullets, {"off", "on, which is usual", "too"}},
                          Block{BlockKind::paragraph, {"End."}}));
  EXPECT_THAT(blocks_of("1. home\n2) move\n   on"),
              ElementsAre(Block{BlockKind::numbers, {"home", "move on"}}));
  EXPECT_THAT(blocks_of("1. home\n\n2. move"),
              ElementsAre(Block{BlockKind::numbers, {"home", "move"}}));
}

TEST(Blocks, WhatOnlyLooksLikeAMarkIsText) {
  EXPECT_THAT(blocks_of("-1 is off.\n2.5 is on.\n*/ is text"),
              ElementsAre(Block{BlockKind::paragraph, {"-1 is off.", "2.5 is on.", "*/ is text"}}));
}

TEST(Blocks, IndentedLinesKeepTheirBlanks) {
  EXPECT_THAT(blocks_of("Table:\n  a  1\n\n   b 2\n\nEnd."),
              ElementsAre(Block{BlockKind::paragraph, {"Table:"}},
                          Block{BlockKind::verbatim, {"  a  1", "", "   b 2"}},
                          Block{BlockKind::paragraph, {"End."}}));
}

}  // namespace
}  // namespace robdef::docs
