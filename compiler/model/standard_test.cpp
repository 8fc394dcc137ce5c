// SPDX-License-Identifier: Apache-2.0
// The published standard definitions (group 1 and 2), which are not part of this tree:
// ROBDEF_STANDARD_DIR names their folder.
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "compiler/diagnostics/render.hpp"
#include "compiler/model/check.hpp"
#include "compiler/model/dump.hpp"
#include "compiler/model/evaluate.hpp"
#include "compiler/model/layout.hpp"
#include "compiler/model/print.hpp"
#include "compiler/model/resolve.hpp"
#include "compiler/syntax/read.hpp"
#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace robdef::model {
namespace {

namespace fs = std::filesystem;

// Imports a service whose file has another service line.
const std::string broken_definition = "com.robotraconteur.a1.robotics.planning.robdef";

std::string standard_folder() {
  const char* folder = std::getenv("ROBDEF_STANDARD_DIR");
  return folder == nullptr ? "" : folder;
}

std::vector<std::string> standard_files() {
  std::vector<std::string> files;
  for (const auto& entry : fs::directory_iterator(standard_folder())) {
    if (entry.path().extension() == ".robdef") files.push_back(entry.path().string());
  }
  std::sort(files.begin(), files.end());
  return files;
}

bool is_broken(const std::string& file) { return fs::path(file).filename() == broken_definition; }

struct Outcome {
  Sources sources;
  Report report;
  Model model;
};

void finish(const ast::Program& program, Outcome& outcome) {
  outcome.model = resolve(program, outcome.sources, outcome.report);
  evaluate(outcome.model, outcome.report);
  lay_out(outcome.model, outcome.report);
  check(outcome.model, outcome.report);
  check_strictly(outcome.model, outcome.report);
}

void run(const std::vector<std::string>& files, Outcome& outcome) {
  const ast::SearchPath path{{standard_folder()}};
  finish(ast::read(files, path, outcome.sources, outcome.report), outcome);
}

TEST(Standard, AllButOneAreAcceptedEachByItself) {
  const std::vector<std::string> files = standard_files();
  ASSERT_EQ(files.size(), 47u);
  for (const std::string& file : files) {
    Outcome outcome;
    run({file}, outcome);
    EXPECT_EQ(outcome.report.has_errors(), is_broken(file))
        << render(outcome.report, outcome.sources, Format::text);
  }
}

TEST(Standard, AllButOneAreAcceptedTogether) {
  std::vector<std::string> files = standard_files();
  std::erase_if(files, is_broken);
  Outcome outcome;
  run(files, outcome);
  EXPECT_FALSE(outcome.report.has_errors())
      << render(outcome.report, outcome.sources, Format::text);
  EXPECT_EQ(outcome.model.definitions().size(), 46u);
}

TEST(Standard, TheOneThatIsRejectedImportsWhatNoFileDefines) {
  Outcome outcome;
  run({(fs::path(standard_folder()) / broken_definition).string()}, outcome);
  ASSERT_EQ(outcome.report.errors(), 1u) << render(outcome.report, outcome.sources, Format::text);
  const Diagnostic& error = *outcome.report.sorted().front();
  EXPECT_EQ(entry_of(error.code()).rule, "V03");
  const Span span = error.primary().span;
  EXPECT_EQ(outcome.sources[span.source].position(span.begin).line, 11u);
}

TEST(Standard, PrintedDefinitionsParseToEqualModels) {
  std::vector<std::string> files = standard_files();
  std::erase_if(files, is_broken);
  Outcome outcome;
  run(files, outcome);
  std::vector<ast::NamedText> printed;
  for (const auto& definition : outcome.model.definitions()) {
    printed.push_back({definition->name + ".robdef", print(*definition), false});
  }
  Outcome again;
  finish(ast::read_texts(printed, again.sources, again.report), again);
  EXPECT_EQ(render(again.report, again.sources, Format::text), "");
  EXPECT_EQ(dump(outcome.model, outcome.sources, Detail::shape),
            dump(again.model, again.sources, Detail::shape));
}

TEST(Standard, TheModelIsTheSameInEachRun) {
  std::vector<std::string> files = standard_files();
  std::erase_if(files, is_broken);
  Outcome first;
  run(files, first);
  Outcome second;
  run(files, second);
  EXPECT_EQ(dump(first.model, first.sources), dump(second.model, second.sources));
}

}  // namespace
}  // namespace robdef::model
