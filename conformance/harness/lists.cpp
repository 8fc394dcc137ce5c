// SPDX-License-Identifier: Apache-2.0
#include "conformance/harness/lists.hpp"

#include <algorithm>
#include <atomic>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace rr::conformance {
namespace {

std::string trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t\r");
  if (begin == std::string_view::npos) return {};
  return std::string(text.substr(begin, text.find_last_not_of(" \t\r") - begin + 1));
}

std::vector<std::string> split(std::string_view text, char separator) {
  std::vector<std::string> parts;
  while (true) {
    const std::size_t end = text.find(separator);
    parts.push_back(trimmed(text.substr(0, end)));
    if (end == std::string_view::npos) return parts;
    text.remove_prefix(end + 1);
  }
}

// True when `list`, words separated by blanks, has the word or is `*`.
bool lists(const std::string& list, std::string_view word) {
  if (list == "*") return true;
  std::istringstream words(list);
  for (std::string each; words >> each;) {
    if (each == word) return true;
  }
  return false;
}

struct Line {
  std::vector<std::string> fields;
  std::string where;
};

std::vector<Line> read_lines(const std::filesystem::path& file) {
  std::ifstream stream(file);
  if (!stream) throw std::runtime_error("cannot read " + file.string());
  std::vector<Line> lines;
  int number = 0;
  for (std::string text; std::getline(stream, text);) {
    ++number;
    text = trimmed(text);
    if (text.empty() || text.front() == '#') continue;
    Line line{split(text, '|'), file.filename().string() + ":" + std::to_string(number)};
    if (line.fields.size() != 6) throw std::runtime_error(line.where + ": not six fields");
    lines.push_back(std::move(line));
  }
  return lines;
}

const ListEntry* find_in(const std::vector<ListEntry>& entries, const Run& run,
                         std::string_view place) {
  for (const ListEntry& entry : entries) {
    if (entry.place() == place && entry.covers(run)) {
      std::atomic_ref(entry.met) = true;  // by several threads
      return &entry;
    }
  }
  return nullptr;
}

}  // namespace

std::string_view name_of(Role role) {
  switch (role) {
    case Role::decode:
      return "decode";
    case Role::encode:
      return "encode";
    case Role::service:
      return "service";
    case Role::client:
      return "client";
  }
  return "";
}

ListEntry::ListEntry(std::vector<std::string> fields, std::string where_listed)
    : scenario_(std::move(fields.at(0))),
      versions_(std::move(fields.at(1))),
      role_(std::move(fields.at(2))),
      place_(std::move(fields.at(3))),
      instead_(std::move(fields.at(4))),
      reason_(std::move(fields.at(5))),
      where_listed_(std::move(where_listed)) {
  static constexpr std::string_view over = " over ";
  const std::size_t end = scenario_.find(over);
  channels_ = end == std::string::npos ? "*" : scenario_.substr(end + over.size());
  scenario_.resize(std::min(end, scenario_.size()));
  if (reason_.empty()) throw std::runtime_error(where_listed_ + ": an entry without a reason");
}

bool ListEntry::covers(const Run& run) const {
  return lists(scenario_, run.scenario) && lists(versions_, run.version) &&
         lists(role_, name_of(run.role)) && is_of_channel(run.channel);
}

bool ListEntry::is_of_channel(std::string_view channel) const { return lists(channels_, channel); }

Deviations::Deviations(const std::filesystem::path& file, bool borrowed) : are_borrowed_(borrowed) {
  for (Line& line : read_lines(file)) {
    entries_.emplace_back(std::move(line.fields), std::move(line.where));
  }
}

const ListEntry* Deviations::find(const Run& run, std::string_view place) const {
  return find_in(entries_, run, place);
}

ExpectedFailures::ExpectedFailures(const std::filesystem::path& file, std::string_view language) {
  for (Line& line : read_lines(file)) {
    if (!lists(line.fields.front(), language)) continue;
    line.fields.erase(line.fields.begin());
    line.fields.insert(line.fields.begin() + 4, std::string());
    entries_.emplace_back(std::move(line.fields), std::move(line.where));
  }
}

const ListEntry* ExpectedFailures::find(const Run& run, std::string_view place) const {
  return find_in(entries_, run, place);
}

std::string step_place(int step) { return "step " + std::to_string(step); }
std::string frame_place(int frame) { return "frame " + std::to_string(frame); }
std::string request_place(std::string_view label) { return "request " + std::string(label); }
std::string host_error_place(std::string_view error_name) {
  return "host error " + std::string(error_name);
}
std::string case_place(std::string_view name) { return "case " + std::string(name); }

}  // namespace rr::conformance
