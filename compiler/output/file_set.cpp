// SPDX-License-Identifier: Apache-2.0
#include "compiler/output/file_set.hpp"

#include <fstream>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "compiler/output/pending_files.hpp"
#include "compiler/system/conventions.hpp"

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

}  // namespace

void FileSet::add(const std::string& path, std::string content) {
  const fs::path normal = fs::path(path).lexically_normal();
  if (path.empty() || normal.has_root_path() || *normal.begin() == ".." || !normal.has_filename()) {
    throw std::logic_error("`" + path + "` is no path of a file below the output folder");
  }
  if (!files_.emplace(normal.generic_string(), std::move(content)).second) {
    throw std::logic_error("two outputs are called `" + path + "`");
  }
}

void FileSet::add_draft(const std::string& path, std::string content) {
  std::string normal = fs::path(path).lexically_normal().generic_string();
  add(path, std::move(content));
  drafts_.insert(std::move(normal));
}

std::string FileSet::collision() const {
  std::map<std::string, std::string> spelled;
  for (const auto& [path, content] : files_) {
    const auto [first, is_new] = spelled.emplace(system::one_spelling(path), path);
    if (!is_new) return path + ": is the same file as " + first->second + " on this system";
  }
  return {};
}

FileSet::Written FileSet::prepare(const fs::path& folder, PendingFiles& pending) const {
  Written written;
  written.failure = collision();
  if (!written.failure.empty()) return written;
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
  return written;
}

FileSet::Written FileSet::write(const fs::path& folder) const {
  PendingFiles pending;
  Written written = prepare(folder, pending);
  if (!written.failure.empty()) return written;
  written.failure = pending.move_all();
  if (!written.failure.empty()) written.changed.clear();
  return written;
}

}  // namespace robdef
