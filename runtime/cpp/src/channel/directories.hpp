// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>

#include "runtime/cpp/src/platform/files.hpp"
#include "runtime/cpp/src/platform/node_folders.hpp"

/// The folders and files that nodes of one machine share (04, section 7).
namespace rr::channel {

/// The name of the user that the process runs as; throws rr::Error (system_resource_error).
std::string own_user_name();
/// `key: value` lines; the first of a key counts, other lines are not heeded. Empty for a file that
/// cannot be read, is larger, or is a link.
std::map<std::string, std::string> read_info_file(const std::filesystem::path& file);

/// A file that only one may hold: with a write lock on all of it (04, section 7.3).
class LockedFile {
 public:
  /// Makes the file, and the folders it is in, if missing. Throws rr::Error: invalid_operation when
  /// somebody holds it, and `what` says what that means; system_resource_error when it cannot be
  /// opened.
  LockedFile(const std::filesystem::path& file, std::string_view what);
  /// Replaces its content. Throws rr::Error (system_resource_error).
  void write(const std::string& content) const;

  /// Whether somebody holds the file; false for one that cannot be read.
  static bool is_held(const std::filesystem::path& file);

 private:
  platform::File file_;
  std::string name_;
};

}  // namespace rr::channel
