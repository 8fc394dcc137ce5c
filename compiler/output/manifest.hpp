// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/output/file_set.hpp"

/// What a run has made in a folder, so that a later one can remove what it no longer makes.
namespace robdef {

/// The files of one language in one output folder, with a hash of what was written into each. Files
/// that the user goes on with (FileSet::add_draft) are not among them.
class Manifest {
 public:
  /// `.robdef-cpp.manifest`
  static std::string file_name(std::string_view language);

  explicit Manifest(const FileSet& files);
  /// Of a former run. Empty when there is none, or it cannot be understood; lines that lead out of
  /// the folder are left out.
  static Manifest read(const std::filesystem::path& file);

  /// What read() reads.
  [[nodiscard]] std::string text(std::string_view language) const;
  [[nodiscard]] bool contains(std::string_view path) const { return hashes_.contains(path); }

  /// Those of `before` that are in this one no more, and for which `is_made` is false.
  [[nodiscard]] std::vector<std::string> stale(
      const Manifest& before, const std::function<bool(const std::string&)>& is_made) const;
  /// Goes on listing a file as a former run has made it.
  void keep(const std::string& path, const Manifest& before);

  /// Whether a file is below `folder`, not behind a link, and as it was written.
  [[nodiscard]] bool is_unedited(const std::filesystem::path& folder,
                                 const std::string& path) const;

 private:
  Manifest() = default;

  std::map<std::string, std::uint64_t, std::less<>> hashes_;
};

/// Removes a file, and the folders below `folder` that are empty then. False when it cannot.
bool remove_output(const std::filesystem::path& folder, const std::string& path);

}  // namespace robdef
