// SPDX-License-Identifier: Apache-2.0
#include "compiler/diagnostics/source.hpp"

#include <gtest/gtest.h>

namespace robdef {
namespace {

TEST(Source, LinesAndColumnsCountFromOne) {
  const Source source("a", "one\ntwo\n");
  EXPECT_EQ(source.position(0), (Position{1, 1}));
  EXPECT_EQ(source.position(3), (Position{1, 4}));
  EXPECT_EQ(source.position(4), (Position{2, 1}));
  EXPECT_EQ(source.position(8), (Position{3, 1}));
}

TEST(Source, LinesComeWithoutTheirEnds) {
  const Source source("a", "one\r\ntwo\r\r\nthree");
  EXPECT_EQ(source.line(1), "one");
  EXPECT_EQ(source.line(2), "two");
  EXPECT_EQ(source.line(3), "three");
  EXPECT_EQ(source.line(0), "");
  EXPECT_EQ(source.line(4), "");
  EXPECT_EQ(source.line_count(), 3U);
}

TEST(Source, AByteOrderMarkIsKeptAndNotCounted) {
  const Source source("a", "\xEF\xBB\xBFone\ntwo");
  EXPECT_EQ(source.text().size(), 10U);
  EXPECT_EQ(source.line(1), "one");
  EXPECT_EQ(source.position(0), (Position{1, 1}));
  EXPECT_EQ(source.position(3), (Position{1, 1}));
  EXPECT_EQ(source.position(5), (Position{1, 3}));
  EXPECT_EQ(source.position(7), (Position{2, 1}));
}

TEST(Source, AnEmptyTextHasOneEmptyLine) {
  const Source source("a", "");
  EXPECT_EQ(source.line_count(), 1U);
  EXPECT_EQ(source.line(1), "");
  EXPECT_EQ(source.position(0), (Position{1, 1}));
}

TEST(Sources, ReferencesStayValidWhileFilesAreAdded) {
  Sources sources;
  const SourceId first = sources.add("first", "x");
  const Source& reference = sources[first];
  for (int i = 0; i < 1000; ++i) sources.add("more", "y");
  EXPECT_EQ(&sources[first], &reference);
  EXPECT_EQ(reference.name(), "first");
  EXPECT_EQ(sources.size(), 1001U);
}

}  // namespace
}  // namespace robdef
