// SPDX-License-Identifier: Apache-2.0
#include "compiler/project/globs.hpp"

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <system_error>

namespace robdef::project {
namespace {

namespace fs = std::filesystem;

/// What stands between `[` and `]`: letters, and ranges of them.
bool is_in_set(std::string_view set, char letter) {
  for (std::size_t at = 0; at < set.size(); ++at) {
    const bool is_range = at + 2 < set.size() && set[at + 1] == '-';
    const char last = set[is_range ? at + 2 : at];
    if (letter >= set[at] && letter <= last) return true;
    if (is_range) at += 2;
  }
  return false;
}

/// Takes one letter of `name` by what begins `pattern`, which is no `*`. The pattern's next place;
/// 0: the letter does not fit.
std::size_t taken(std::string_view pattern, char letter) {
  if (pattern[0] == '?') return 1;
  if (pattern[0] == '[') {
    const bool is_other = pattern.size() > 1 && (pattern[1] == '!' || pattern[1] == '^');
    const std::size_t begin = is_other ? 2 : 1;
    // The first letter of a set may be `]`.
    const std::size_t end = pattern.find(']', begin + 1);
    if (end != pattern.npos) {
      return is_in_set(pattern.substr(begin, end - begin), letter) != is_other ? end + 1 : 0;
    }
  }
  const bool is_escaped = pattern[0] == '\\' && pattern.size() > 1;
  return pattern[is_escaped ? 1 : 0] == letter ? (is_escaped ? 2 : 1) : 0;
}

/// Whether a pattern stands for a name: not by fnmatch(), which Windows has not. A point at the
/// beginning of a name is written out.
bool fits(std::string_view pattern, std::string_view name) {
  if (name.starts_with('.') && !pattern.starts_with('.') && !pattern.starts_with("\\."))
    return false;
  // Where the last `*` was, and how much of the name it takes.
  std::size_t star = pattern.npos;
  std::size_t star_end = 0;
  std::size_t at = 0;
  std::size_t letter = 0;
  while (letter < name.size()) {
    if (at < pattern.size() && pattern[at] == '*') {
      star = at++;
      star_end = letter;
      continue;
    }
    const std::size_t step = at < pattern.size() ? taken(pattern.substr(at), name[letter]) : 0;
    if (step != 0) {
      at += step;
      ++letter;
    } else if (star != pattern.npos) {
      at = star + 1;
      letter = ++star_end;
    } else {
      return false;
    }
  }
  return pattern.find_first_not_of('*', at) == pattern.npos;
}

/// Goes through a pattern, segment by segment.
class Matcher {
 public:
  explicit Matcher(const std::string& pattern) {
    const fs::path path(pattern);
    for (const fs::path& part : path.relative_path()) segments_.push_back(part.string());
    root_ = path.root_path();
  }

  std::vector<std::string> run() {
    match(root_, 0);
    std::ranges::sort(found_);
    const auto repeated = std::ranges::unique(found_);
    found_.erase(repeated.begin(), repeated.end());
    return std::move(found_);
  }

 private:
  void match(const fs::path& folder, std::size_t at) {
    std::error_code error;
    if (at == segments_.size()) {
      if (fs::is_regular_file(folder, error)) found_.push_back(folder.generic_string());
      return;
    }
    const std::string& segment = segments_[at];
    if (segment == "**") {
      match(folder, at + 1);
      for (const fs::directory_entry& entry : entries(folder)) {
        const bool is_folder = entry.is_directory(error) && !entry.is_symlink(error);
        const std::string name = entry.path().filename().string();
        if (is_folder && !name.starts_with('.')) match(folder / name, at);
      }
    } else if (!is_pattern(segment)) {
      match(folder / segment, at + 1);
    } else {
      for (const fs::directory_entry& entry : entries(folder)) {
        const std::string name = entry.path().filename().string();
        if (fits(segment, name)) match(folder / name, at + 1);
      }
    }
  }

  // None where it cannot be read.
  static std::vector<fs::directory_entry> entries(const fs::path& folder) {
    std::error_code error;
    std::vector<fs::directory_entry> result;
    for (auto entry = fs::directory_iterator(folder.empty() ? "." : folder, error);
         !error && entry != fs::directory_iterator(); entry.increment(error)) {
      result.push_back(*entry);
    }
    return result;
  }

  fs::path root_;
  std::vector<std::string> segments_;
  std::vector<std::string> found_;
};

}  // namespace

bool is_pattern(std::string_view path) { return path.find_first_of("*?[") != path.npos; }

std::vector<std::string> matching_files(const std::string& pattern) {
  return Matcher(pattern).run();
}

}  // namespace robdef::project
