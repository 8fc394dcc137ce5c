// SPDX-License-Identifier: Apache-2.0
// What is generated for definitions/, and the findings for reject/. The bench of runtime/cbus
// compiles the same files.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "compiler/backends/cbus/backend.hpp"
#include "compiler/backends/cbus/view.hpp"
#include "compiler/diagnostics/golden_corpus.hpp"
#include "compiler/diagnostics/render.hpp"
#include "compiler/model/compiled.hpp"

namespace robdef::cbus {
namespace {

namespace fs = std::filesystem;

FileSet generated() {
  std::vector<std::string> texts;
  const GoldenCorpus corpus(ROBDEF_DEFINITIONS_DIR);
  for (const fs::path& input : corpus.inputs()) texts.push_back(GoldenCorpus::read(input));
  const model::Compiled compiled = model::compiled(texts);
  EXPECT_THAT(compiled.errors(), testing::IsEmpty());
  Report report;
  FileSet files = CBusBackend().generate(compiled.model, {}, report);
  EXPECT_FALSE(report.has_errors());
  return files;
}

TEST(CBusGolden, EachDefinitionGivesWhatStandsInTheGoldenFolder) {
  const GoldenCorpus corpus(ROBDEF_DEFINITIONS_DIR);
  const FileSet files = generated();
  EXPECT_EQ(files.files().size(), 3U * 2 + 4) << "three for each definition, one for each pod";
  for (const auto& [path, content] : files.files()) {
    fs::path input = fs::path(ROBDEF_GOLDEN_DIR) / path;
    const std::string ending = input.extension().string();
    input.replace_extension(".robdef");
    EXPECT_EQ(corpus.difference(input, ending, content), "");
  }
}

TEST(CBusGolden, NothingElseStandsThere) {
  const FileSet files = generated();
  for (const auto& entry : fs::directory_iterator(ROBDEF_GOLDEN_DIR)) {
    EXPECT_TRUE(files.contains(entry.path().filename().string())) << entry.path();
  }
}

TEST(CBusReject, EachFileGivesWhatStandsBesideIt) {
  const GoldenCorpus corpus(ROBDEF_REJECT_DIR);
  ASSERT_FALSE(corpus.inputs().empty());
  for (const fs::path& input : corpus.inputs()) {
    const model::Compiled compiled = model::compiled({GoldenCorpus::read(input)});
    Report report;
    (void)make_view(compiled.model, report);
    EXPECT_EQ(corpus.difference(input, ".stderr", render(report, *compiled.sources, Format::text)),
              "");
  }
}

TEST(CBusReject, EachCodeOfBusesHasAFile) {
  const GoldenCorpus corpus(ROBDEF_REJECT_DIR);
  for (const CodeEntry& entry : code_entries()) {
    if (!entry.name.starts_with("R093")) continue;
    EXPECT_TRUE(std::ranges::any_of(corpus.inputs(), [&](const fs::path& input) {
      return input.filename().string().starts_with(entry.name);
    })) << entry.name;
  }
}

TEST(CBusReject, TwoServicesThatBecomeOneNameCollide) {
  const model::Compiled compiled =
      model::compiled({"service a.b\npod c_D\n field double x\nend\n",
                       "service a.b.c\npod D\n field double x\nend\n"});
  Report report;
  (void)make_view(compiled.model, report);
  EXPECT_TRUE(report.has_errors());
}

}  // namespace
}  // namespace robdef::cbus
