// SPDX-License-Identifier: Apache-2.0
#include "compiler/lsp/text.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "compiler/lsp/uri.hpp"
#include "compiler/lsp/words.hpp"
#include "compiler/syntax/words.hpp"

namespace robdef::lsp {
namespace {

constexpr Encoding u16 = Encoding::utf16;
constexpr Encoding u8 = Encoding::utf8;

// A letter of two bytes, one of three, and one of four that is a surrogate pair.
const std::string mixed = "# \xC3\xA9\xE2\x82\xAC\xF0\x9F\xA4\x96z\nend\n";

TEST(Text, CountsSurrogatePairsAsTwo) {
  const Text text(mixed);
  EXPECT_EQ(text.offset({0, 2}, u16), 2);
  EXPECT_EQ(text.offset({0, 3}, u16), 4);
  EXPECT_EQ(text.offset({0, 4}, u16), 7);
  EXPECT_EQ(text.offset({0, 5}, u16), 7) << "within the pair";
  EXPECT_EQ(text.offset({0, 6}, u16), 11);
  EXPECT_EQ(text.place(11, u16), (Place{0, 6}));
  EXPECT_EQ(text.place(12, u16), (Place{0, 7}));
  EXPECT_EQ(text.place(13, u16), (Place{1, 0}));
}

TEST(Text, CountsBytesWhereUtf8IsAgreed) {
  const Text text(mixed);
  EXPECT_EQ(text.offset({0, 7}, u8), 7);
  EXPECT_EQ(text.offset({0, 9}, u8), 7) << "within a character";
  EXPECT_EQ(text.place(12, u8), (Place{0, 12}));
}

TEST(Text, AllLineEndsEndLines) {
  const Text text("a\r\nb\rc\n\nd");
  EXPECT_EQ(text.line_count(), 5);
  EXPECT_EQ(text.line(0), "a");
  EXPECT_EQ(text.line(1), "b");
  EXPECT_EQ(text.line(2), "c");
  EXPECT_EQ(text.line(3), "");
  EXPECT_EQ(text.line(4), "d");
  EXPECT_EQ(text.offset({0, 99}, u16), 1) << "before the line end";
  EXPECT_EQ(text.offset({99, 0}, u16), 9);
  EXPECT_EQ(text.place(2, u16), (Place{0, 1})) << "between CR and LF";
}

TEST(Text, AByteOrderMarkIsNoCharacter) {
  const Text text("\xEF\xBB\xBFservice a\n");
  EXPECT_EQ(text.offset({0, 0}, u16), 3);
  EXPECT_EQ(text.place(3, u16), (Place{0, 0}));
  EXPECT_EQ(text.line(0), "service a");
}

TEST(Text, BytesThatAreNotUtf8CountAsOne) {
  const Text text("\xFF\xC3z");
  EXPECT_EQ(text.offset({0, 2}, u16), 2);
  EXPECT_EQ(text.place(3, u16), (Place{0, 3}));
}

// Of a long line not every place is counted from the begin of the line.
TEST(Text, PlacesOfALongLineAreThoseOfItsCharacters) {
  std::string line;
  while (line.size() < 10'000) line += "abc\xC3\xA9\xE2\x82\xAC\xF0\x9F\xA4\x96\xFF";
  Text text("first\n" + line + "\nlast");
  for (const Encoding encoding : {u16, u8}) {
    std::uint32_t units = 0;
    for (std::uint32_t at = 0; at < line.size();) {
      ASSERT_EQ(text.place(6 + at, encoding), (Place{1, units}));
      ASSERT_EQ(text.offset({1, units}, encoding), 6 + at);
      const char first = line[at];
      const std::uint32_t size = first == '\xC3'   ? 2
                                 : first == '\xE2' ? 3
                                 : first == '\xF0' ? 4
                                                   : 1;
      at += size;
      units += encoding == u8 ? size : size == 4 ? 2 : 1;
    }
    EXPECT_EQ(text.offset({1, units + 9}, encoding), 6 + line.size());
  }
  text.replace({{1, 0}, {1, 3}}, "", u16);
  EXPECT_EQ(text.place(6 + 2000, u16).line, 1U);
  EXPECT_EQ(text.offset(text.place(6 + 1997 - 1997 % 13, u16), u16), 6 + 1997 - 1997 % 13);
}

TEST(Text, ReplacesRanges) {
  Text text("one\r\ntwo\r\n");
  text.replace({{0, 3}, {1, 0}}, "", u16);
  EXPECT_EQ(text.bytes(), "onetwo\r\n");
  text.replace({{0, 0}, {0, 3}}, "x\ny", u16);
  EXPECT_EQ(text.bytes(), "x\nytwo\r\n");
  EXPECT_EQ(text.line(1), "ytwo");
  EXPECT_THROW(text.replace({{1, 1}, {0, 0}}, "", u16), RequestError);
}

TEST(Uri, PathsGoThereAndBack) {
  EXPECT_EQ(path_of("file:///a%20b/%C3%A9.robdef"), "/a b/\xC3\xA9.robdef");
  EXPECT_EQ(uri_of("/a b/\xC3\xA9.robdef"), "file:///a%20b/%C3%A9.robdef");
  EXPECT_EQ(path_of("file:///a%zz%4"), "/a%zz%4");
  EXPECT_EQ(path_of("untitled:one"), "untitled:one");
  EXPECT_EQ(uri_of("untitled:one"), "untitled:one");
}

TEST(Words, AreThoseOfTheLanguage) {
  const auto words = [](std::span<const WordHelp> helps) {
    std::vector<std::string_view> all;
    for (const WordHelp& one : helps) all.push_back(one.word);
    return all;
  };
  EXPECT_THAT(words(keyword_helps()),
              ::testing::UnorderedElementsAreArray(syntax::keyword_texts()));
  EXPECT_THAT(words(modifier_helps()),
              ::testing::UnorderedElementsAreArray(syntax::modifier_words()));
  for (const WordHelp& one : type_helps()) EXPECT_TRUE(syntax::is_built_in_type(one.word));
}

}  // namespace
}  // namespace robdef::lsp
