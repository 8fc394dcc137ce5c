// SPDX-License-Identifier: Apache-2.0
#include "compiler/breaking/render.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "compiler/breaking/testing.hpp"

namespace robdef::breaking {
namespace {

using testing::Compared;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::StartsWith;
using testing::with_root;

const std::string before = with_root("constant int32 A 1", "property double p\nproperty double q");
const std::string now = with_root("constant int32 A 2", "property double p [readonly]");

bool all_are_files(SourceId source) {
  static_cast<void>(source);
  return true;
}

TEST(BreakingText, HasEachChangeAndTheirNumber) {
  const Compared compared({before}, {now});
  const std::string text = to_text(compared.changes, compared.sources);
  EXPECT_THAT(text,
              StartsWith("warning[R0773]: constant `x.t.A` is 2, it was 1\n --> new.robdef:3:16"));
  EXPECT_THAT(text, HasSubstr("error[R0703]: property `Root.q` is gone\n"));
  EXPECT_THAT(text, HasSubstr(" ::: old.robdef:6:17\n"));
  EXPECT_THAT(text, EndsWith("\n\n3 breaking changes\n"));
  EXPECT_EQ(to_text(Changes(), compared.sources), "");
}

TEST(BreakingJson, HasAVersionAndBothPlaces) {
  const Compared compared({before}, {now}, {{Category::source}, {Code::R0703}});
  EXPECT_EQ(to_json(compared.changes, compared.sources, "old", "HEAD:new"), R"({
  "breaking_version": 1,
  "old": "old",
  "new": "HEAD:new",
  "changes": [
    {
      "code": "R0720",
      "categories": [
        "wire",
        "source"
      ],
      "severity": "error",
      "message": "property `Root.p` is `readonly`, which it was not",
      "old": {
        "file": "old.robdef",
        "line": 5,
        "column": 17,
        "end": {
          "line": 5,
          "column": 18
        }
      },
      "new": {
        "file": "new.robdef",
        "line": 5,
        "column": 17,
        "end": {
          "line": 5,
          "column": 18
        }
      },
      "effect": "old clients are refused, or what they send is dropped",
      "help": []
    }
  ],
  "count": 1,
  "omitted": 0
}
)");
}

TEST(BreakingJson, OfNothingIsADocumentToo) {
  EXPECT_THAT(to_json(Changes(), Sources(), "a", "b"),
              HasSubstr("\"changes\": [],\n  \"count\": 0"));
}

TEST(BreakingGitHub, IsACommandForEachChange) {
  const Compared compared({before}, {now}, {{Category::source}, {Code::R0703}});
  EXPECT_EQ(
      to_github(compared.changes, compared.sources, all_are_files),
      "::error file=new.robdef,line=5,endLine=5,col=17,endColumn=18,title=R0720 a member that "
      "can no longer be read or written::property `Root.p` is `readonly`, which it was not%0A"
      "wire, source: old clients are refused, or what they send is dropped%0A"
      "old: old.robdef:5:17%0Anew: new.robdef:5:17\n");
}

TEST(BreakingGitHub, NamesNoFileThatIsNotThere) {
  const Compared compared({before}, {now}, {{Category::behaviour}, {}});
  EXPECT_THAT(to_github(compared.changes, compared.sources, [](SourceId) { return false; }),
              StartsWith("::warning title=R0773 a constant with another value::constant `x.t.A`"));
}

TEST(BreakingGitHub, EscapesWhatWouldEndACommand) {
  Sources sources;
  const SourceId id = sources.add("a,b:%\n.robdef", "service x\n");
  Changes changes;
  changes.add(Code::R0701, {id, 0, 7}, Span{id, 0, 7}, "100%\r\n::error::no");
  const std::string text = to_github(changes, sources, all_are_files);
  EXPECT_THAT(text, StartsWith("::error file=a%2Cb%3A%25%0A.robdef,line=1,"));
  EXPECT_THAT(text, HasSubstr("::100%25%0D%0A::error::no%0A"));
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1);
}

TEST(BreakingRules, AreOfTheirRangeAndAsSevereAsTheirCategories) {
  std::size_t listed = 0;
  for (const CodeEntry& entry : code_entries()) {
    const bool is_of_range = entry.name.starts_with("R07");
    const Rule* const rule = find_rule(entry.code);
    EXPECT_EQ(rule != nullptr, is_of_range) << entry.name;
    if (rule == nullptr) continue;
    ++listed;
    EXPECT_FALSE(rule->categories.is_empty()) << entry.name;
    const bool is_error = rule->categories.meets({Category::wire, Category::source});
    EXPECT_EQ(entry.severity == Severity::error, is_error) << entry.name;
    EXPECT_FALSE(rule->effect.empty() || rule->effect.ends_with('.')) << entry.name;
  }
  EXPECT_EQ(listed, rules().size());
}

TEST(BreakingRules, CategoriesHaveNames) {
  for (const Category category : all_categories) {
    EXPECT_EQ(category_of(name_of(category)), category);
  }
  EXPECT_EQ(category_of("wires"), std::nullopt);
  EXPECT_EQ(Categories::all().text(), "wire, source, behaviour");
}

// The table of rules in docs/reference/breaking.md.
std::string table() {
  std::string text;
  for (const Rule& rule : rules()) {
    const CodeEntry& entry = entry_of(rule.code);
    text += "| " + std::string(entry.name) + " | " + rule.categories.text() + " | " +
            std::string(entry.summary) + " | " + std::string(rule.effect) + " |\n";
  }
  return text;
}

TEST(BreakingRules, StandInThePageAsTheyAre) {
  std::ifstream file(ROBDEF_BREAKING_PAGE, std::ios::binary);
  const std::string page{std::istreambuf_iterator<char>(file), {}};
  std::string rows;
  for (std::size_t at = page.find("| R07"); at != std::string::npos;
       at = page.find("| R07", at + 1)) {
    rows += page.substr(at, page.find('\n', at) + 1 - at);
  }
  EXPECT_EQ(rows, table());
}

}  // namespace
}  // namespace robdef::breaking
