// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace robdef {

/// Files that take their places together: written beside them first, then renamed. When one cannot
/// be renamed, those that were renamed before it get their old content back.
///
///   PendingFiles files;
///   std::string failure = files.write("a.txt", "new");
///   if (failure.empty()) failure = files.move_all();
class PendingFiles {
 public:
  PendingFiles() = default;
  PendingFiles(const PendingFiles&) = delete;
  PendingFiles& operator=(const PendingFiles&) = delete;
  /// Removes what was not moved.
  ~PendingFiles();

  /// Writes `content` beside `target`, whose folder is made when missing. A file that is there
  /// keeps its permissions. Returns why it failed, with the path; empty when it did not.
  [[nodiscard]] std::string write(const std::filesystem::path& target, std::string_view content);

  /// Moves all files to their places, or none: returns why; empty when all are there.
  [[nodiscard]] std::string move_all();

 private:
  struct File {
    std::filesystem::path target;
    std::filesystem::path fresh;  ///< the new content
    std::filesystem::path old;    ///< the content before; empty: there was no file
    bool is_moved = false;
  };

  static std::string move(File& file);
  void restore();
  void forget_old();

  std::vector<File> files_;
};

}  // namespace robdef
