// SPDX-License-Identifier: Apache-2.0
// The published standard definitions, which are not part of this tree: ROBDEF_STANDARD_DIR names
// their folder. Compared with themselves, and with copies in which each file has one change.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <optional>
#include <regex>
#include <set>
#include <sstream>

#include "compiler/breaking/testing.hpp"

namespace robdef::breaking {
namespace {

namespace fs = std::filesystem;
using testing::Compared;
using Lines = std::vector<std::string>;

// In the order of their names. One imports what no file defines.
std::vector<std::string> standard_texts() {
  const char* const folder = std::getenv("ROBDEF_STANDARD_DIR");
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder == nullptr ? "" : folder)) {
    const bool is_broken =
        entry.path().filename() == "com.robotraconteur.a1.robotics.planning.robdef";
    if (entry.path().extension() == ".robdef" && !is_broken) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  std::vector<std::string> texts;
  for (const fs::path& file : files) {
    std::ifstream stream(file, std::ios::binary);
    texts.emplace_back(std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>());
  }
  return texts;
}

// Changes a line of a block; nothing when it is none of those that can be changed so.
using ChangeLine = std::function<std::optional<std::string>(const std::string& line)>;

ChangeLine replaces(const char* pattern, const char* replacement) {
  return [expression = std::regex(pattern),
          replacement](const std::string& line) -> std::optional<std::string> {
    if (line.ends_with('\\') || !std::regex_search(line, expression)) return std::nullopt;
    return std::regex_replace(line, expression, replacement);
  };
}

// A change that is made once in each file, in the first block of this kind in which it can be.
struct Mutation {
  const char* name;
  const char* code;
  const char* block;  // begins the line that begins the block; empty: outside of blocks
  ChangeLine change;
};

Lines lines_of(const std::string& text) {
  Lines lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) {
    if (line.ends_with('\r')) line.pop_back();
    lines.push_back(line);
  }
  return lines;
}

std::string text_of(const Lines& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + '\n';
  return text;
}

// The line that was changed, from 1.
std::optional<std::size_t> mutate(std::string& text, const Mutation& mutation) {
  Lines lines = lines_of(text);
  static const std::regex ends(R"(\s*end\s*)");
  static const std::regex begins(R"(^\s*(struct|pod|namedarray|enum|object)\s+\w+\s*$)");
  std::string block;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    std::smatch found;
    if (std::regex_match(lines[i], found, begins)) {
      block = found[1];
    } else if (std::regex_match(lines[i], ends)) {
      block.clear();
    } else if (block == mutation.block) {
      if (const auto changed = mutation.change(lines[i])) {
        lines[i] = *changed;
        text = text_of(lines);
        return i + 1;
      }
    }
  }
  return std::nullopt;
}

std::string place(const Sources& sources, Span span) {
  const Source& source = sources[span.source];
  return source.name() + ':' + std::to_string(source.position(span.begin).line);
}

// What is in the place of the name of a side's first file and of the others.
std::string name_of(const std::string& side, std::size_t file) {
  return side + (file == 0 ? "" : std::to_string(file)) + ".robdef";
}

TEST(StandardBreaking, NothingBreaksItself) {
  const std::vector<std::string> texts = standard_texts();
  ASSERT_GT(texts.size(), 40U);
  const Compared compared(texts, texts);
  EXPECT_FALSE(compared.report.has_errors());
  EXPECT_EQ(compared.codes(), "");
}

std::vector<Mutation> mutations() {
  constexpr const char* member =
      R"(^(\s*(?:property|function|event|objref|pipe|callback|wire|memory)\s.*)$)";
  return {
      {"a member that is gone", "R0703", "object", replaces(member, "#")},
      {"a member with another name", "R0703", "object",
       replaces(R"(^(\s*(?:property|objref|pipe|wire|memory)\s+\S+\s+\w+))", "$1_other")},
      {"a member of another kind", "R0704", "object",
       replaces(R"(^(\s*)(?:pipe|property)(\s+\S+\s+\w+).*$)", "$1wire$2")},
      {"a property of another type", "R0705", "object",
       replaces(R"(^(\s*property\s+)\S+(\s.*)$)", "$1cdouble{string}$2")},
      {"a result of another type", "R0705", "object",
       replaces(R"(^(\s*function\s+)[\w.]+(\s.*)$)", "$1cdouble{string}$2")},
      {"a new parameter", "R0707", "object",
       replaces(R"(^(\s*function\s+\S+\s+\w+\s*\()\s*\))", "$1double added)")},
      {"a parameter with another name", "R0709", "object",
       replaces(R"(^(\s*function\s+\S+\s+\w+\s*\(\s*[^,)]*\w)\s*([,)]))", "$1_other$2")},
      {"a property that is now readonly", "R0720", "object",
       replaces(R"(^(\s*property\s+\S+\s+\w+)\s*$)", "$1 [readonly]")},
      {"a field that is gone", "R0711", "struct", replaces(R"(^\s*field\s.*$)", "#")},
      {"a field with another name", "R0711", "struct",
       replaces(R"(^(\s*field\s+\S+\s+\w+)\s*$)", "$1_other")},
      {"a field of another type", "R0705", "struct",
       replaces(R"(^(\s*field\s+)\S+(\s.*)$)", "$1cdouble{string}$2")},
      {"a field that is new", "R0710", "struct",
       replaces(R"(^(\s*field\s+\S+\s+\w+)\s*$)", "$1\n    field cdouble{string} added")},
      {"more numbers", "R0713", "namedarray",
       replaces(R"(^(\s*field\s+)(\S+)(\s+\w+)\s*$)", "$1$2$3\n    field $2 added")},
      {"a number with another name", "R0746", "namedarray",
       replaces(R"(^(\s*field\s+\S+\s+\w+)\s*$)", "$1_other")},
      {"a field of a pod with another name", "R0711", "pod",
       replaces(R"(^(\s*field\s+\S+\s+\w+)\s*$)", "$1_other")},
      {"another number of a name", "R0771", "enum",
       replaces(R"(^(\s*\w+)\s*=\s*[-\w]+\s*$)", "$1 = -99999")},
      {"another name of a number", "R0742", "enum",
       replaces(R"(^(\s*\w+)(\s*=\s*[-\w]+,?\s*)$)", "$1_other$2")},
      {"another value of a constant", "R0773", "",
       replaces(R"(^(\s*constant\s+string\s+\w+\s+)\S+\s*$)", "$1\"other\"")},
  };
}

class StandardMutations : public ::testing::TestWithParam<std::size_t> {};

TEST_P(StandardMutations, EachIsFoundAtItsPlace) {
  const Mutation mutation = mutations()[GetParam()];
  const std::vector<std::string> before = standard_texts();
  std::vector<std::string> now = before;
  std::set<std::string> changed;
  for (std::size_t i = 0; i < now.size(); ++i) {
    if (const auto line = mutate(now[i], mutation))
      changed.insert(std::to_string(i) + ':' + std::to_string(*line));
  }
  ASSERT_FALSE(changed.empty()) << mutation.name;
  const Compared compared(before, now);
  // Where the change is: at the old or the new place of a finding of this code.
  std::set<std::string> places;
  for (const Change& change : compared.changes.list()) {
    if (entry_of(change.rule->code).name != mutation.code) continue;
    places.insert(place(compared.sources, change.old_place));
    if (change.new_place) places.insert(place(compared.sources, *change.new_place));
  }
  for (const std::string& one : changed) {
    const std::size_t file = std::stoul(one);
    const std::size_t line = std::stoul(one.substr(one.find(':') + 1));
    bool is_found = false;
    // What was added stands on the line below, and a namedarray is reported at its name.
    for (const char* const side : {"old", "new"}) {
      for (std::size_t at = line; at <= line + 1; ++at) {
        is_found = is_found || places.contains(name_of(side, file) + ':' + std::to_string(at));
      }
    }
    const bool is_whole = std::string(mutation.code) == "R0713";
    EXPECT_TRUE(is_found || is_whole) << mutation.name << ' ' << one;
  }
  std::size_t count = 0;
  for (const Change& change : compared.changes.list()) {
    const std::string_view code = entry_of(change.rule->code).name;
    if (code == mutation.code) ++count;
    // Objects of the standard implement each other.
    EXPECT_TRUE(code == mutation.code || code == "R0749")
        << mutation.name << ": " << change.diagnostic.message() << ' ' << code;
  }
  EXPECT_EQ(count, changed.size()) << mutation.name;
}

INSTANTIATE_TEST_SUITE_P(Each, StandardMutations,
                         ::testing::Range<std::size_t>(0, mutations().size()));

}  // namespace
}  // namespace robdef::breaking
