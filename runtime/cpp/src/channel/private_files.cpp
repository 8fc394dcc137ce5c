// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/channel/private_files.hpp"

#include <filesystem>
#include <system_error>

#include "rr/error.hpp"

namespace rr::channel {
namespace {

[[noreturn]] void refuse(const std::string& path, const std::string& why) {
  throw Error(ErrorCode::invalid_configuration, "`" + path + "`: " + why);
}

platform::File open_lock(const std::string& folder) {
  const std::string path = folder + "/.lock";
  std::error_code error;
  platform::File file = platform::open_exclusively(path, error);
  if (!file) refuse(path, error.message());
  return file;
}

}  // namespace

void replace_file(const std::string& path, std::span<const char> bytes, platform::Access access) {
  const std::string part = path + ".new";
  static_cast<void>(platform::remove_file(part));  // what an interrupted run has left
  std::error_code error = platform::write_new_file(part, bytes, access);
  if (!error) {
    error = platform::rename_file(part, path);
    if (error) static_cast<void>(platform::remove_file(part));
  }
  if (error) refuse(path, "it cannot be written: " + error.message());
}

void create_file(const std::string& path, std::span<const char> bytes, platform::Access access) {
  const std::error_code error = platform::write_new_file(path, bytes, access);
  if (error == std::errc::file_exists) {
    throw Error(ErrorCode::invalid_operation, "`" + path + "` is there already");
  }
  if (error) refuse(path, "it cannot be written: " + error.message());
}

void make_private_folder(const std::string& path) {
  const std::filesystem::path above = std::filesystem::path(path).parent_path();
  std::error_code error;
  if (!above.empty()) std::filesystem::create_directories(above, error);
  if (error) refuse(path, error.message());
  error = platform::make_private_folder(path);
  if (!error) return;
  const platform::FileState found = platform::state_of(path);
  if (error != std::errc::file_exists || found.size < 0) refuse(path, error.message());
  if (!found.is_folder) refuse(path, "it is no folder");
  if (found.may_others_write) refuse(path, "others may write into it");
}

FolderLock::FolderLock(const std::string& folder) : file_(open_lock(folder)) {}

}  // namespace rr::channel
