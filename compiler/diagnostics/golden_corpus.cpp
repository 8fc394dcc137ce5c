// SPDX-License-Identifier: Apache-2.0
#include "compiler/diagnostics/golden_corpus.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "compiler/diagnostics/source.hpp"

namespace robdef {
namespace {

namespace fs = std::filesystem;

// Shell patterns with `*` and `?`. Backtracks to the last `*` only, which is enough for these two.
bool matches(std::string_view pattern, std::string_view text) {
  std::size_t p = 0;
  std::size_t t = 0;
  std::size_t star = pattern.npos;
  std::size_t resume = 0;
  while (t < text.size()) {
    if (p < pattern.size() && (pattern[p] == '?' || pattern[p] == text[t])) {
      ++p;
      ++t;
    } else if (p < pattern.size() && pattern[p] == '*') {
      star = p++;
      resume = t;
    } else if (star != pattern.npos) {
      p = star + 1;
      t = ++resume;
    } else {
      return false;
    }
  }
  return pattern.find_first_not_of('*', p) == pattern.npos;
}

bool is_updated(const fs::path& input) {
  const char* const pattern = std::getenv("ROBDEF_UPDATE");
  return pattern != nullptr && matches(pattern, input.filename().string());
}

void write(const fs::path& file, std::string_view text) {
  if (text.empty()) {
    fs::remove(file);
    return;
  }
  fs::create_directories(file.parent_path());
  std::ofstream out(file, std::ios::binary);
  out.write(text.data(), static_cast<std::streamsize>(text.size()));
  if (!out.flush()) throw std::runtime_error(fmt::format("cannot write {}", file.string()));
}

std::string_view take_line(std::string_view& text) {
  const std::size_t end = text.find('\n');
  const std::string_view line = text.substr(0, end);
  text.remove_prefix(end == text.npos ? text.size() : end + 1);
  return line;
}

std::string first_difference(std::string_view expected, std::string_view actual) {
  for (std::size_t number = 1;; ++number) {
    const bool expected_ends = expected.empty();
    const bool actual_ends = actual.empty();
    const std::string_view wanted = take_line(expected);
    const std::string_view got = take_line(actual);
    if (wanted != got || expected_ends != actual_ends || (expected_ends && actual_ends)) {
      return fmt::format("line {}\n  expected: {}\n  actual:   {}", number,
                         expected_ends ? "(end)" : wanted, actual_ends ? "(end)" : got);
    }
  }
}

// The value of `key:` in `a: b; c: d`, which is the form of an example's first line.
std::string field(std::string_view line, std::string_view key) {
  const std::string start = fmt::format("{}: ", key);
  std::size_t at = line.find(start);
  if (at == line.npos) return {};
  at += start.size();
  return std::string(line.substr(at, line.find_first_of(";\r", at) - at));
}

fs::path find_companion(const fs::path& folder, const std::string& name) {
  const std::string file = name + ".robdef";
  for (const fs::path& place :
       {folder, folder.parent_path() / "accept", folder.parent_path() / "reject"}) {
    if (fs::exists(place / file)) return place / file;
  }
  throw std::runtime_error(fmt::format("no example {} for {}", name, folder.string()));
}

}  // namespace

GoldenCorpus::GoldenCorpus(const fs::path& folder, const std::string& extension) {
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() == extension) inputs_.push_back(entry.path());
  }
  std::sort(inputs_.begin(), inputs_.end());
}

std::string GoldenCorpus::difference(const fs::path& input, std::string_view suffix,
                                     std::string_view actual) const {
  fs::path file = input;
  file.replace_extension();
  file += suffix;
  const std::string expected = fs::exists(file) ? read(file) : "";
  if (expected == actual) return {};
  if (is_updated(input)) {
    write(file, actual);
    return {};
  }
  return fmt::format("{} differs in {}\n  (rewrite it with ROBDEF_UPDATE={})", file.string(),
                     first_difference(expected, actual), input.filename().string());
}

std::string GoldenCorpus::read(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  if (!in) throw std::runtime_error(fmt::format("cannot read {}", file.string()));
  return std::move(text).str();
}

std::vector<Example> read_examples(const fs::path& folder) {
  std::vector<Example> examples;
  const GoldenCorpus corpus(folder);
  for (const fs::path& file : corpus.inputs()) {
    const std::string text = GoldenCorpus::read(file);
    std::string_view line = text;
    if (line.starts_with(byte_order_mark)) line.remove_prefix(byte_order_mark.size());
    // One example has lone carriage returns for line ends.
    line = line.substr(0, line.find_first_of("\r\n"));
    if (!line.starts_with("# expect: ")) continue;
    Example example{
        file, field(line, "expect") == "accept", field(line, "rule"), field(line, "stage"), {}};
    std::istringstream companions(field(line, "with"));
    for (std::string name; std::getline(companions, name, ',');) {
      if (name != "-") example.companions.push_back(find_companion(folder, name));
    }
    examples.push_back(std::move(example));
  }
  return examples;
}

}  // namespace robdef
