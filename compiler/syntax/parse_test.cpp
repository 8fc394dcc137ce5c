// SPDX-License-Identifier: Apache-2.0
#include "compiler/syntax/parse.hpp"

#include <gmock/gmock.h>

#include <chrono>
#include <string>

#include "compiler/diagnostics/golden_corpus.hpp"
#include "compiler/diagnostics/render.hpp"
#include "compiler/syntax/dump.hpp"

namespace robdef::ast {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

const fs::path corpus = ROBDEF_CORPUS_DIR;

// One text, parsed.
struct Parsed {
  explicit Parsed(std::string text, std::string name = "a.robdef") {
    const SourceId id = sources.add(std::move(name), std::move(text));
    file = parse(sources[id], id, report);
  }

  [[nodiscard]] std::string lines() const { return render(report, sources, Format::line); }
  [[nodiscard]] std::string text() const { return render(report, sources, Format::text); }
  [[nodiscard]] std::string tree() const { return dump(file, sources[file.source]); }

  [[nodiscard]] const Diagnostic* first_error() const {
    for (const Diagnostic* diagnostic : report.sorted()) {
      if (diagnostic->severity() == Severity::error) return diagnostic;
    }
    return nullptr;
  }

  Sources sources;
  Report report;
  File file;
};

Parsed parse_file(const fs::path& path) {
  return Parsed(GoldenCorpus::read(path), path.filename().string());
}

// Findings that reading alone can make; those on the meaning of names belong to the model.
bool is_found_by_reading(const Example& example) {
  return example.stage == "parse" || example.stage == "version" || example.rule.front() == 'Q';
}

std::vector<Example> all_examples() {
  std::vector<Example> examples = read_examples(corpus / "reject");
  const std::vector<Example> accepted = read_examples(corpus / "accept");
  examples.insert(examples.end(), accepted.begin(), accepted.end());
  return examples;
}

TEST(ParseExamples, WhatBreaksARuleOfReadingIsReportedByThatRule) {
  int count = 0;
  for (const Example& example : read_examples(corpus / "reject")) {
    if (example.stage != "parse" && example.stage != "version") continue;
    // A fault of other tools, which this one does not have (Q23).
    if (example.file.stem() == "P30_constant_int8_two_digits") continue;
    const Parsed parsed = parse_file(example.file);
    ASSERT_NE(parsed.first_error(), nullptr) << example.file;
    EXPECT_EQ(entry_of(parsed.first_error()->code()).rule, example.rule) << example.file << '\n'
                                                                         << parsed.text();
    ++count;
  }
  EXPECT_GE(count, 81);
}

TEST(ParseExamples, EverythingElseHasNoError) {
  int count = 0;
  for (const Example& example : all_examples()) {
    const bool is_broken = example.stage == "parse" || example.stage == "version";
    if (is_broken && example.file.stem() != "P30_constant_int8_two_digits") continue;
    EXPECT_EQ(parse_file(example.file).first_error(), nullptr) << parse_file(example.file).text();
    ++count;
  }
  EXPECT_GE(count, 180);
}

TEST(ParseExamples, FindingsAreTheExpectedText) {
  const GoldenCorpus goldens(corpus / "reject");
  for (const Example& example : all_examples()) {
    if (!is_found_by_reading(example)) continue;
    EXPECT_EQ(goldens.difference(example.file, ".stderr", parse_file(example.file).text()), "");
  }
}

// Each file holds many mistakes about one part of the language; all are found in one run.
TEST(ParseCorpus, EachMistakeIsReportedWhereItIs) {
  const GoldenCorpus goldens(corpus / "syntax");
  EXPECT_GE(goldens.inputs().size(), 13U);
  for (const fs::path& input : goldens.inputs()) {
    EXPECT_EQ(goldens.difference(input, ".stderr", parse_file(input).text()), "");
  }
}

class ParseTree : public ::testing::TestWithParam<const char*> {};

TEST_P(ParseTree, IsTheExpectedOne) {
  const fs::path input = corpus / GetParam();
  const GoldenCorpus goldens(input.parent_path());
  const std::string tree = parse_file(input).tree();
  EXPECT_EQ(goldens.difference(input, ".ast", tree), "");
}

INSTANTIATE_TEST_SUITE_P(
    Corpus, ParseTree,
    ::testing::Values("accept/A_array_forms.robdef", "accept/A_bom.robdef",
                      "accept/A_constants.robdef", "accept/A_constants_in_blocks.robdef",
                      "accept/A_containers.robdef", "accept/A_continuation.robdef",
                      "accept/A_declaration_order.robdef", "accept/A_enum.robdef",
                      "accept/A_enum_comments.robdef", "accept/A_generators.robdef",
                      "accept/A_implements.robdef", "accept/A_import_qualified.robdef",
                      "accept/A_line_endings_mixed.robdef", "accept/A_memory_forms.robdef",
                      "accept/A_minimal_service.robdef", "accept/A_modifier_unknown.robdef",
                      "accept/A_modifiers_all.robdef", "accept/A_namedarray.robdef",
                      "accept/A_no_final_newline.robdef", "accept/A_objref_forms.robdef",
                      "accept/A_old_option_constant.robdef", "accept/A_old_option_in_object.robdef",
                      "accept/A_params_blanks.robdef", "accept/A_pod.robdef",
                      "accept/A_seed2011_example1.robdef", "accept/A_stdver_four_parts.robdef",
                      "accept/A_tabs_as_blanks.robdef", "accept/A_using.robdef",
                      "accept/Q_doc_comment_continues.robdef", "syntax/blocks.robdef",
                      "syntax/documentation.robdef", "syntax/lines.robdef", "syntax/old.robdef"),
    [](const auto& parameter) {
      std::string name = fs::path(parameter.param).stem().string();
      return name;
    });

TEST(Parse, PlacesAreTrueAfterContinuationsWithAnyLineEnds) {
  for (const std::string end : {"\n", "\r\n"}) {
    const Parsed parsed("\xEF\xBB\xBFservice a" + end + "stdver \\" + end + "  0.10" + end +
                        "object O" + end + "  property double \\" + end + "    b \\" + end +
                        "   [readonly] oops" + end + "  property Nope c d" + end + "end");
    EXPECT_EQ(parsed.lines(),
              "a.robdef(7,15): error: R0126 [P24] unexpected `oops` after the modifiers\n"
              "a.robdef(8,19): error: R0124 [P22] unexpected `d` in a property\n");
    EXPECT_EQ(parsed.sources[parsed.file.source].position(parsed.file.version_span.begin),
              (Position{3, 3}));
  }
}

TEST(Parse, ALineThatCannotBeReadIsLeftOutAndTheRestIsThere) {
  const Parsed parsed(
      "service a\nstruct S\n  field double x\n  field double\n  field double z\nend\n");
  ASSERT_EQ(parsed.file.declarations.size(), 1U);
  const auto& record = std::get<Record>(parsed.file.declarations[0]);
  ASSERT_EQ(record.fields.size(), 2U);
  EXPECT_EQ(record.fields[0].name.text, "x");
  EXPECT_EQ(record.fields[1].name.text, "z");
}

TEST(Parse, AStringIsDecodedAndKnowsItsPlace) {
  const Parsed parsed("service a\nconstant string S \\\n  \"caf\\u00e9 \\\\ \\\n \"\n");
  EXPECT_EQ(parsed.lines(), "");
  const auto& constant = std::get<Constant>(parsed.file.declarations.at(0));
  const auto& literal = std::get<StringLiteral>(constant.value);
  EXPECT_EQ(literal.value, "caf\xC3\xA9 \\   ");
  EXPECT_EQ(parsed.sources[parsed.file.source].position(literal.span.begin), (Position{3, 3}));
  EXPECT_EQ(parsed.sources[parsed.file.source].position(literal.span.end), (Position{4, 3}));
}

TEST(Parse, TheVersionCountsOnlyWhenAllNumbersAreRead) {
  EXPECT_EQ(Parsed("service a\nstdver 0.10\n").file.version, (Version{{0, 10, 0, 0}}));
  EXPECT_EQ(Parsed("service a\nstdver 1.2.8\n").lines(), "");
  EXPECT_THAT(Parsed("service a\nstdver 1.2.8.1\n").lines(), HasSubstr("R0134"));
  EXPECT_THAT(Parsed("service a\nstdver 1.2.9\n").lines(), HasSubstr("R0134"));
  EXPECT_EQ(Parsed("service a\nstdver 0.9\nstruct S\n field int8 x\nend struct").lines(), "");
  EXPECT_THAT(Parsed("service a\nstdver 0.9.2\nstruct S\n field int8 x\nend struct").lines(),
              HasSubstr("R0120"));
  // Only `stdver` forbids the old block ends.
  EXPECT_EQ(
      Parsed("service a\noption version 0.9.2\nstruct S\n field int8 x\nend struct").first_error(),
      nullptr);
}

TEST(Parse, ADamagedLineIsReportedOnce) {
  const Parsed parsed("service a\nstruct S\n  field double \xE2\x82\xAC \xE2\x82\xAC\nend\n");
  EXPECT_EQ(parsed.lines(), "a.robdef(3,16): error: R0101 [L1] a character that is not ASCII\n");
}

// Time grows with the length of the text only. Each of these took minutes, or the stack, if some
// step looked back over what was read; a second is far more than they need.
TEST(Parse, LongLinesAndManyMistakesTakeLinearTime) {
  const auto repeated = [](std::string_view piece, std::size_t count) {
    std::string text;
    for (std::size_t i = 0; i < count; ++i) text += piece;
    return text;
  };
  const std::string head = "service a\nobject O\n";
  const std::string texts[] = {
      head + "function void f(" + repeated("(", 100'000),
      head + "function void f(" + repeated("int32 a,", 20'000) + "int32 b)\nend",
      head + "property double" + repeated("[", 100'000) + " a",
      head + "property double" + repeated("{list}", 30'000) + " a",
      head + "property double a [" + repeated("x(1,2),", 10'000) + "y]\nend",
      head + "property " + std::string(300'000, 'a'),
      head + "property double " + std::string(300'000, ' '),
      "service " + repeated("a.", 100'000) + "b",
      "service a\nenum E\n" + repeated("a = 1,", 5'000),
      "service a\nconstant int32[] A {" + repeated("1, ", 30'000) + "2}",
      "service a\nconstant string A \"" + repeated("\\u00e9", 20'000),
      "service a\nconstant int32 A " + std::string(300'000, '9'),
      repeated("a\\\n", 100'000),
      repeated("## a\\\n", 50'000),
      repeated("struct S\n", 3'000),
      repeated("field\n", 5'000),
      std::string(300'000, '\0'),
      std::string(300'000, '\xFF'),
      repeated("\r", 300'000),
  };
  for (const std::string& text : texts) {
    const auto start = std::chrono::steady_clock::now();
    const Parsed parsed(text);
    const std::size_t shown = parsed.text().size();
    const auto taken = std::chrono::steady_clock::now() - start;
    EXPECT_LT(taken, std::chrono::seconds(20)) << text.substr(0, 40) << ' ' << shown;
  }
}

}  // namespace
}  // namespace robdef::ast
