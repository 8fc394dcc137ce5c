// SPDX-License-Identifier: Apache-2.0
#include "rr/printable.hpp"

#include <gtest/gtest.h>

#include <string>

namespace rr {
namespace {

TEST(Printable, LeavesTextAsItIs) {
  EXPECT_EQ(printable("the arm moves, 100 % \\ `a`"), "the arm moves, 100 % \\ `a`");
  EXPECT_EQ(printable("Gr\u00fc\u00dfe \u673a\u5668\u4eba \U0001F916"),
            "Gr\u00fc\u00dfe \u673a\u5668\u4eba \U0001F916");
  EXPECT_EQ(printable(""), "");
}

TEST(Printable, EscapesControlCharactersAndWithThemEscapeSequences) {
  EXPECT_EQ(printable("\x1b]0;OWNED\x07\x1b[2J"), "\\x1b]0;OWNED\\x07\\x1b[2J");
  EXPECT_EQ(printable("a\nb\tc\rd\x7f"), "a\\nb\\tc\\rd\\x7f");
  EXPECT_EQ(printable(std::string_view("\0x", 2)), "\\x00x");
  EXPECT_EQ(printable("\u009b31m"), "\\u{009b}31m") << "the control characters above 127";
}

TEST(Printable, EscapesWhatTurnsTheDirectionOfWritingOrTakesNoRoom) {
  EXPECT_EQ(printable("\u202edrawrof\u2066\u200f\u061c"),
            "\\u{202e}drawrof\\u{2066}\\u{200f}\\u{061c}");
  EXPECT_EQ(printable("a\u200bb\ufeffc\u2028d"), "a\\u{200b}b\\u{feff}c\\u{2028}d");
  EXPECT_EQ(printable("\U000E0041"), "\\u{e0041}");
}

TEST(Printable, EscapesBytesThatAreNoUtf8) {
  EXPECT_EQ(printable("\xff\xfe"), "\\xff\\xfe");
  EXPECT_EQ(printable("\xc0\x9b"), "\\xc0\\x9b") << "overlong";
  EXPECT_EQ(printable("\xe0\x80\x9b"), "\\xe0\\x80\\x9b") << "overlong";
  EXPECT_EQ(printable("\xed\xa0\x80"), "\\xed\\xa0\\x80") << "half of a pair of UTF-16";
  EXPECT_EQ(printable("\xf4\x90\x80\x80"), "\\xf4\\x90\\x80\\x80") << "beyond Unicode";
  EXPECT_EQ(printable("caf\xc3"), "caf\\xc3") << "cut";
  EXPECT_EQ(printable("\x9b"
                      "31m"),
            "\\x9b"
            "31m")
      << "a control character of eight bits";
}

TEST(Printable, CutsWhatIsTooLongAtAWholeCharacter) {
  EXPECT_EQ(printable("0123456789", 10), "0123456789");
  EXPECT_EQ(printable("0123456789a", 10), "0123456...");
  EXPECT_EQ(printable("01234\u00fc\u00fc\u00fc", 10), "01234\u00fc...");
  EXPECT_EQ(printable(std::string(100, '\x1b'), 10), "\\x1b...");
  EXPECT_LE(printable(std::string(8'000'000, 'x')).size(), printable_limit);
  EXPECT_EQ(printable(std::string(5000, 'x'), printable_whole).size(), 5000U);
}

TEST(Printable, KeepsTheLinesOfATextThatHasSome) {
  EXPECT_EQ(printable("a\n\tb\r\nc\rd\x1b", printable_whole, LineBreaks::kept),
            "a\n\tb\r\nc\\rd\\x1b");
}

TEST(Printable, LeavesJsonWhatItIs) {
  EXPECT_EQ(printable_json(R"({"a": "b\u001b\n"})"), R"({"a": "b\u001b\n"})");
  EXPECT_EQ(printable_json("[\"\u009b31m\u202e \u00fc\"]\n"), "[\"\\u009b31m\\u202e \u00fc\"]\n");
  EXPECT_EQ(printable_json("\"\U000E0041\x7f\""), "\"\\udb40\\udc41\\u007f\"");
  EXPECT_EQ(printable_json("\"\xc0\""), "\"\ufffd\"");
}

TEST(Printable, IsTheSameWhenMadePrintableAgain) {
  std::string all;
  for (int i = 0; i < 256; ++i) all += static_cast<char>(i);
  const std::string once = printable(all, printable_whole);
  EXPECT_EQ(printable(once, printable_whole), once);
  EXPECT_EQ(once.find_first_of(std::string("\x1b\n\r\t\x7f\0", 6)), std::string::npos);
}

}  // namespace
}  // namespace rr
