// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/lsp/analysis.hpp"
#include "compiler/lsp/text.hpp"
#include "compiler/project/project.hpp"
#include "compiler/syntax/read.hpp"

namespace robdef::lsp {

/// What the command line and the environment say.
struct WorkspaceOptions {
  /// Folders of `-I`, then those of the environment.
  ast::SearchPath search_path;
  std::size_t own_import_folders = 0;         ///< those of `-I`
  std::vector<std::string_view> languages{};  ///< that tables of a project file may be called by
  std::string version{};                      ///< of the program
};

/// A file that the client edits.
struct Document {
  std::string uri;   ///< as the client writes it
  std::string path;  ///< one spelling for each file
  std::int64_t version = 0;
  Text text;
};

/// Open documents, which stand in place of their files, the files around them, and what both mean.
class Workspace {
 public:
  explicit Workspace(WorkspaceOptions options) : options_(std::move(options)) {}

  [[nodiscard]] const std::string& version() const { return options_.version; }

  void add_folder(std::string path) { folders_.push_back(std::move(path)); }
  void remove_folder(const std::string& path) { std::erase(folders_, path); }

  Document& open(const std::string& uri, std::int64_t version, std::string text);
  void close(const std::string& uri);
  /// nullptr for one that is not open.
  [[nodiscard]] Document* find(const std::string& uri);
  [[nodiscard]] const std::map<std::string, Document>& documents() const { return documents_; }

  /// The text of a document has changed, or a file on the disk: what was found with it is
  /// out of date.
  void forget(const std::string& path);
  /// A project file, or which files there are: everything is out of date.
  void forget_all();

  /// Of an open document, else of a file; nullptr when it cannot be read.
  std::shared_ptr<const Analysis> analysis(const std::string& path);
  /// Whether an open document's diagnostics may depend on a file.
  bool depends(const Document& document, const std::string& path);

  /// All definitions: open ones, those below the folders, the inputs of projects. Sorted; at most
  /// 10,000 of folders.
  std::vector<std::string> files();
  /// Services that a file could import, by file names and open documents. Sorted, each once.
  std::vector<std::string> importable_services(const std::string& path);
  /// The text of an open document or a file.
  std::optional<std::string> text_of(const std::string& path) const;
  /// As the client writes it, when it has opened the file.
  [[nodiscard]] std::string uri_of_path(const std::string& path) const;

 private:
  struct LoadedProject {
    project::Project project;
    std::filesystem::file_time_type written;
    std::map<std::string, std::string> inputs;  ///< services and their paths
  };

  const LoadedProject* project_of(const std::string& path);
  /// What was found in an open document, or in an earlier version of it.
  struct Known {
    std::shared_ptr<Analysis> analysis;
    bool is_outdated = false;
  };

  std::shared_ptr<Analysis> analyse(const std::string& path, std::string text,
                                    std::shared_ptr<Analysis> earlier);
  std::optional<ast::NamedText> find_import(const std::string& service,
                                            const std::string& importing,
                                            const LoadedProject* project, Analysis& analysis);
  ast::SearchPath search_path_of(const LoadedProject* project) const;
  [[nodiscard]] bool is_current(const Analysis& analysis) const;

  const WorkspaceOptions options_;
  std::vector<std::string> folders_;
  std::map<std::string, Document> documents_;      // by path
  std::map<std::string, std::string> open_paths_;  // by URI
  std::map<std::string, LoadedProject> projects_;  // by path
  std::map<std::string, Known> analyses_;          // of open documents
};

/// The one spelling of the path of a URI; what is no file stands for itself.
std::string identity_of_uri(std::string_view uri);

/// The name on the service line, looked for without reading the rest; empty when there is none.
std::string declared_service(std::string_view text);

}  // namespace robdef::lsp
