// SPDX-License-Identifier: Apache-2.0
// The feature definitions of conformance/ and those of TypeScript alone, what is generated from
// them, and the findings of the backend. The goldens are one output folder, as a user has it, and
// compiled.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "compiler/backends/typescript/backend.hpp"
#include "compiler/backends/typescript/view.hpp"
#include "compiler/diagnostics/golden_corpus.hpp"
#include "compiler/diagnostics/render.hpp"
#include "compiler/model/compiled.hpp"

namespace robdef::typescript {
namespace {

namespace fs = std::filesystem;

const fs::path golden_folder = ROBDEF_GOLDEN_DIR;

FileSet generated() {
  std::vector<std::string> texts;
  for (const fs::path folder : {ROBDEF_DEFINITIONS_DIR, ROBDEF_OWN_DEFINITIONS_DIR}) {
    const GoldenCorpus corpus(folder);
    for (const fs::path& input : corpus.inputs()) texts.push_back(GoldenCorpus::read(input));
  }
  const model::Compiled compiled = model::compiled(texts);
  EXPECT_TRUE(compiled.errors().empty());
  Report report;
  FileSet files = TypeScriptBackend().generate(compiled.model, {}, report);
  EXPECT_FALSE(report.has_errors());
  EXPECT_EQ(files.files().size(), compiled.model.definitions().size());
  return files;
}

TEST(TypeScriptGolden, EachFeatureGivesWhatStandsInTheGoldenFolder) {
  const GoldenCorpus corpus(ROBDEF_DEFINITIONS_DIR);
  const FileSet files = generated();
  for (const auto& [path, content] : files.files()) {
    fs::path input = golden_folder / path;
    input.replace_extension(".robdef");
    EXPECT_EQ(corpus.difference(input, ".ts", content), "");
  }
}

TEST(TypeScriptGolden, NothingElseStandsThere) {
  const FileSet files = generated();
  for (const auto& entry : fs::directory_iterator(golden_folder)) {
    EXPECT_TRUE(files.contains(entry.path().filename().string())) << entry.path();
  }
}

TEST(TypeScriptReject, EachFileGivesWhatStandsBesideIt) {
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

TEST(TypeScriptReject, EachCodeOfBackendsHasAFile) {
  const GoldenCorpus corpus(ROBDEF_REJECT_DIR);
  for (const CodeEntry& entry : code_entries()) {
    // R092x are of boards, R093x of buses.
    if (!entry.name.starts_with("R09") || entry.name.starts_with("R092") ||
        entry.name.starts_with("R093"))
      continue;
    EXPECT_TRUE(std::ranges::any_of(corpus.inputs(), [&](const fs::path& input) {
      return input.filename().string().starts_with(entry.name);
    })) << entry.name;
  }
}

}  // namespace
}  // namespace robdef::typescript
