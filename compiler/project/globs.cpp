// SPDX-License-Identifier: Apache-2.0
#include "compiler/project/globs.hpp"

#include <fnmatch.h>

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <system_error>

namespace robdef::project {
namespace {

namespace fs = std::filesystem;

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
        const bool fits = ::fnmatch(segment.c_str(), name.c_str(), FNM_PERIOD) == 0;
        if (fits) match(folder / name, at + 1);
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
