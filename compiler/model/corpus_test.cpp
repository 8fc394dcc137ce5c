// SPDX-License-Identifier: Apache-2.0
// The whole compiler front against the examples of the language: each input of the corpus gives
// exactly the findings that stand beside it, an example of a rule breaks that rule and no other,
// and each code has an example.
#include <algorithm>
#include <filesystem>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/diagnostics/golden_corpus.hpp"
#include "compiler/diagnostics/render.hpp"
#include "compiler/model/check.hpp"
#include "compiler/model/dump.hpp"
#include "compiler/model/evaluate.hpp"
#include "compiler/model/layout.hpp"
#include "compiler/model/print.hpp"
#include "compiler/model/resolve.hpp"
#include "compiler/syntax/read.hpp"
#include "gtest/gtest.h"

namespace robdef::model {
namespace {

namespace fs = std::filesystem;

const fs::path& corpus_folder() {
  static const fs::path folder = ROBDEF_CORPUS_DIR;
  return folder;
}

// Inputs of both folders, those without a first line of expectations included.
struct Case {
  fs::path file;
  std::vector<fs::path> companions;
  bool is_accepted = false;
  std::string rule;
  std::string stage;
};

std::vector<Case> cases(const std::string& folder) {
  std::vector<Case> result;
  for (const Example& example : read_examples(corpus_folder() / folder)) {
    result.push_back(
        {example.file, example.companions, example.is_accepted, example.rule, example.stage});
  }
  return result;
}

std::vector<Case> all_cases() {
  std::vector<Case> result = cases("accept");
  const std::vector<Case> rejected = cases("reject");
  result.insert(result.end(), rejected.begin(), rejected.end());
  return result;
}

ast::NamedText named(const fs::path& file) {
  return {file.filename().string(), GoldenCorpus::read(file), false};
}

struct Outcome {
  Sources sources;
  Report report;
  Model model;

  [[nodiscard]] std::vector<const Diagnostic*> errors() const {
    std::vector<const Diagnostic*> all = report.sorted();
    std::erase_if(all, [](const Diagnostic* one) { return one->severity() != Severity::error; });
    return all;
  }
};

void run(std::vector<ast::NamedText> texts, bool is_strict, Outcome& outcome) {
  const ast::Program program = ast::read_texts(std::move(texts), outcome.sources, outcome.report);
  outcome.model = resolve(program, outcome.sources, outcome.report);
  evaluate(outcome.model, outcome.report);
  lay_out(outcome.model, outcome.report);
  check(outcome.model, outcome.report);
  if (is_strict) check_strictly(outcome.model, outcome.report);
}

void run(const Case& example, Outcome& outcome) {
  std::vector<ast::NamedText> texts = {named(example.file)};
  for (const fs::path& companion : example.companions) texts.push_back(named(companion));
  run(std::move(texts), example.rule == "T1", outcome);
}

// Faults of the reference that are not copied (06, section 13 and Q23).
bool is_accepted_nevertheless(const Case& example) {
  const std::string name = example.file.stem().string();
  return name == "V19_pod_same_short_name" || name == "P30_constant_int8_two_digits";
}

TEST(Corpus, EachInputGivesTheFindingsThatStandBesideIt) {
  const std::vector<Case> examples = all_cases();
  ASSERT_GT(examples.size(), 265u);
  const GoldenCorpus goldens(corpus_folder());
  for (const Case& example : examples) {
    Outcome outcome;
    run(example, outcome);
    const std::string text = render(outcome.report, outcome.sources, Format::text);
    EXPECT_EQ(goldens.difference(example.file, ".stderr", text), "");
  }
}

TEST(Corpus, WhatIsAcceptedHasNoErrors) {
  for (const Case& example : cases("accept")) {
    Outcome outcome;
    run(example, outcome);
    EXPECT_TRUE(example.is_accepted) << example.file;
    EXPECT_FALSE(outcome.report.has_errors())
        << render(outcome.report, outcome.sources, Format::line);
  }
}

TEST(Corpus, WhatIsRejectedHasOneErrorOfItsRule) {
  for (const Case& example : cases("reject")) {
    Outcome outcome;
    run(example, outcome);
    const auto errors = outcome.errors();
    if (is_accepted_nevertheless(example)) {
      EXPECT_TRUE(errors.empty()) << example.file;
      continue;
    }
    EXPECT_EQ(errors.size(), 1u) << render(outcome.report, outcome.sources, Format::line);
    if (errors.empty()) continue;
    const CodeEntry& entry = entry_of(errors.front()->code());
    EXPECT_TRUE(entry.rule == example.rule || entry.name == example.rule)
        << example.file << ' ' << entry.name << ' ' << entry.rule;
  }
}

// Examples that are about files rather than texts: they are opened, and their imports looked for.
// The first of them is not there, which is its point.
std::vector<fs::path> examples_of_reading() {
  std::vector<fs::path> files = {corpus_folder() / "read" / "R0509_missing.robdef"};
  const GoldenCorpus corpus(corpus_folder() / "read");
  for (const fs::path& file : corpus.inputs()) {
    if (file.filename().string().starts_with("R0")) files.push_back(file);
  }
  return files;
}

// Codes that an example shows: those of the rule or code in its name, or of the rule that its first
// line gives.
void collect_shown(const fs::path& file, std::string_view rule, const Report& report,
                   std::set<std::string_view>& shown) {
  const std::string name = file.filename().string();
  for (const Diagnostic* diagnostic : report.sorted()) {
    const CodeEntry& entry = entry_of(diagnostic->code());
    const bool by_rule = !entry.rule.empty() && name.starts_with(std::string(entry.rule) + '_');
    const bool by_code = name.starts_with(std::string(entry.name) + '_');
    if (by_rule || by_code || (!entry.rule.empty() && entry.rule == rule)) {
      shown.insert(entry.name);
    }
  }
}

TEST(Corpus, EachCodeHasAnExampleThatIsNamedAfterIt) {
  std::set<std::string_view> shown;
  for (const Case& example : all_cases()) {
    Outcome outcome;
    run(example, outcome);
    collect_shown(example.file, example.rule, outcome.report, shown);
  }
  for (const fs::path& file : examples_of_reading()) {
    Outcome outcome;
    ast::read({file.string()}, ast::SearchPath{}, outcome.sources, outcome.report);
    collect_shown(file, "", outcome.report, shown);
  }
  for (const CodeEntry& entry : code_entries()) {
    if (entry.name.starts_with("R07")) continue;  // two versions, shown in compiler/breaking
    if (entry.name.starts_with("R08")) continue;  // project files, shown in compiler/project
    if (entry.name.starts_with("R09")) continue;  // limits of a target, shown beside its backend
    if (entry.name.starts_with("R10")) continue;  // said by plug-ins, shown in compiler/plugin
    EXPECT_TRUE(shown.contains(entry.name)) << entry.name << ' ' << entry.rule;
  }
}

TEST(Corpus, APrintedDefinitionParsesToAnEqualModel) {
  for (const Case& example : cases("accept")) {
    Outcome outcome;
    run(example, outcome);
    std::vector<ast::NamedText> printed;
    for (const auto& definition : outcome.model.definitions()) {
      const std::string& name = outcome.sources[definition->source].name();
      printed.push_back({name, print(*definition), definition->is_import});
    }
    Outcome again;
    run(printed, false, again);
    EXPECT_FALSE(again.report.has_errors()) << example.file << '\n'
                                            << render(again.report, again.sources, Format::text);
    EXPECT_EQ(dump(outcome.model, outcome.sources, Detail::shape),
              dump(again.model, again.sources, Detail::shape))
        << example.file;
    for (std::size_t i = 0; i < printed.size(); ++i) {
      EXPECT_EQ(print(*again.model.definitions()[i]), printed[i].text) << example.file;
    }
  }
}

}  // namespace
}  // namespace robdef::model
