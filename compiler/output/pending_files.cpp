// SPDX-License-Identifier: Apache-2.0
#include "compiler/output/pending_files.hpp"

#include <cerrno>
#include <fstream>
#include <system_error>

namespace robdef {
namespace {

namespace fs = std::filesystem;

std::string failed(const fs::path& path, const std::error_code& why) {
  return path.generic_string() + ": " + why.message();
}

// Empty when it went well.
std::string write_file(const fs::path& path, std::string_view content) {
  errno = 0;
  std::ofstream out(path, std::ios::binary | std::ios::trunc);
  out.write(content.data(), static_cast<std::streamsize>(content.size()));
  out.close();
  if (out) return {};
  const std::error_code why(errno, std::generic_category());
  return why ? why.message() : "cannot be written";
}

// A second name for a file, or a copy where the file system has none.
std::error_code keep(const fs::path& file, const fs::path& as) {
  std::error_code error;
  fs::remove(as, error);
  fs::create_hard_link(file, as, error);
  if (!error) return error;
  error.clear();
  fs::copy_file(file, as, fs::copy_options::overwrite_existing, error);
  return error;
}

}  // namespace

PendingFiles::~PendingFiles() {
  std::error_code ignored;
  for (const File& file : files_) {
    if (!file.is_moved) fs::remove(file.fresh, ignored);
  }
}

std::string PendingFiles::write(const fs::path& target, std::string_view content) {
  std::error_code error;
  if (target.has_parent_path()) fs::create_directories(target.parent_path(), error);
  if (error) return failed(target.parent_path(), error);
  const fs::file_status before = fs::status(target, error);
  if (fs::is_directory(before)) return target.generic_string() + ": is a folder";
  const fs::path fresh = target.string() + ".robdef-new";
  files_.push_back({target, fresh, {}, false});
  const std::string failure = write_file(fresh, content);
  if (!failure.empty()) return target.generic_string() + ": " + failure;
  if (fs::is_regular_file(before)) fs::permissions(fresh, before.permissions(), error);
  return {};
}

std::string PendingFiles::move_all() {
  for (File& file : files_) {
    const std::string failure = move(file);
    if (failure.empty()) continue;
    restore();
    return failure;
  }
  forget_old();
  files_.clear();
  return {};
}

std::string PendingFiles::move(File& file) {
  std::error_code error;
  if (fs::is_regular_file(file.target, error)) {
    file.old = file.target.string() + ".robdef-old";
    if (const std::error_code why = keep(file.target, file.old)) return failed(file.target, why);
  }
  fs::rename(file.fresh, file.target, error);
  if (error) return failed(file.target, error);
  file.is_moved = true;
  return {};
}

void PendingFiles::restore() {
  std::error_code ignored;
  for (const File& file : files_) {
    if (!file.is_moved) {
      if (!file.old.empty()) fs::remove(file.old, ignored);
    } else if (file.old.empty()) {
      fs::remove(file.target, ignored);
    } else {
      fs::rename(file.old, file.target, ignored);
    }
  }
}

void PendingFiles::forget_old() {
  std::error_code ignored;
  for (const File& file : files_) {
    if (!file.old.empty()) fs::remove(file.old, ignored);
  }
}

}  // namespace robdef
