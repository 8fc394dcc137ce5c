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

struct Compiled {
  Sources sources;
  Report report;
  Model model;
};

void finish(const ast::Program& program, Compiled& compiled) {
  compiled.model = resolve(program, compiled.sources, compiled.report);
  evaluate(compiled.model, compiled.report);
  lay_out(compiled.model, compiled.report);
  check(compiled.model, compiled.report);
  check_strictly(compiled.model, compiled.report);
}

void compile(const std::vector<std::string>& files, Compiled& compiled) {
  const ast::SearchPath path{{standard_folder()}};
  finish(ast::read(files, path, compiled.sources, compiled.report), compiled);
}

TEST(Standard, AllButOneAreAcceptedEachByItself) {
  const std::vector<std::string> files = standard_files();
  ASSERT_EQ(files.size(), 47u);
  for (const std::string& file : files) {
    Compiled compiled;
    compile({file}, compiled);
    EXPECT_EQ(compiled.report.has_errors(), is_broken(file))
        << render(compiled.report, compiled.sources, Format::text);
  }
}

TEST(Standard, AllButOneAreAcceptedTogether) {
  std::vector<std::string> files = standard_files();
  std::erase_if(files, is_broken);
  Compiled compiled;
  compile(files, compiled);
  EXPECT_FALSE(compiled.report.has_errors())
      << render(compiled.report, compiled.sources, Format::text);
  EXPECT_EQ(compiled.model.definitions().size(), 46u);
}

TEST(Standard, TheOneThatIsRejectedImportsWhatNoFileDefines) {
  Compiled compiled;
  compile({(fs::path(standard_folder()) / broken_definition).string()}, compiled);
  ASSERT_EQ(compiled.report.errors(), 1u)
      << render(compiled.report, compiled.sources, Format::text);
  const Diagnostic& error = *compiled.report.sorted().front();
  EXPECT_EQ(entry_of(error.code()).rule, "V03");
  const Span span = error.primary().span;
  EXPECT_EQ(compiled.sources[span.source].position(span.begin).line, 11u);
}

TEST(Standard, PrintedDefinitionsParseToEqualModels) {
  std::vector<std::string> files = standard_files();
  std::erase_if(files, is_broken);
  Compiled compiled;
  compile(files, compiled);
  std::vector<ast::NamedText> printed;
  for (const auto& definition : compiled.model.definitions()) {
    printed.push_back({definition->name + ".robdef", print(*definition), false});
  }
  Compiled again;
  finish(ast::read_texts(printed, again.sources, again.report), again);
  EXPECT_EQ(render(again.report, again.sources, Format::text), "");
  EXPECT_EQ(dump(compiled.model, compiled.sources, Detail::shape),
            dump(again.model, again.sources, Detail::shape));
}

TEST(Standard, TheModelIsTheSameInEachRun) {
  std::vector<std::string> files = standard_files();
  std::erase_if(files, is_broken);
  Compiled first;
  compile(files, first);
  Compiled second;
  compile(files, second);
  EXPECT_EQ(dump(first.model, first.sources), dump(second.model, second.sources));
}

}  // namespace
}  // namespace robdef::model
