// SPDX-License-Identifier: Apache-2.0
// The feature definitions of conformance/ and what is generated from them. The goldens are one
// output folder, as a user has it; they are also compiled (CMakeLists.txt).
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <set>
#include <string>
#include <vector>

#include "compiler/backends/cpp/backend.hpp"
#include "compiler/diagnostics/golden_corpus.hpp"
#include "compiler/model/compiled.hpp"
#include "compiler/output/template.hpp"

namespace robdef::cpp {
namespace {

namespace fs = std::filesystem;

const fs::path definitions_folder = ROBDEF_DEFINITIONS_DIR;
const fs::path golden_folder = ROBDEF_GOLDEN_DIR;

model::Compiled all_definitions() {
  std::vector<std::string> texts;
  const GoldenCorpus corpus(definitions_folder);
  for (const fs::path& input : corpus.inputs()) {
    texts.push_back(GoldenCorpus::read(input));
  }
  return model::compiled(texts);
}

TEST(Golden, EachFeatureGivesWhatStandsInTheGoldenFolder) {
  const model::Compiled compiled = all_definitions();
  ASSERT_TRUE(compiled.errors().empty());
  ASSERT_GE(compiled.model.definitions().size(), 19U);
  Report report;
  const FileSet files = CppBackend().generate(compiled.model, {}, report);
  EXPECT_FALSE(report.has_errors());
  EXPECT_EQ(files.files().size(), 2 * compiled.model.definitions().size());
  const GoldenCorpus corpus(definitions_folder);
  for (const auto& [path, content] : files.files()) {
    // Beside each golden one could think its definition.
    fs::path input = golden_folder / path;
    const std::string ending = input.extension().string();
    input.replace_extension(".robdef");
    EXPECT_EQ(corpus.difference(input, ending, content), "");
  }
}

TEST(Golden, NothingElseStandsThere) {
  const model::Compiled compiled = all_definitions();
  Report report;
  const FileSet files = CppBackend().generate(compiled.model, {}, report);
  for (const auto& entry : fs::recursive_directory_iterator(golden_folder)) {
    if (!entry.is_regular_file()) continue;
    const std::string path = entry.path().lexically_relative(golden_folder).generic_string();
    EXPECT_TRUE(files.contains(path)) << path;
  }
}

TEST(Golden, ImportsAreNotGenerated) {
  model::Compiled compiled = model::compiled_lines("struct S\n field int32 x\nend\n");
  const_cast<model::Definition&>(compiled.definition(0)).is_import = true;
  Report report;
  EXPECT_TRUE(CppBackend().generate(compiled.model, {}, report).files().empty());
}

TEST(Golden, NothingIsGeneratedWithAnError) {
  const model::Compiled compiled =
      model::compiled_lines("struct FooStub\n field int32 x\nend\nobject Foo\nend\n");
  Report report;
  EXPECT_TRUE(CppBackend().generate(compiled.model, {}, report).files().empty());
  EXPECT_TRUE(report.has_errors());
}

class TemplatesFromOutside : public testing::Test {
 protected:
  TemplatesFromOutside()
      : folder_(fs::temp_directory_path() /
                (std::string("robdef_templates_") +
                 testing::UnitTest::GetInstance()->current_test_info()->name())) {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  ~TemplatesFromOutside() override { fs::remove_all(folder_); }

  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }
  FileSet generate(const std::string& lines) const {
    const model::Compiled compiled = model::compiled_lines(lines);
    Report report;
    return CppBackend().generate(compiled.model, {.template_folder = folder_.string()}, report);
  }

  fs::path folder_;
};

TEST_F(TemplatesFromOutside, MakeOutputsForAllDefinitionsAndObjects) {
  write("outputs.txt",
        "all a.mustache all.txt\n"
        "definition d.mustache {{path}}.txt\n"
        "object o.mustache {{path}}/{{short_name}}.txt\n");
  write("a.mustache", "{{#definitions}}{{wire_name}}\n{{/definitions}}");
  write("d.mustache", "{{#declarations}}{{#object}}{{stub}} {{/object}}{{/declarations}}\n");
  write("o.mustache",
        "{{qualified_skeleton}}:{{#members}} {{kind}} {{wire_name}} {{robdef_type}}{{/members}}\n");
  const FileSet files = generate("object A\n property double[] x\nend\nobject B\nend\n");
  ASSERT_EQ(files.files().size(), 4U);
  EXPECT_EQ(files.files().at("all.txt"), "example.t\n");
  EXPECT_EQ(files.files().at("example/t.txt"), "AStub BStub \n");
  EXPECT_EQ(files.files().at("example/t/A.txt"), "::example::t::ASkeleton: property x double[]\n");
  EXPECT_EQ(files.files().at("example/t/B.txt"), "::example::t::BSkeleton:\n");
}

TEST_F(TemplatesFromOutside, ReplaceOneOfOurs) {
  write("_enum.hpp.mustache", "enum {{name}} is left out\n");
  const FileSet files = generate("enum E\n a = 1\nend\n");
  ASSERT_EQ(files.files().size(), 2U);
  EXPECT_NE(files.files().at("example/t.hpp").find("\nenum E is left out\n"), std::string::npos);
}

TEST_F(TemplatesFromOutside, AreRefusedWithTheirPlace) {
  write("outputs.txt", "\nobjects o.mustache x.txt\n");
  write("o.mustache", "");
  try {
    (void)generate("object A\nend\n");
    FAIL() << "accepted";
  } catch (const TemplateError& error) {
    EXPECT_STREQ(error.what(),
                 "outputs.txt:2: `objects` is no subject; there are all, definition, object, "
                 "record, enum and exception");
  }
}

TEST_F(TemplatesFromOutside, CannotMakeOneFileTwice) {
  write("outputs.txt", "object o.mustache x.txt\n");
  write("o.mustache", "");
  EXPECT_THROW((void)generate("object A\nend\nobject B\nend\n"), TemplateError);
}

}  // namespace
}  // namespace robdef::cpp
