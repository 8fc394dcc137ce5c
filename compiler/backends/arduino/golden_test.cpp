// SPDX-License-Identifier: Apache-2.0
// What is generated for definitions/. The bench compiles the same files for a board.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>
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

TEST(BoardGolden, NothingIsComputedWithZeroOrOne) {
  // `slot - 0`, `0 + index`, `index / 1`, `slot >= 0`, which is always so, `true && a`.
  const std::regex idle(
      R"([-+] 0[^-.x0-9]|[^-.x0-9]0 \+ |[*/%] 1[^.x0-9]|[^.x0-9]1 \* |>= 0 |true &&)");
  int headers = 0;
  for (const fs::path& folder : fs::directory_iterator(ROBDEF_GOLDEN_DIR)) {
    for (const fs::path& path : fs::directory_iterator(folder)) {
      if (path.extension() != ".h") continue;
      ++headers;
      std::istringstream lines(GoldenCorpus::read(path));
      for (std::string line; std::getline(lines, line);) {
        EXPECT_FALSE(std::regex_search(line, idle)) << path.filename() << ": " << line;
      }
    }
  }
  EXPECT_EQ(headers, 5);
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
