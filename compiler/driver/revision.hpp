// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "compiler/syntax/read.hpp"

namespace robdef {

/// Definitions in a revision of the git repository around the current folder. Runs `git`.
class Revision {
 public:
  /// `REVISION:PATH`, a file or folder as `git show` takes it: from the top of the repository, or
  /// behind `./` from the current folder. Throws VersionError.
  explicit Revision(const std::string& written);

  /// The file, or all definitions in the folder and below, in the order of their paths. Hidden
  /// folders are left out. Throws VersionError.
  [[nodiscard]] std::vector<ast::NamedText> definitions() const;
  /// The definition of a service that a text imports: beside it in the revision, else in the
  /// folders of the search path. Throws VersionError.
  [[nodiscard]] std::optional<ast::NamedText> find_import(const std::string& service,
                                                          const std::string& importing,
                                                          const ast::SearchPath& path) const;

 private:
  struct Blob {
    std::string mode;
    std::string hash;
    std::string size;  ///< as git prints it
  };

  void list(const std::string& tree, bool with_folders_below);
  [[nodiscard]] std::string text_of(const std::string& name) const;

  /// By names as messages call them: `HEAD~1:definitions/example.arm.robdef`.
  std::map<std::string, Blob> blobs_;
  std::vector<std::string> given_;
};

}  // namespace robdef
