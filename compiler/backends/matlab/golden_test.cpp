// SPDX-License-Identifier: Apache-2.0
// Feature definitions and what is generated from them, and the findings of the backend. The goldens
// are one output folder, as a user has it, but for the stubs in client/cpp, which are the C++
// backend's. The test matlab_goldens_parse reads them all with Octave.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "compiler/backends/cpp/backend.hpp"
#include "compiler/backends/matlab/backend.hpp"
#include "compiler/backends/matlab/constants.hpp"
#include "compiler/backends/matlab/names.hpp"
#include "compiler/backends/matlab/view.hpp"
#include "compiler/diagnostics/golden_corpus.hpp"
#include "compiler/diagnostics/render.hpp"
#include "compiler/model/compiled.hpp"

namespace robdef::matlab {
namespace {

namespace fs = std::filesystem;

const fs::path golden_folder = ROBDEF_GOLDEN_DIR;

/// The features, and the words of MATLAB in each position.
model::Compiled compiled_features() {
  std::vector<std::string> texts;
  const GoldenCorpus features(ROBDEF_DEFINITIONS_DIR);
  for (const fs::path& input : features.inputs()) texts.push_back(GoldenCorpus::read(input));
  const GoldenCorpus own(ROBDEF_OWN_DEFINITIONS_DIR);
  for (const fs::path& input : own.inputs()) texts.push_back(GoldenCorpus::read(input));
  model::Compiled compiled = model::compiled(texts);
  EXPECT_TRUE(compiled.errors().empty());
  return compiled;
}

FileSet generated(const model::Compiled& compiled) {
  Report report;
  FileSet files = MatlabBackend().generate(compiled.model, {}, report);
  EXPECT_FALSE(report.has_errors());
  return files;
}

bool is_stub(const std::string& path) { return path.starts_with("client/cpp/"); }

TEST(MatlabGolden, EachFeatureGivesWhatStandsInTheGoldenFolder) {
  const GoldenCorpus corpus(ROBDEF_DEFINITIONS_DIR);
  const FileSet files = generated(compiled_features());
  ASSERT_FALSE(files.files().empty());
  for (const auto& [path, content] : files.files()) {
    if (is_stub(path)) continue;
    const fs::path file = golden_folder / path;
    fs::path input = file;
    input.replace_extension(".robdef");
    EXPECT_EQ(corpus.difference(input, file.extension().string(), content), "");
  }
}

TEST(MatlabGolden, NothingElseStandsThere) {
  const FileSet files = generated(compiled_features());
  for (const auto& entry : fs::recursive_directory_iterator(golden_folder)) {
    if (entry.is_directory()) continue;
    const std::string path = fs::relative(entry.path(), golden_folder).generic_string();
    EXPECT_TRUE(files.contains(path)) << path;
  }
}

TEST(MatlabGolden, TheStubsAreThoseOfTheCppBackend) {
  const model::Compiled compiled = compiled_features();
  const FileSet files = generated(compiled);
  Report report;
  const FileSet stubs = cpp::CppBackend().generate(compiled.model, {}, report);
  ASSERT_FALSE(stubs.files().empty());
  for (const auto& [path, content] : stubs.files()) {
    const auto found = files.files().find("client/cpp/" + path);
    ASSERT_NE(found, files.files().end()) << path;
    EXPECT_EQ(found->second, content);
  }
}

TEST(MatlabReject, EachFileGivesWhatStandsBesideIt) {
  const GoldenCorpus corpus(ROBDEF_REJECT_DIR);
  ASSERT_FALSE(corpus.inputs().empty());
  for (const fs::path& input : corpus.inputs()) {
    const model::Compiled compiled = model::compiled({GoldenCorpus::read(input)});
    Report report;
    (void)MatlabBackend().generate(compiled.model, {}, report);
    EXPECT_EQ(corpus.difference(input, ".stderr", render(report, *compiled.sources, Format::text)),
              "");
  }
}

TEST(MatlabReject, EachCodeOfBackendsHasAFile) {
  const GoldenCorpus corpus(ROBDEF_REJECT_DIR);
  for (const CodeEntry& entry : code_entries()) {
    // R092x are of boards, R093x of buses.
    if (!entry.name.starts_with("R09") || entry.name.starts_with("R092") ||
        entry.name.starts_with("R093")) {
      continue;
    }
    EXPECT_TRUE(std::ranges::any_of(corpus.inputs(), [&](const fs::path& input) {
      return input.filename().string().starts_with(entry.name);
    })) << entry.name;
  }
}

TEST(MatlabNames, APackageThatAFunctionWouldHideGetsAnUnderscore) {
  EXPECT_EQ(package_of("example.mount"), "example_.mount");
  EXPECT_EQ(folder_of("test.arm"), "+test_/+arm");
  EXPECT_EQ(package_of("experimental.test"), "experimental.test");
  EXPECT_EQ(package_of("experimental.while"), "experimental.while_");
}

TEST(MatlabNames, MembersAreNeitherKeywordsNorWhatAClassHas) {
  EXPECT_EQ(member_name("speed", "Arm"), "speed");
  EXPECT_EQ(member_name("Arm", "Arm"), "Arm_");
  EXPECT_EQ(member_name("end", "Arm"), "end_");
  EXPECT_EQ(member_name("delete", "Arm"), "delete_");
}

TEST(MatlabConstants, TextsAreWrittenWithTheirQuotesAndControlCharacters) {
  EXPECT_EQ(string_literal(""), "''");
  EXPECT_EQ(string_literal("it's"), "'it''s'");
  EXPECT_EQ(string_literal("\n"), "char(10)");
  EXPECT_EQ(string_literal("a\nb"), "['a' char(10) 'b']");
}

}  // namespace
}  // namespace robdef::matlab
