// SPDX-License-Identifier: Apache-2.0
// The published standard definitions, which are not part of this tree: ROBDEF_STANDARD_DIR names
// their folder.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "compiler/diagnostics/golden_corpus.hpp"
#include "compiler/docs/testing.hpp"
#include "compiler/model/compiled.hpp"

namespace robdef::docs {
namespace {

namespace fs = std::filesystem;

/// The text of a definition. One imports a service by the name of its file, which has another
/// service line.
std::string text_of(const fs::path& file) {
  std::string text = GoldenCorpus::read(file);
  const std::string wrong = "com.robotraconteur.a1.robotics.scene";
  if (file.filename() != "com.robotraconteur.a1.robotics.planning.robdef") return text;
  for (std::size_t at = 0; (at = text.find(wrong, at)) != text.npos;) {
    text.replace(at, wrong.size(), "com.robotraconteur.robotics.scene");
  }
  return text;
}

class StandardPages : public testing::TestWithParam<Form> {
 protected:
  void SetUp() override {
    const char* const folder = std::getenv("ROBDEF_STANDARD_DIR");
    if (folder == nullptr) GTEST_SKIP() << "ROBDEF_STANDARD_DIR is not set";
    std::vector<std::string> texts;
    const GoldenCorpus corpus(folder);
    for (const fs::path& input : corpus.inputs()) texts.push_back(text_of(input));
    compiled_ = model::compiled(texts);
  }

  model::Compiled compiled_;
};

TEST_P(StandardPages, AllLinksLeadSomewhere) {
  ASSERT_TRUE(compiled_.errors().empty()) << compiled_.errors().front();
  const FileSet files = make_pages(compiled_.model, GetParam());
  EXPECT_EQ(files.files().size(), GetParam() == Form::html ? 49U : 48U);
  std::size_t links = 0;
  EXPECT_EQ(faults_of(files, GetParam(), links), "");
  EXPECT_GT(links, 3000U);
}

INSTANTIATE_TEST_SUITE_P(Forms, StandardPages, testing::Values(Form::html, Form::markdown),
                         [](const auto& parameter) {
                           return parameter.param == Form::html ? "Html" : "Markdown";
                         });

}  // namespace
}  // namespace robdef::docs
