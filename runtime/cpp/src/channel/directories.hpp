// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "runtime/cpp/src/channel/socket.hpp"

/// The folders and files that nodes of one machine share (04, section 7).
namespace rr::channel {

/// Where they are for this user, by the environment.
struct NodeDirectories {
  std::filesystem::path user_run;
  std::filesystem::path system_run;
  std::filesystem::path user_config;
  std::filesystem::path user_state;
  std::string user_name;
  bool is_root = false;

  /// Of this process. Throws rr::Error (system_resource_error) when the user has no home.
  static NodeDirectories of_user();
};

/// `key: value` lines; the first of a key counts, other lines are not heeded. At most 64 KiB are
/// read. Empty for a file that cannot be read.
std::map<std::string, std::string> read_info_file(const std::filesystem::path& file);

/// A file that only one may hold: with a write lock on all of it (04, section 7.3).
class LockedFile {
 public:
  /// Makes the file, and the folders it is in, if missing. Throws rr::Error: invalid_operation when
  /// somebody holds it, system_resource_error when it cannot be opened.
  explicit LockedFile(const std::filesystem::path& file);
  /// Replaces its content. Throws rr::Error (system_resource_error).
  void write(const std::string& content);

  /// Whether somebody holds the file; false for one that cannot be read.
  static bool is_held(const std::filesystem::path& file);

 private:
  Descriptor file_;
  std::string name_;
};

}  // namespace rr::channel
