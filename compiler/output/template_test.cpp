// SPDX-License-Identifier: Apache-2.0
#include "compiler/output/template.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <vector>

namespace robdef {
namespace {

using testing::HasSubstr;

struct NoteView {
  std::string text;
};
struct ItemView {
  std::string name;
  bool is_big = false;
  std::vector<std::string> lines;
  std::optional<NoteView> note;
};
struct RootView {
  std::string title;
  NoteView about;
  std::vector<ItemView> items;
};

}  // namespace

ROBDEF_VIEW_TYPE(NoteView, text);
ROBDEF_VIEW_TYPE(ItemView, name, is_big, lines, note);
ROBDEF_VIEW_TYPE(RootView, title, about, items);

namespace {

const RootView shop{
    .title = "shop",
    .about = {"sells <things> & \"more\""},
    .items = {{.name = "cup", .is_big = false, .lines = {"a", "b"}, .note = NoteView{"fragile"}},
              {.name = "table", .is_big = true, .lines = {}, .note = std::nullopt}}};

std::string render(std::string_view text, const TemplateSources& partials = {}) {
  return Template(partials, "test", text, {&view_type<RootView>()}).render({&shop});
}

std::string message_of(std::string_view text, const TemplateSources& partials = {}) {
  try {
    (void)render(text, partials);
  } catch (const TemplateError& error) {
    return error.what();
  }
  return "no error";
}

TEST(Template, PrintsTextsWithoutEscaping) {
  EXPECT_EQ(render("{{title}}: {{about.text}}!"), "shop: sells <things> & \"more\"!");
}

TEST(Template, RepeatsASectionForEachItem) {
  EXPECT_EQ(render("{{#items}}{{name}}{{^@last}}, {{/@last}}{{/items}}"), "cup, table");
  EXPECT_EQ(render("{{#items}}{{#@first}}[{{/@first}}{{name}} {{/items}}"), "[cup table ");
}

TEST(Template, PrintsASectionForATruthATextAndAViewThatIsThere) {
  EXPECT_EQ(render("{{#items}}{{#is_big}}big {{/is_big}}{{^is_big}}small {{/is_big}}{{/items}}"),
            "small big ");
  EXPECT_EQ(render("{{#items}}{{#note}}{{text}}{{/note}}{{^note}}-{{/note}}{{/items}}"),
            "fragile-");
  EXPECT_EQ(render("{{#title}}yes{{/title}}{{^title}}no{{/title}}"), "yes");
}

TEST(Template, PrintsTheItemsOfAListOfTexts) {
  EXPECT_EQ(render("{{#items}}{{#lines}}<{{.}}>{{/lines}}{{^lines}}none{{/lines}}{{/items}}"),
            "<a><b>none");
}

TEST(Template, FindsNamesOfOuterViews) {
  EXPECT_EQ(render("{{#items}}{{title}}.{{name}} {{/items}}"), "shop.cup shop.table ");
  EXPECT_EQ(render("{{#items}}{{#lines}}{{name}}{{.}} {{/lines}}{{/items}}"), "cupa cupb ");
}

TEST(Template, DropsTheLineOfATagThatIsAloneOnIt) {
  EXPECT_EQ(render("begin\n  {{#items}}\n  {{name}};\n  {{/items}}\n{{! nothing }}\nend\n"),
            "begin\n  cup;\n  table;\nend\n");
  EXPECT_EQ(render("{{#items}}\n{{name}}\n{{/items}}"), "cup\ntable\n");
}

TEST(Template, KeepsTheLineOfAValueAndOfTwoTags) {
  EXPECT_EQ(render("  {{title}}\n{{#title}}{{/title}}\n"), "  shop\n\n");
}

TEST(Template, IndentsEachLineOfAPartialThatIsNotEmpty) {
  const TemplateSources partials{
      {"item.mustache", "{{name}} {\n\n  {{> inner}}\n}\n"},
      {"inner.mustache", "{{#lines}}\nline {{.}}\n{{/lines}}\n{{#is_big}}b{{/is_big}}end\n"}};
  EXPECT_EQ(render("all\n    {{#items}}\n    {{> item}}\n    {{/items}}\ndone\n", partials),
            "all\n    cup {\n\n      line a\n      line b\n      end\n    }\n"
            "    table {\n\n      bend\n    }\ndone\n");
}

TEST(Template, RefusesAnUnknownNameEvenWhereNothingIsPrinted) {
  EXPECT_EQ(message_of("a\n{{#items}}\n{{#lines}}\n{{nmae}}\n{{/lines}}\n{{/items}}\n"),
            "test:4: unknown name `nmae`; the view here has name is_big lines note");
  EXPECT_EQ(message_of("{{about.size}}"),
            "test:1: unknown name `about.size`; the view here has title about items");
}

TEST(Template, RefusesATruthOrListAsText) {
  EXPECT_EQ(message_of("\n\n{{items}}"), "test:3: `items` is no text");
  EXPECT_EQ(message_of("{{.}}"), "test:1: `{{.}}` outside a list of texts");
}

TEST(Template, OfThreeBracesTwoAreATag) {
  EXPECT_EQ(render("{{{title}}}"), "{shop}");
  EXPECT_EQ(render("{{{#items}}{{name}} {{/items}}};"), "{cup table };");
}

TEST(Template, BreaksLinesOfCpp) {
  const std::string argument(60, 'a');
  EXPECT_EQ(render("{{#@c++}}\n  {{title}}(" + argument + ", " + argument + ");\n{{/@c++}}\nend\n"),
            "  shop(" + argument + ",\n       " + argument + ");\nend\n");
  EXPECT_EQ(render("{{#@columns}}\n{{#items}}\n  {{name}},\n{{/items}}\n{{/@columns}}\n"),
            "  cup,\n  table,\n");
  EXPECT_THAT(message_of("a{{#@c++}}b{{/@c++}}"), HasSubstr("stands alone on its line"));
  EXPECT_THAT(message_of("{{^@columns}}\nb\n{{/@columns}}\n"), HasSubstr("stands alone"));
}

TEST(Template, RefusesUnbalancedTags) {
  EXPECT_EQ(message_of("{{#items}}\n"), "test:1: a section without its end");
  EXPECT_EQ(message_of("x\n{{/items}}"), "test:2: `{{/items}}` closes nothing");
  EXPECT_EQ(message_of("{{#items}}{{#lines}}{{/items}}{{/lines}}"),
            "test:1: `{{/items}}` closes nothing");
  EXPECT_EQ(message_of("a\nb {{title"), "test:2: `{{` without `}}`");
}

TEST(Template, NamesTheTemplateOfAFaultInAPartial) {
  EXPECT_EQ(message_of("{{> part}}", {{"part.mustache", "a\n{{b}}"}}),
            "part.mustache:2: unknown name `b`; the view here has title about items");
  EXPECT_EQ(message_of("\n{{> none}}"), "test:2: there is no partial `none`");
  EXPECT_EQ(message_of("{{> part}}", {{"part.mustache", "{{> part}}"}}),
            "part.mustache:1: a partial that contains itself");
}

TEST(Template, SeesSeveralViewsTheLastOneFirst) {
  const TemplateSources sources{{"t.mustache", "{{title}}/{{name}}"}};
  const Template both(sources, "t.mustache", {&view_type<RootView>(), &view_type<ItemView>()});
  EXPECT_EQ(both.render({&shop, &shop.items[1]}), "shop/table");
  EXPECT_THROW((void)both.render({&shop}), std::logic_error);
}

}  // namespace
}  // namespace robdef
