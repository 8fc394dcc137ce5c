// SPDX-License-Identifier: Apache-2.0
#include "compiler/docs/markup.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace robdef::docs {
namespace {

using testing::ElementsAre;

const Markup& html = markup_of(Form::html);
const Markup& markdown = markup_of(Form::markdown);

TEST(HtmlMarkup, EscapesWhatEndsTextOrAttribute) {
  EXPECT_EQ(html.text("<script>\"a\" & 'b'</script>"),
            "&lt;script&gt;&quot;a&quot; &amp; &#39;b&#39;&lt;/script&gt;");
  EXPECT_EQ(html.text("&lt;"), "&amp;lt;");
}

TEST(HtmlMarkup, ControlCharactersAndOtherBytesBecomeOneSign) {
  EXPECT_EQ(html.text(std::string_view("a\0b\x1b\x7f\xff\tc\n", 9)),
            "a\uFFFDb\uFFFD\uFFFD\uFFFD\tc\n");
}

TEST(HtmlMarkup, PartsInBackquotesAreCode) {
  EXPECT_EQ(html.prose("set `a<b` or `c`"), "set <code>a&lt;b</code> or <code>c</code>");
  EXPECT_EQ(html.prose("one ` and `` two"), "one <code> and </code>` two");
  EXPECT_EQ(html.prose("a lone ` sign"), "a lone ` sign");
}

TEST(HtmlMarkup, BlocksBecomeParagraphsListsAndVerbatimLines) {
  EXPECT_THAT(
      html.lines(blocks_of("a\nb\n- c\n- <d>\n\n  e\n   f\n")),
      ElementsAre("<p>a b</p>", "<ul><li>c</li><li>&lt;d&gt;</li></ul>", "<pre>  e\n   f</pre>"));
  EXPECT_THAT(html.lines(blocks_of("1. c")), ElementsAre("<ol><li>c</li></ol>"));
}

TEST(HtmlMarkup, AddressesOfLinksAreEscaped) {
  EXPECT_EQ(html.link("a", "x\"onclick=\"y"), "<a href=\"x&quot;onclick=&quot;y\">a</a>");
}

TEST(MarkdownMarkup, EscapesWhatHasAMeaning) {
  EXPECT_EQ(markdown.text("[a](javascript:b) *c* `d` ~e~ # \\"),
            "\\[a\\](javascript:b) \\*c\\* \\`d\\` \\~e\\~ \\# \\\\");
  EXPECT_EQ(markdown.text("<b>&amp;</b> \"it's\""), "&lt;b&gt;&amp;amp;&lt;/b&gt; \"it's\"");
  EXPECT_EQ(markdown.text("a|b $c$ {{d}} {% e %} {f}"),
            "a&#124;b &#36;c&#36; &#123;{d}} &#123;% e %} {f}");
}

TEST(MarkdownMarkup, UnderscoresInsideOfNamesStay) {
  EXPECT_EQ(markdown.text("move_to _this_ __"), "move_to \\_this\\_ \\_\\_");
}

TEST(MarkdownMarkup, MarksAtTheBeginOfALineAreText) {
  EXPECT_EQ(markdown.text("- a - b\n+ c\n--- \n==\n12. d 1.5\n3) e"),
            "\\- a - b\n\\+ c\n\\-\\-\\- \n\\=\\=\n12\\. d 1.5\n3\\) e");
}

TEST(MarkdownMarkup, ControlCharactersBecomeOneSign) {
  EXPECT_EQ(markdown.text(std::string_view("a\0\x1b\tb", 5)), "a\uFFFD\uFFFD b");
}

TEST(MarkdownMarkup, BlocksHaveEmptyLinesBetweenThem) {
  EXPECT_THAT(markdown.lines(blocks_of("a\n# b\n- c\n- d\n\n  <e>\n\n  {{f}} [g]\n")),
              ElementsAre("a", "\\# b", "", "- c", "- d", "", "<pre>  &lt;e&gt;", "",
                          "  &#123;&#123;f}} &#91;g&#93;</pre>"));
}

TEST(MarkdownMarkup, ACellHasNoLineEnds) {
  EXPECT_EQ(markdown.one_line(blocks_of("a | b\nc\n\n- d\n- e\n\n  f\n")),
            "a &#124; b c<br>\u2022 d<br>\u2022 e<br><code>  f</code>");
}

}  // namespace
}  // namespace robdef::docs
