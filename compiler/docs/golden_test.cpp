// SPDX-License-Identifier: Apache-2.0
// Pages of feature definitions of conformance/, beside this file. Style and script are the same in
// all and left out.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "compiler/diagnostics/golden_corpus.hpp"
#include "compiler/docs/testing.hpp"
#include "compiler/model/compiled.hpp"

namespace robdef::docs {
namespace {

namespace fs = std::filesystem;

const fs::path golden_folder = ROBDEF_DOCS_GOLDEN_DIR;
const std::vector<std::string> shown = {"experimental.docs", "experimental.implements",
                                        "experimental.members", "index"};

std::string without(std::string text, const std::string& begin, const std::string& end) {
  const std::size_t from = text.find(begin);
  const std::size_t to = text.find(end, from);
  if (from == text.npos || to == text.npos) return text;
  return text.replace(from + begin.size(), to - from - begin.size(), "");
}

FileSet all_pages(Form form) {
  std::vector<std::string> texts;
  const GoldenCorpus corpus(ROBDEF_DEFINITIONS_DIR);
  for (const fs::path& input : corpus.inputs()) texts.push_back(GoldenCorpus::read(input));
  const model::Compiled compiled = model::compiled(texts);
  EXPECT_TRUE(compiled.errors().empty());
  return make_pages(compiled.model, form);
}

void compare(Form form, const std::string& extension) {
  const GoldenCorpus corpus(golden_folder);
  const FileSet files = all_pages(form);
  for (const std::string& name : shown) {
    std::string text = files.files().at(name + extension);
    text = without(std::move(text), "<style>\n", "</style>");
    text = without(std::move(text), "<script>\n", "</script>");
    EXPECT_EQ(corpus.difference(golden_folder / (name + ".robdef"), extension, text), "");
  }
}

TEST(DocsGolden, HtmlPagesAreWhatStandsInTheGoldenFolder) { compare(Form::html, ".html"); }
TEST(DocsGolden, MarkdownPagesAreWhatStandsInTheGoldenFolder) { compare(Form::markdown, ".md"); }

TEST(DocsGolden, LinksOfAllFeatureDefinitionsLeadSomewhere) {
  for (const Form form : {Form::html, Form::markdown}) {
    std::size_t links = 0;
    EXPECT_EQ(faults_of(all_pages(form), form, links), "");
    EXPECT_GT(links, 500U);
  }
}

}  // namespace
}  // namespace robdef::docs
