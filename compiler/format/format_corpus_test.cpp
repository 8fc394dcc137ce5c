// SPDX-License-Identifier: Apache-2.0
// What formatting promises, on each example of the language, on the published standard definitions,
// and on thousands of damaged ones: as many as the environment variable ROBDEF_FORMAT_MUTATIONS
// says, else 2,000.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "compiler/diagnostics/golden_corpus.hpp"
#include "compiler/diagnostics/mutations.hpp"
#include "compiler/format/testing.hpp"
#include "compiler/model/check.hpp"
#include "compiler/model/dump.hpp"
#include "compiler/model/evaluate.hpp"
#include "compiler/model/layout.hpp"
#include "compiler/model/resolve.hpp"
#include "compiler/syntax/read.hpp"

namespace robdef::format {
namespace {

namespace fs = std::filesystem;

// What a text says, with its documentation.
std::string meaning_of(const std::string& text) {
  Sources sources;
  Report report;
  const ast::Program program = ast::read_texts({{"input.robdef", text, false}}, sources, report);
  model::Model model = model::resolve(program, sources, report);
  model::evaluate(model, report);
  model::lay_out(model, report);
  return model::dump(model, sources, model::Detail::documented);
}

// Empty when all promises are kept.
std::string broken_promise(const testing::Formatted& read) {
  std::string fault = testing::fault_of_formatting(read);
  if (!fault.empty()) return fault;
  return meaning_of(read.result) == meaning_of(read.text) ? "" : "it means something else";
}

std::string broken_promise(const fs::path& file) {
  return broken_promise(testing::Formatted(GoldenCorpus::read(file)));
}

std::vector<fs::path> definitions_in(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.is_regular_file() && entry.path().extension() == ".robdef") {
      files.push_back(entry.path());
    }
  }
  std::sort(files.begin(), files.end());
  return files;
}

void expect_promises(const fs::path& folder, std::size_t least) {
  const std::vector<fs::path> files = definitions_in(folder);
  EXPECT_GE(files.size(), least);
  for (const fs::path& file : files) {
    EXPECT_EQ(broken_promise(file), "") << file;
  }
}

TEST(FormatCorpus, AcceptedExamples) {
  expect_promises(fs::path(ROBDEF_CORPUS_DIR) / "accept", 95);
}

TEST(FormatCorpus, RejectedExamples) {
  expect_promises(fs::path(ROBDEF_CORPUS_DIR) / "reject", 170);
}

TEST(FormatCorpus, ExamplesWithManyMistakes) {
  expect_promises(fs::path(ROBDEF_CORPUS_DIR) / "syntax", 1);
}

// The published definitions where they are, else the accepted examples.
std::vector<fs::path> usual_definitions() {
  const char* const folder = std::getenv("ROBDEF_STANDARD_DIR");
  return definitions_in(folder != nullptr ? fs::path(folder)
                                          : fs::path(ROBDEF_CORPUS_DIR) / "accept");
}

TEST(FormatCorpus, UsualDefinitions) {
  const std::vector<fs::path> files = usual_definitions();
  ASSERT_GE(files.size(), 47U);
  for (const fs::path& file : files) {
    EXPECT_EQ(broken_promise(file), "") << file;
  }
}

constexpr std::uint64_t runs = 20;

std::uint64_t mutations_of_a_run() {
  const char* const wanted = std::getenv("ROBDEF_FORMAT_MUTATIONS");
  return std::max<std::uint64_t>(wanted != nullptr ? std::strtoull(wanted, nullptr, 10) : 2'000,
                                 runs) /
         runs;
}

class FormatMutations : public ::testing::TestWithParam<std::uint64_t> {};

TEST_P(FormatMutations, KeepThePromises) {
  const std::uint64_t count = mutations_of_a_run();
  std::vector<std::string> texts;
  for (const fs::path& file : usual_definitions()) texts.push_back(GoldenCorpus::read(file));
  std::size_t changed = 0;
  for (std::uint64_t seed = GetParam() * count; seed < (GetParam() + 1) * count; ++seed) {
    const testing::Formatted read(mutated(texts[seed % texts.size()], seed));
    changed += read.result != read.text ? 1 : 0;
    ASSERT_EQ(broken_promise(read), "") << "seed " << seed << '\n' << read.text;
  }
  EXPECT_GT(changed, count / 2);
}

INSTANTIATE_TEST_SUITE_P(Runs, FormatMutations, ::testing::Range<std::uint64_t>(0, runs));

}  // namespace
}  // namespace robdef::format
