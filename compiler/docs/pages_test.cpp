// SPDX-License-Identifier: Apache-2.0
// What stands in pages, and what never does.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "compiler/docs/docs.hpp"
#include "compiler/docs/testing.hpp"
#include "compiler/model/compiled.hpp"

namespace robdef::docs {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::Eq;
using testing::HasSubstr;
using testing::Not;
using testing::UnorderedElementsAre;

const std::string base_text =
    "## Where things are.\nservice example.base\nstdver 0.10\n\nexception Lost\n"
    "constant double PI 3.14\nstruct Angles\n    field double pan\nend\n"
    "object Named\n    property string name [readonly]\nend\n";
const std::string arm_text =
    "service example.arm\nstdver 0.10\nimport example.base\n"
    "using example.base.Angles as Pair\nusing example.base.Named\nusing example.base.PI\n\n"
    "object Arm\n    implements Named\n    property string name [readonly]\n"
    "    property Pair{list} path\n    function Pair{generator} move(example.base.Angles "
    "to)\nend\n";

std::vector<std::string> paths_of(const std::map<std::string, std::string>& pages) {
  std::vector<std::string> paths;
  for (const auto& [path, text] : pages) paths.push_back(path);
  return paths;
}

TEST(Pages, OneForEachDefinitionAndTheIndex) {
  EXPECT_THAT(paths_of(pages_of({base_text, arm_text}, Form::html)),
              ElementsAre("example.arm.html", "example.base.html", "index.html", "search.js"));
  EXPECT_THAT(paths_of(pages_of({base_text, arm_text}, Form::markdown)),
              ElementsAre("example.arm.md", "example.base.md", "index.md"));
}

TEST(Pages, NamesThatAFileSystemCannotTellApartGetAnUnderscore) {
  EXPECT_THAT(paths_of(pages_of({"service index\nstdver 0.10\n", "service room\nstdver 0.10\n",
                                 "service Room\nstdver 0.10\n"},
                                Form::markdown)),
              ElementsAre("Room.md", "index.md", "index_.md", "room_.md"));
}

TEST(Pages, TypesAreLinksByTheNameThatTheFileHasForThem) {
  const std::string page = pages_of({base_text, arm_text}, Form::html).at("example.arm.html");
  EXPECT_THAT(page, HasSubstr("property <a href=\"example.base.html#Angles\">Pair</a>{list} "
                              "<a class=\"name\" href=\"#Arm.path\">path</a>"));
  EXPECT_THAT(page, HasSubstr("(<a href=\"example.base.html#Angles\">Pair</a> to)"));
  EXPECT_THAT(page, HasSubstr("Imports</span> <a href=\"example.base.html\">example.base</a>"));
  EXPECT_THAT(page, HasSubstr("<dt><code>Pair</code></dt><dd><code><a "
                              "href=\"example.base.html#Angles\">example.base.Angles</a>"));
  EXPECT_THAT(page, HasSubstr("<a href=\"example.base.html#PI\">example.base.PI</a>"));
}

TEST(Pages, SayWhereATypeIsUsed) {
  const std::string page = pages_of({base_text, arm_text}, Form::markdown).at("example.base.md");
  EXPECT_THAT(page, HasSubstr("Used by [example.arm.Arm.path](example.arm.md#Arm.path), "
                              "[example.arm.Arm.move](example.arm.md#Arm.move)\n"));
  EXPECT_THAT(page, HasSubstr("Implemented by [example.arm.Arm](example.arm.md#Arm)\n"));
  EXPECT_THAT(page, HasSubstr("Imported by [example.arm](example.arm.md)\n"));
}

TEST(Pages, SayFromWhichObjectAMemberComes) {
  const std::string page = pages_of({base_text, arm_text}, Form::markdown).at("example.arm.md");
  EXPECT_THAT(page, HasSubstr("Implements [Named](example.base.md#Named)\n"));
  EXPECT_THAT(page, HasSubstr("- Inherited from [Named.name](example.base.md#Named.name).\n"));
  const std::string far = page_of(
      "object A\n    property double x\nend\n"
      "object B\n    implements A\n    property double x\nend\n"
      "object C\n    implements A\n    implements B\n    property double x\nend\n",
      Form::markdown);
  EXPECT_THAT(far, HasSubstr("<b>x</b></code>\n\n  - Inherited from [A.x](#A.x).\n"));
  EXPECT_THAT(far, Not(HasSubstr("from [B.x]")));
}

TEST(Pages, ExplainModifiersForTheKindOfMember) {
  const std::string page = page_of(
      "object O\n    property double a [readonly]\n    property double b [writeonly]\n"
      "    wire double c [readonly]\n    pipe double d [writeonly]\n    property double e "
      "[nolock]\n"
      "    property double f [nolockread]\n    property double g [perclient]\n"
      "    function void h() [urgent]\n    pipe double i [unreliable]\nend\n",
      Form::markdown);
  const auto note = [&](const std::string& name) {
    const std::size_t at = page.find("\"O." + name + "\"");
    const std::size_t begin = page.find("  - ", at) + 4;
    return page.substr(begin, page.find('\n', begin) - begin);
  };
  EXPECT_EQ(note("a"), "Read-only: clients cannot write it.");
  EXPECT_EQ(note("b"), "Write-only: clients cannot read it.");
  EXPECT_EQ(note("c"), "Read-only: only the service sends values.");
  EXPECT_EQ(note("d"), "Write-only: only clients send packets.");
  EXPECT_EQ(note("e"), "No lock: other users can use it while the object is locked.");
  EXPECT_EQ(note("f"), "No lock to read: other users can read it while the object is locked.");
  EXPECT_EQ(note("g"), "Per client: each client has a value of its own.");
  EXPECT_EQ(note("h"), "Urgent: its messages may overtake others.");
  EXPECT_THAT(note("i"), HasSubstr("packets that can be lost"));
}

TEST(Pages, ExplainGenerators) {
  const std::string page = page_of(
      "object O\n    function double{generator} a(int32 n)\n"
      "    function void b(double{generator} x)\n"
      "    function double{generator} c(double{generator} x)\nend\n",
      Form::markdown);
  EXPECT_THAT(page,
              HasSubstr("function double{generator} <b>a</b>(int32 n)</code>\n\n"
                        "  - Generator: the client fetches the results one after the other."));
  EXPECT_THAT(page, HasSubstr("<b>b</b>(double{generator} x)</code>\n\n"
                              "  - Generator: the client sends the values of the last parameter"));
  EXPECT_THAT(page, HasSubstr("<b>c</b>(double{generator} x)</code>\n\n"
                              "  - Generator: for each value of the last parameter"));
}

TEST(Pages, ShowValuesSizesAndConstants) {
  const std::string page = page_of(
      "constant double ONE 1\nconstant struct BOTH {a: ONE, b: ONE}\n"
      "enum E\n    ## off | out\n    off = -0x10,\n    on\nend\n"
      "namedarray N\n    field double a\n    field double[3] b\nend\n"
      "pod P\n    field int32 a\nend\n",
      Form::markdown);
  EXPECT_THAT(page, HasSubstr("constant struct <b>BOTH</b> {a: [ONE](#ONE), b: [ONE](#ONE)}"));
  EXPECT_THAT(page, HasSubstr("<b>off</b></code> | -16 (-0x10) | off &#124; out |\n"));
  EXPECT_THAT(page, HasSubstr("<b>on</b></code> | -15 (-0xf) |  |\n"));
  EXPECT_THAT(page, HasSubstr("An item is 4 numbers of type <code>double</code>."));
  EXPECT_THAT(page, HasSubstr("An item takes at most "));
}

TEST(Pages, AreTheSameInWhateverOrderFilesAreGiven) {
  for (const Form form : {Form::html, Form::markdown}) {
    EXPECT_EQ(pages_of({base_text, arm_text}, form), pages_of({arm_text, base_text}, form));
  }
}

TEST(Pages, ADefinitionWithoutDeclarationsHasAPage) {
  EXPECT_THAT(page_of("", Form::html), HasSubstr("<p>Nothing is declared here.</p>"));
  EXPECT_THAT(pages_of({"service a\nstdver 0.10\n"}, Form::html).at("index.html"),
              HasSubstr("<p>The definitions declare no types.</p>"));
}

/// Everything that a definition can say in its own words, hostile.
const std::string hostile_words =
    R"(<script>alert(1)</script> "><img src=x onerror=alert(1)> </style></code></p> )"
    R"([a](javascript:alert(1)) ![b](http://c) | `</code><i>` ``` *d* {{e}} {% f %} <!-- &lt; ]]> ')";
const std::string hostile_lines = "## " + hostile_words + "\n##\n## - " + hostile_words +
                                  "\n##\n##   " + hostile_words +
                                  "\n##\n## # head\n## ---\n## ===\n";

std::string hostile_definition() {
  return hostile_lines + "service example.t\nstdver 0.10\n" + hostile_lines +
         "constant string S \"</script><script>alert(1)</script>\\u0000\\u202e|`]\\\"\"\n" +
         hostile_lines + "exception X\n" + hostile_lines + "enum E\n" + hostile_lines +
         "    a = 1\nend\n" + hostile_lines + "struct T\n" + hostile_lines +
         "    field double b\nend\n" + hostile_lines + "object O\n" + hostile_lines +
         "    property double c [shiny]\n" + hostile_lines + "    event constructor2()\nend\n";
}

TEST(HostilePages, HaveTheTagsOfTheTemplatesOnly) {
  const std::map<std::string, std::string> pages = pages_of({hostile_definition()}, Form::html);
  for (const std::string path : {"example.t.html", "index.html"}) {
    const HtmlPage page = read_html(pages.at(path));
    EXPECT_EQ(page.fault, "") << path;
    std::size_t scripts = 0;
    for (const Tag& tag : page.tags) {
      EXPECT_THAT(tag.name, Not(testing::AnyOf("img", "i"))) << path;
      if (tag.name == "script") ++scripts;
      for (const auto& [name, value] : tag.attributes) {
        EXPECT_FALSE(name.starts_with("on")) << path << ": " << name;
        EXPECT_EQ(value.find("javascript"), value.npos) << path;
      }
    }
    EXPECT_EQ(scripts, path == "index.html" ? 2U : 3U) << "the index, what stands in it, the code";
    EXPECT_THAT(page.text, HasSubstr("<script>alert(1)</script> \"><img src=x"));
  }
}

TEST(HostilePages, TheSearchIndexDoesNotEndItsScript) {
  const std::string index = pages_of({hostile_definition()}, Form::html).at("search.js");
  EXPECT_THAT(index, AllOf(Not(HasSubstr("<")), Not(HasSubstr(">")), Not(HasSubstr("&"))));
  EXPECT_THAT(index, HasSubstr("\\u003cscript\\u003ealert(1)"));
}

TEST(HostilePages, MarkdownHasTheTagsAndLinksOfTheTemplatesOnly) {
  const std::map<std::string, std::string> pages = pages_of({hostile_definition()}, Form::markdown);
  const MarkdownPage page = read_markdown(pages.at("example.t.md"));
  EXPECT_THAT(page.tags, UnorderedElementsAre("<!--", "<a", "</a", "<b", "</b", "<code", "</code",
                                              "<pre", "</pre", "<br"));
  for (const std::string& link : page.links) {
    EXPECT_TRUE(link == "index.md" || link.starts_with("#")) << link;
  }
  EXPECT_THAT(pages.at("example.t.md"),
              AllOf(Not(HasSubstr("{{")), Not(HasSubstr("{%")), Not(HasSubstr("\n# head")),
                    Not(HasSubstr("\n---\n")), Not(HasSubstr("\n===\n"))));
  EXPECT_THAT(read_markdown(pages.at("index.md")).tags,
              UnorderedElementsAre("<!--", "<a", "</a", "<code", "</code"));
}

TEST(HostilePages, ACellOfATableEndsWhereItShould) {
  const std::string page = pages_of({hostile_definition()}, Form::markdown).at("example.t.md");
  const std::size_t row = page.find("| <a id=\"E.a\">");
  ASSERT_NE(row, page.npos);
  const std::string line = page.substr(row, page.find('\n', row) - row);
  EXPECT_EQ(std::ranges::count(line, '|'), 4) << line;
}

// The language has no such names; pages do not count on it.
TEST(HostilePages, NamesAreEscapedToo) {
  const model::Compiled compiled =
      model::compiled_lines("struct S\n    field double a\nend\nobject O\n    property S b\nend\n");
  const std::string name = "<b>\"](x)|'`\n";
  model::Definition& definition = *compiled.model.definitions().front();
  definition.records[0].name = name;
  definition.records[0].fields[0].name = name;
  definition.objects[0].members[0].name = name;
  const FileSet html = make_pages(compiled.model, Form::html);
  const FileSet markdown = make_pages(compiled.model, Form::markdown);
  const HtmlPage page = read_html(html.files().at("example.t.html"));
  EXPECT_EQ(page.fault, "");
  EXPECT_THAT(page.all("id"), Contains(Eq(name)));
  EXPECT_THAT(page.all("href"), Contains(Eq("#%3Cb%3E%22%5D%28x%29%7C%27%60%0A")));
  const MarkdownPage text = read_markdown(markdown.files().at("example.t.md"));
  EXPECT_THAT(text.links, Not(Contains(Eq("x"))));
  EXPECT_THAT(text.links, Contains(Eq("#%3Cb%3E%22%5D%28x%29%7C%27%60%0A")));
}

TEST(HtmlPages, LoadNothingButTheIndexBesideThem) {
  for (const auto& [path, text] : pages_of({base_text, arm_text}, Form::html)) {
    if (path == "search.js") continue;
    const HtmlPage page = read_html(text);
    EXPECT_THAT(page.all("src"), ElementsAre("search.js")) << path;
    EXPECT_THAT(text, AllOf(Not(HasSubstr("://")), Not(HasSubstr("@import")),
                            Not(HasSubstr("url(")), Not(HasSubstr("<link"))))
        << path;
  }
}

TEST(HtmlPages, SearchThemselvesWithoutTheIndexBesideThem) {
  const std::string page = pages_of({base_text, arm_text}, Form::html).at("example.arm.html");
  EXPECT_THAT(page, HasSubstr("<script type=\"application/json\" id=\"_own\">"
                              "{\"page\":\"example.arm.html\",\"name\":\"example.arm\","
                              "\"entries\":[[\"definition\",\"example.arm\",\"\",\"\"],"
                              "[\"object\",\"Arm\",\"Arm\",\"\"],"
                              "[\"property\",\"Arm.name\",\"Arm.name\",\"\"]"));
}

TEST(HtmlPages, TheSearchIndexHasAllPages) {
  const std::string index = pages_of({base_text, arm_text}, Form::html).at("search.js");
  EXPECT_THAT(index, HasSubstr("[\"definition\",\"example.base\",\"\",\"Where things are.\"]"));
  EXPECT_THAT(index, HasSubstr("[\"field\",\"Angles.pan\",\"Angles.pan\",\"\"]"));
  EXPECT_THAT(index, HasSubstr("[\"function\",\"Arm.move\",\"Arm.move\",\"\"]"));
}

}  // namespace
}  // namespace robdef::docs
