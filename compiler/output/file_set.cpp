// SPDX-License-Identifier: Apache-2.0
#include "compiler/output/file_set.hpp"

#include <fstream>
#include <stdexcept>
#include <system_error>
#include <utility>

namespace robdef {
namespace {

namespace fs = std::filesystem;

bool holds(const fs::path& file, std::string_view content) {
  std::error_code error;
  if (!fs::is_regular_file(file, error) || fs::file_size(file, error) != content.size()) {
    return false;
  }
  std::ifstream in(file, std::ios::binary);
  std::string there(content.size(), '\0');
  in.read(there.data(), static_cast<std::streamsize>(there.size()));
  return in && there == content;
}

/// Files written beside their places. Those that were not moved are removed at the end.
class Pending {
 public:
  Pending() = default;
  Pending(const Pending&) = delete;
  Pending& operator=(const Pending&) = delete;
  ~Pending() {
    std::error_code ignored;
    for (const auto& [temporary, target] : files_) fs::remove(temporary, ignored);
  }

  /// Empty when it went well.
  std::string write(const fs::path& target, std::string_view content) {
    std::error_code error;
    fs::create_directories(target.parent_path(), error);
    if (error) return target.parent_path().string() + ": " + error.message();
    if (fs::is_directory(target, error)) return target.string() + ": is a folder";
    const fs::path temporary = target.string() + ".robdef-new";
    files_.emplace_back(temporary, target);
    std::ofstream out(temporary, std::ios::binary | std::ios::trunc);
    out.write(content.data(), static_cast<std::streamsize>(content.size()));
    out.close();
    return out ? std::string() : target.string() + ": cannot be written";
  }

  std::string move_all() {
    for (const auto& [temporary, target] : files_) {
      std::error_code error;
      fs::rename(temporary, target, error);
      if (error) return target.string() + ": " + error.message();
    }
    files_.clear();
    return {};
  }

 private:
  std::vector<std::pair<fs::path, fs::path>> files_;
};

}  // namespace

void FileSet::add(std::string path, std::string content) {
  const fs::path normal = fs::path(path).lexically_normal();
  if (path.empty() || normal.is_absolute() || *normal.begin() == ".." || !normal.has_filename()) {
    throw std::logic_error("`" + path + "` is no path of a file below the output folder");
  }
  if (!files_.emplace(normal.generic_string(), std::move(content)).second) {
    throw std::logic_error("two outputs are called `" + path + "`");
  }
}

void FileSet::add_draft(std::string path, std::string content) {
  std::string normal = fs::path(path).lexically_normal().generic_string();
  add(std::move(path), std::move(content));
  drafts_.insert(std::move(normal));
}

FileSet::Written FileSet::write(const std::filesystem::path& folder) const {
  Written written;
  Pending pending;
  for (const auto& [path, content] : files_) {
    const fs::path target = folder / path;
    std::error_code error;
    if (drafts_.contains(path) && fs::exists(target, error)) continue;
    if (holds(target, content)) continue;
    written.failure = pending.write(target, content);
    if (!written.failure.empty()) {
      written.changed.clear();
      return written;
    }
    written.changed.push_back(path);
  }
  written.failure = pending.move_all();
  return written;
}

}  // namespace robdef
