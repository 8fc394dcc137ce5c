// SPDX-License-Identifier: Apache-2.0
// Definitions of other parties in every language: all standard definitions, and those of foreign/,
// with names that some language reserves or cannot tell apart. What cannot be generated says which
// rename helps.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/backends/backend.hpp"
#include "compiler/diagnostics/golden_corpus.hpp"
#include "compiler/diagnostics/render.hpp"
#include "compiler/model/compiled.hpp"
#include "compiler/model/rename.hpp"

namespace robdef {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::IsEmpty;

/// The texts of foreign/; of a board that one alone that it can serve.
std::vector<std::string> foreign(bool is_board) {
  std::vector<std::string> texts;
  const GoldenCorpus corpus(ROBDEF_FOREIGN_DIR);
  for (const fs::path& file : corpus.inputs()) {
    const bool is_wanted = !is_board || file.filename() == "experimental.foreign.board.robdef";
    if (is_wanted) texts.push_back(GoldenCorpus::read(file));
  }
  return texts;
}

/// What has R0901 in a help: `"path" = "name"`.
std::optional<model::Rename> proposed(const Diagnostic& finding) {
  for (const std::string& help : finding.helps()) {
    const std::size_t begin = help.find("`\"");
    const std::size_t middle = help.find("\" = \"");
    const std::size_t end = help.find("\"`");
    if (begin == help.npos || middle == help.npos || end == help.npos) continue;
    return model::Rename{help.substr(begin + 2, middle - begin - 2),
                         help.substr(middle + 5, end - middle - 5)};
  }
  return std::nullopt;
}

/// Generates again and again, each time with the renames that the findings have proposed, until
/// there are no errors. Returns the errors that no rename mends.
std::vector<std::string> mended(const Backend& backend, model::Compiled& compiled, FileSet& files) {
  std::vector<model::Rename> renames;
  constexpr int most_rounds = 10;
  std::vector<std::string> left;
  for (int round = 0; round < most_rounds; ++round) {
    EXPECT_THAT(model::rename(compiled.model, renames), IsEmpty()) << backend.name();
    Report report;
    files = backend.generate(compiled.model, {}, report);
    if (!report.has_errors()) return {};
    left.clear();
    for (const Diagnostic* finding : report.sorted()) {
      if (finding->severity() != Severity::error) continue;
      std::optional<model::Rename> rename = proposed(*finding);
      if (!rename) {
        left.push_back(to_line(*finding, *compiled.sources));
        continue;
      }
      // Proposed before: that name was taken, too.
      const auto known = std::ranges::find(renames, rename->path, &model::Rename::path);
      if (known == renames.end()) {
        renames.push_back(*std::move(rename));
      } else {
        known->name += "x";
      }
    }
    if (!left.empty()) return left;
  }
  return {"it does not end"};
}

class EveryLanguage : public testing::TestWithParam<const Backend*> {};

TEST_P(EveryLanguage, GeneratesForeignNamesOrSaysWhichRenameHelps) {
  const Backend& backend = *GetParam();
  model::Compiled compiled = model::compiled(foreign(backend.name() == "arduino"));
  ASSERT_THAT(compiled.errors(), IsEmpty());
  FileSet files;
  EXPECT_THAT(mended(backend, compiled, files), IsEmpty());
  EXPECT_FALSE(files.files().empty());
}

// A rename reaches the generated names, and the name on the wire is still there.
TEST_P(EveryLanguage, KnowsRenames) {
  model::Compiled compiled = model::compiled(
      {"service example.arm\nstdver 0.10\nexception Stuck\nconstant int32 REACH 3\n"
       "enum Mode\n  idle = 0,\n  busy\nend\npod Pose\n  field double pan\nend\n"
       "object Arm\n  property double speed\n  function double turn(double angle)\n"
       "  event fired(Pose pose)\n  wire Pose place [readonly]\n  property Mode mode\nend\n"});
  ASSERT_THAT(compiled.errors(), IsEmpty());
  const std::string_view language = GetParam()->name();
  std::vector<model::Rename> renames{{"example.arm.Pose", "Qpose"}};
  if (language == "cbus") {
    renames.push_back({"example.arm.Pose.pan", "qpan"});
  } else {
    for (const auto& [path, name] :
         std::vector<std::pair<std::string, std::string>>{{"Stuck", "Qstuck"},
                                                          {"REACH", "qreach"},
                                                          {"Mode", "Qmode"},
                                                          {"Mode.busy", "qbusy"},
                                                          {"Arm", "Qarm"},
                                                          {"Arm.speed", "qspeed"},
                                                          {"Arm.turn", "qturn"},
                                                          {"Arm.turn.angle", "qangle"},
                                                          {"Arm.place", "qplace"}}) {
      renames.push_back({"example.arm." + path, name});
    }
    if (language != "matlab") renames.push_back({"example.arm.Arm.fired", "qfired"});
    if (language != "matlab" && language != "typescript") {
      renames.push_back({"example.arm.Pose.pan", "qpan"});
    }
  }
  ASSERT_THAT(model::rename(compiled.model, renames), IsEmpty());
  Report report;
  const FileSet files = GetParam()->generate(compiled.model, {}, report);
  EXPECT_EQ(render(report, *compiled.sources, Format::line).find("error"), std::string::npos)
      << render(report, *compiled.sources, Format::text);
  std::string all;
  for (const auto& [path, content] : files.files()) all += path + "\n" + content;
  std::string small = all;
  std::ranges::transform(small, small.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  for (const model::Rename& rename : renames) {
    std::string name = rename.name;
    name.front() = 'q';
    EXPECT_THAT(small, HasSubstr(name)) << language << ' ' << rename.path;
  }
  if (language != "cbus") {
    EXPECT_THAT(all, HasSubstr("property double speed")) << "the definition itself stays";
  }
}

std::vector<std::string> lines_of(const Backend& backend, const std::string& definition) {
  const model::Compiled compiled = model::compiled({definition});
  EXPECT_THAT(compiled.errors(), IsEmpty());
  Report report;
  const FileSet files = backend.generate(compiled.model, {}, report);
  EXPECT_FALSE(report.has_errors());
  std::vector<std::string> lines;
  for (const auto& [path, content] : files.files()) {
    std::istringstream text(content);
    for (std::string line; std::getline(text, line);) lines.push_back(path + ": " + line);
  }
  return lines;
}

// What was generated before is there still, in the same order: a version of a definition with one
// function more is a change that somebody can read.
class EveryHostLanguage : public EveryLanguage {};
TEST_P(EveryHostLanguage, ChangesNoOtherLineForAFunctionThatIsInserted) {
  const std::string head = "service example.arm\nstdver 0.10\nobject Joint\nend\nobject Arm\n";
  const std::string inserted = "  function double turn(double angle)\n";
  const std::string rest =
      "  property double speed\n  function void stop()\n  function double{generator} sweep()\n"
      "  event fired(double angle)\n  objref Joint[] joint\n  pipe double trace\n"
      "  callback double ask(double angle)\n  wire double place\n  memory double[] log\nend\n";
  const std::vector<std::string> before = lines_of(*GetParam(), head + rest);
  const std::vector<std::string> after = lines_of(*GetParam(), head + inserted + rest);
  ASSERT_GT(after.size(), before.size());
  auto next = after.begin();
  for (const std::string& line : before) {
    next = std::find(next, after.end(), line);
    ASSERT_NE(next, after.end()) << "changed: " << line;
    ++next;
  }
}

TEST_P(EveryLanguage, GeneratesTheStandardDefinitions) {
  const char* const folder = std::getenv("ROBDEF_STANDARD_DIR");
  if (folder == nullptr) GTEST_SKIP() << "ROBDEF_STANDARD_DIR is not set";
  std::vector<std::string> texts;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const bool is_refused =
        entry.path().filename() == "com.robotraconteur.a1.robotics.planning.robdef";
    if (entry.path().extension() != ".robdef" || is_refused) continue;
    texts.push_back(GoldenCorpus::read(entry.path()));
  }
  ASSERT_GT(texts.size(), 40U);
  model::Compiled compiled = model::compiled(texts);
  ASSERT_THAT(compiled.errors(), IsEmpty());
  const std::string_view language = GetParam()->name();
  if (language == "arduino" || language == "cbus") {
    // What fits a board or a bus is little: all else is refused by name, and nothing is made.
    Report report;
    const FileSet files = GetParam()->generate(compiled.model, {}, report);
    for (const Diagnostic* finding : report.sorted()) {
      EXPECT_THAT(std::string(entry_of(finding->code()).name), testing::StartsWith("R09"));
    }
    return;
  }
  FileSet files;
  EXPECT_THAT(mended(*GetParam(), compiled, files), IsEmpty());
  EXPECT_GE(files.files().size(), texts.size());
}

std::string name_of(const testing::TestParamInfo<const Backend*>& info) {
  return std::string(info.param->name());
}

// The frames of a board have numbers; a bus has no functions.
INSTANTIATE_TEST_SUITE_P(All, EveryHostLanguage,
                         testing::Values(find_backend("cpp"), find_backend("csharp"),
                                         find_backend("matlab"), find_backend("typescript")),
                         name_of);
INSTANTIATE_TEST_SUITE_P(All, EveryLanguage, testing::ValuesIn(backends()), name_of);

}  // namespace
}  // namespace robdef
