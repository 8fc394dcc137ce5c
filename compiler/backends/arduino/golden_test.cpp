// SPDX-License-Identifier: Apache-2.0
// What is generated for definitions/. The bench compiles the same files for a board.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "compiler/backends/arduino/backend.hpp"
#include "compiler/diagnostics/golden_corpus.hpp"
#include "compiler/model/compiled.hpp"

namespace robdef::arduino {
namespace {

namespace fs = std::filesystem;

model::Compiled all_definitions() {
  std::vector<std::string> texts;
  const GoldenCorpus corpus(ROBDEF_DEFINITIONS_DIR);
  for (const fs::path& input : corpus.inputs()) texts.push_back(GoldenCorpus::read(input));
  return model::compiled(texts);
}

TEST(BoardGolden, EachDefinitionGivesWhatStandsInTheGoldenFolder) {
  const model::Compiled compiled = all_definitions();
  ASSERT_THAT(compiled.errors(), testing::IsEmpty());
  Report report;
  const FileSet files = ArduinoBackend().generate(compiled.model, {}, report);
  EXPECT_FALSE(report.has_errors());
  EXPECT_EQ(files.files().size(), 10U) << "header and sketch, but none for types alone";
  const GoldenCorpus corpus(ROBDEF_DEFINITIONS_DIR);
  for (const auto& [path, content] : files.files()) {
    fs::path input = fs::path(ROBDEF_GOLDEN_DIR) / path;
    const std::string ending = input.extension().string();
    input.replace_extension(".robdef");
    EXPECT_EQ(corpus.difference(input, ending, content), "");
  }
}

TEST(BoardGolden, ASketchIsWrittenOnce) {
  const model::Compiled compiled = model::compiled_lines("object Foo\n property double x\nend\n");
  Report report;
  const FileSet files = ArduinoBackend().generate(compiled.model, {}, report);
  const fs::path folder = fs::temp_directory_path() / "robdef_board_sketch_is_written_once";
  fs::remove_all(folder);
  const std::vector<std::string> both{"example_t/example_t.h", "example_t/example_t.ino"};
  EXPECT_EQ(files.write(folder).changed, both);
  std::ofstream(folder / both[0]) << "edited";
  std::ofstream(folder / both[1]) << "edited";
  EXPECT_EQ(files.write(folder).changed, std::vector{both[0]});
  EXPECT_EQ(GoldenCorpus::read(folder / both[1]), "edited");
  fs::remove_all(folder);
}

TEST(BoardGolden, TheUserIsToldWhatTheSketchTakes) {
  const model::Compiled compiled = model::compiled_lines("object Foo\nend\n");
  Report report;
  const FileSet files = ArduinoBackend().generate(compiled.model, {}, report);
  ASSERT_EQ(files.notes().size(), 1U);
  EXPECT_THAT(files.notes()[0], testing::StartsWith("example_t: about "));
}

}  // namespace
}  // namespace robdef::arduino
