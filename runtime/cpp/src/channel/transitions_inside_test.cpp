// SPDX-License-Identifier: Apache-2.0
// What docs/architecture.md says of states, functions and locks is what the code has.
#include <gtest/gtest.h>

#include <cstddef>
#include <fstream>
#include <iterator>
#include <span>
#include <string>
#include <vector>

#include "runtime/cpp/src/channel/socket_watch.hpp"
#include "runtime/cpp/src/channel/strand.hpp"

namespace rr::channel {
namespace {

std::string name(Strand::State state) {
  switch (state) {
    case Strand::State::free:
      return "free";
    case Strand::State::held:
      return "held";
    case Strand::State::orphaned:
      return "orphaned";
    case Strand::State::suspended:
      return "suspended";
  }
  return {};
}

std::string name(SocketWatch::State state) {
  switch (state) {
    case SocketWatch::State::off:
      return "off";
    case SocketWatch::State::full:
      return "full";
    case SocketWatch::State::idle:
      return "idle";
  }
  return {};
}

template <class State>
std::vector<std::string> rows_of_code(std::span<const Transition<State>> transitions) {
  std::vector<std::string> rows;
  for (const auto& row : transitions) {
    rows.push_back("| " + name(row.from) + " | " + row.by + " | " + name(row.to) + " |");
  }
  return rows;
}

// The rows of the table behind a heading, without its two first lines.
std::vector<std::string> rows_of_page(const std::string& heading) {
  std::ifstream page(ROBDEF_SOURCE_DIR "/docs/architecture.md");
  std::vector<std::string> rows;
  bool is_behind = false;
  for (std::string line; std::getline(page, line);) {
    if (line.starts_with("#")) is_behind = line == heading;
    if (is_behind && line.starts_with("|")) rows.push_back(line);
  }
  if (rows.size() > 2) rows.erase(rows.begin(), rows.begin() + 2);
  return rows;
}

TEST(Transitions, OfTheStrandAreThoseOfThePage) {
  EXPECT_EQ(rows_of_page("### States of the strand"), rows_of_code(Strand::transitions()));
}

TEST(Transitions, OfTheSocketWatchAreThoseOfThePage) {
  EXPECT_EQ(rows_of_page("### States of the socket watch"),
            rows_of_code(SocketWatch::transitions()));
}

// The cells of a row, without blanks and backquotes at their ends.
std::vector<std::string> cells(const std::string& row) {
  std::vector<std::string> result;
  for (std::size_t at = 1; at < row.size();) {
    const std::size_t end = row.find('|', at);
    std::string cell = row.substr(at, end - at);
    const auto is_edge = [](char letter) { return letter == ' ' || letter == '`'; };
    while (!cell.empty() && is_edge(cell.back())) cell.pop_back();
    while (!cell.empty() && is_edge(cell.front())) cell.erase(0, 1);
    result.push_back(std::move(cell));
    at = end == std::string::npos ? row.size() : end + 1;
  }
  return result;
}

std::string text_of_file(const std::string& name) {
  std::ifstream file(ROBDEF_SOURCE_DIR "/" + name);
  return {std::istreambuf_iterator<char>(file), {}};
}

// From the definition of a function to the end of its body, which is a brace without indentation.
std::string body_of(const std::string& text, const std::string& function) {
  const std::size_t begin = text.find(function + "(");
  if (begin == std::string::npos) return {};
  return text.substr(begin, text.find("\n}", begin) - begin);
}

// The arrows of the diagram behind a heading: what calls, but for the last one, which is an answer.
std::vector<std::string> arrows_of_page(const std::string& heading) {
  std::ifstream page(ROBDEF_SOURCE_DIR "/docs/architecture.md");
  std::vector<std::string> arrows;
  bool is_behind = false;
  for (std::string line; std::getline(page, line);) {
    if (line.starts_with("#")) is_behind = line == heading;
    const std::size_t colon = line.find(": ");
    if (is_behind && line.find("->>") < colon && line.find("-->>") > colon) {
      arrows.push_back(line.substr(line.find("->>") + 3));
    }
  }
  return arrows;
}

class Sequences : public ::testing::TestWithParam<const char*> {};

TEST_P(Sequences, NameFunctionsAndTheirLocks) {
  const std::vector<std::string> rows = rows_of_page(GetParam());
  EXPECT_GE(rows.size(), 10U);
  for (const std::string& row : rows) {
    SCOPED_TRACE(row);
    const std::vector<std::string> cell = cells(row);
    ASSERT_EQ(cell.size(), 4U);
    const std::string body = body_of(text_of_file(cell[2]), cell[1]);
    EXPECT_FALSE(body.empty());
    const bool locks = body.find("MutexLock lock(mutex_)") != std::string::npos ||
                       body.find("Lock lock(connection.mutex_)") != std::string::npos;
    const bool is_under_lock = cell[1].find("under_lock") != std::string::npos;
    EXPECT_EQ(locks || is_under_lock, cell[3] == "mutex_");
  }
}

// An arrow leads to the class of the function, which it names with its file and the lock.
TEST_P(Sequences, AreDrawnStepByStep) {
  std::vector<std::string> expected;
  for (const std::string& row : rows_of_page(GetParam())) {
    const std::vector<std::string> cell = cells(row);
    ASSERT_EQ(cell.size(), 4U) << row;
    const std::string owner = cell[1].substr(0, cell[1].find_first_of("<:"));
    const std::string file = cell[2].substr(cell[2].rfind('/') + 1);
    expected.push_back(owner + ": " + cell[1] + " (" + file + ")" +
                       (cell[3].empty() ? "" : " [" + cell[3] + "]"));
  }
  EXPECT_EQ(arrows_of_page(GetParam()), expected);
}

INSTANTIATE_TEST_SUITE_P(Pages, Sequences,
                         ::testing::Values("### A blocking get", "### A served request"));

}  // namespace
}  // namespace rr::channel
