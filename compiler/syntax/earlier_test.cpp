// SPDX-License-Identifier: Apache-2.0
// Reading with an earlier version gives what reading from nothing gives, whatever was changed.
#include "compiler/syntax/earlier.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "compiler/diagnostics/mutations.hpp"
#include "compiler/diagnostics/render.hpp"
#include "compiler/syntax/dump.hpp"
#include "compiler/syntax/parse.hpp"

namespace robdef::ast {
namespace {

// One version of a text, and what was read of it.
struct Reading {
  explicit Reading(std::string text) : id(add(std::move(text))) {
    file = parse(sources[id], id, report);
  }
  Reading(std::string text, Reading& earlier) : id(add(std::move(text))) {
    file = parse(sources[id], id, report, {earlier.text(), std::move(earlier.file)});
  }

  [[nodiscard]] const std::string& text() const { return sources[id].text(); }

  // All that can be known of it.
  [[nodiscard]] std::string shown() const {
    std::string all = dump(file, sources[id]);
    for (const Line& line : file.written.lines) {
      all += std::string(name_of(line.kind)) + (line.is_in_block ? " in " : " ") +
             (line.is_plain ? "plain " : "") + std::to_string(line.begin) + '-' +
             std::to_string(line.end) + '\n';
      for (const Token& token : file.written.tokens_of(line)) {
        all += ' ' + std::string(name_of(token.kind)) + ' ' + std::to_string(token.begin) + '-' +
               std::to_string(token.end) + '\n';
      }
    }
    return all + render(report, sources, Format::json);
  }

  Sources sources;
  Report report;
  SourceId id;
  File file;

 private:
  SourceId add(std::string text) { return sources.add("a.robdef", std::move(text)); }
};

std::vector<std::string> texts_of_the_corpus() {
  std::vector<std::filesystem::path> paths;
  for (const char* folder : {"accept", "reject", "syntax"}) {
    const std::filesystem::path below = std::filesystem::path(ROBDEF_CORPUS_DIR) / folder;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(below)) {
      if (entry.path().extension() == ".robdef") paths.push_back(entry.path());
    }
  }
  std::sort(paths.begin(), paths.end());
  std::vector<std::string> texts;
  for (const auto& path : paths) {
    std::ifstream in(path, std::ios::binary);
    texts.emplace_back(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
  }
  return texts;
}

std::string large(int blocks) {
  std::string text = "service a\nstdver 0.10\nenum E\n    a = 1,\n    b,\n    c\nend\n";
  for (int block = 0; block < blocks; ++block) {
    const std::string number = std::to_string(block);
    text += "## What it is.\nstruct S" + number +
            "\nconstant int32 C 2\nfield double[] x\nfield S" + number +
            "{list} y\nend\n\nobject O" + number +
            "\n## Documented.\nproperty S0 p [readonly]\nfunction double f(double a, S" + number +
            " b)\nevent e(int32 a)\nend\n";
  }
  return text;
}

// Of each kind that an editor makes: letters, lines, whole blocks, words that change what follows.
std::string edited(std::string text, std::mt19937_64& random) {
  const auto below = [&](std::size_t limit) { return limit == 0 ? 0 : random() % limit; };
  const auto line = [&] {
    const std::size_t before = text.rfind('\n', below(text.size()));
    return before == text.npos ? 0 : before + 1;
  };
  constexpr const char* pieces[] = {"x",
                                    " ",
                                    "\n",
                                    "end\n",
                                    "# a\n",
                                    "## b\n",
                                    "struct Q\n",
                                    "enum Q\nq\nend\n",
                                    "\\\n",
                                    "option c 1\n",
                                    "end enum\n",
                                    "object\n",
                                    "stdver 0.10\n",
                                    "option version 0.8\n",
                                    "\xC3",
                                    "# robdef: allow R0136\n",
                                    "constant int32 k 3\n",
                                    "field double z\n",
                                    "property double z\n",
                                    "service b\n"};
  switch (below(6)) {
    case 0:
      return mutated(std::move(text), random());
    case 1: {
      const std::size_t at = below(text.size());
      text.erase(at, 1 + below(3));
      return text;
    }
    case 2: {
      const std::size_t at = line();
      const std::string copy = text.substr(at, below(200));
      text.insert(line(), copy);
      return text;
    }
    case 3: {
      const std::size_t begin = line();
      text.erase(begin, line() > begin ? 1 + below(300) : 0);
      return text;
    }
    case 4:
      text.insert(below(text.size() + 1), pieces[below(std::size(pieces))]);
      return text;
    default:
      text.insert(line(), pieces[below(std::size(pieces))]);
      return text;
  }
}

// Each version is read with the one before, which was read with the one before, too.
TEST(Earlier, TenThousandEditsGiveWhatReadingFromNothingGives) {
  std::vector<std::string> texts = texts_of_the_corpus();
  ASSERT_GT(texts.size(), 100U);
  texts.push_back(large(3));
  texts.push_back(large(12));
  std::mt19937_64 random(21);
  constexpr int edits_of_each = 40;
  int edits = 0;
  while (edits < 10'000) {
    for (const std::string& text : texts) {
      auto version = std::make_unique<Reading>(text);
      for (int edit = 0; edit < edits_of_each; ++edit, ++edits) {
        std::string changed = edited(version->text(), random);
        // Undone as often as not, so that the text stays a definition.
        const std::string back = version->text();
        auto next = std::make_unique<Reading>(changed, *version);
        const Reading whole(changed);
        ASSERT_EQ(next->shown(), whole.shown()) << "from\n" << back << "\nto\n" << changed;
        version = std::move(next);
        if (edit % 4 != 3) continue;
        next = std::make_unique<Reading>(text, *version);
        ASSERT_EQ(next->shown(), Reading(text).shown()) << "from\n"
                                                        << changed << "\nback\n"
                                                        << text;
        version = std::move(next);
      }
    }
  }
}

TEST(Earlier, PartsOfWhatHasNotChangedAreMovedAndNotReadAgain) {
  Reading before(large(3));
  const auto& declarations = before.file.declarations;
  ASSERT_EQ(declarations.size(), 7U);
  const Field* const first = std::get<Record>(declarations[1]).fields.data();
  const Member* const last = std::get<Object>(declarations[6]).members.data();
  const Parameter* const changed = std::get<Object>(declarations[4]).members[1].parameters.data();
  std::string text = before.text();
  text.insert(text.find("event", text.find("object O1")), "wire double w\n");
  const Reading after(text, before);
  EXPECT_EQ(std::get<Record>(after.file.declarations[1]).fields.data(), first);
  EXPECT_EQ(std::get<Object>(after.file.declarations[6]).members.data(), last);
  // In the block with the change: the line above it.
  EXPECT_EQ(std::get<Object>(after.file.declarations[4]).members[1].parameters.data(), changed);
  EXPECT_EQ(after.shown(), Reading(text).shown());
}

TEST(Earlier, AnAllowAboveABlockDoesNotKeepItsLinesFromBeingMoved) {
  std::string text = large(2);
  text.insert(text.find("struct S1"), "# robdef: allow R0610\n");
  Reading first(text);
  text.insert(text.find("struct S0"), "\n");
  Reading second(text, first);
  const Parameter* const kept =
      std::get<Object>(second.file.declarations[4]).members[1].parameters.data();
  text.insert(text.find("struct S0"), "\n");
  const Reading third(text, second);
  EXPECT_EQ(std::get<Object>(third.file.declarations[4]).members[1].parameters.data(), kept);
  EXPECT_EQ(third.shown(), Reading(text).shown());
}

}  // namespace
}  // namespace robdef::ast
