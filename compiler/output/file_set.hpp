// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace robdef {

class PendingFiles;

/// Files to be written: each name once, in the order of their names, together or not at all.
class FileSet {
 public:
  /// What write() did.
  struct Written {
    std::vector<std::string> changed;  ///< paths, relative to the folder
    std::string failure;               ///< empty when all is well; else nothing was changed
  };

  /// `path` is relative and uses `/`. Throws std::logic_error for a path that is there already, or
  /// that leads out of the folder.
  void add(const std::string& path, std::string content);

  /// The same for a file that the user goes on with: once it is there it is never touched again.
  void add_draft(const std::string& path, std::string content);
  /// A line for the user.
  void add_note(std::string note) { notes_.push_back(std::move(note)); }
  [[nodiscard]] const std::vector<std::string>& notes() const { return notes_; }

  [[nodiscard]] const std::map<std::string, std::string, std::less<>>& files() const {
    return files_;
  }
  [[nodiscard]] bool contains(std::string_view path) const { return files_.contains(path); }
  [[nodiscard]] bool is_draft(std::string_view path) const { return drafts_.contains(path); }

  /// Writes below `folder`, which is made when missing. A file that already has its content is not
  /// touched. All others are written beside their place first and renamed when all are complete, so
  /// a full disk or a folder without permission leaves everything as it was (PendingFiles).
  [[nodiscard]] Written write(const std::filesystem::path& folder) const;

  /// Only writes what changes beside its place: `pending` moves it there, with other files.
  [[nodiscard]] Written prepare(const std::filesystem::path& folder, PendingFiles& pending) const;

 private:
  // Two outputs that would be one file: a failure; empty when there are none.
  [[nodiscard]] std::string collision() const;

  std::map<std::string, std::string, std::less<>> files_;
  std::set<std::string, std::less<>> drafts_;
  std::vector<std::string> notes_;
};

}  // namespace robdef
