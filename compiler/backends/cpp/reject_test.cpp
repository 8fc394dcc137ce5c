// SPDX-License-Identifier: Apache-2.0
// The findings of the backend: each file of reject/ gives exactly what stands beside it.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>

#include "compiler/backends/cpp/view.hpp"
#include "compiler/diagnostics/golden_corpus.hpp"
#include "compiler/diagnostics/render.hpp"
#include "compiler/model/compiled.hpp"

namespace robdef::cpp {
namespace {

namespace fs = std::filesystem;

TEST(Reject, EachFileGivesWhatStandsBesideIt) {
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

TEST(Reject, EachCodeOfBackendsHasAFile) {
  const GoldenCorpus corpus(ROBDEF_REJECT_DIR);
  for (const CodeEntry& entry : code_entries()) {
    // R092x are of boards.
    if (!entry.name.starts_with("R09") || entry.name.starts_with("R092") ||
        entry.name.starts_with("R093"))
      continue;
    EXPECT_TRUE(std::ranges::any_of(corpus.inputs(), [&](const fs::path& input) {
      return input.filename().string().starts_with(entry.name);
    })) << entry.name;
  }
}

}  // namespace
}  // namespace robdef::cpp
