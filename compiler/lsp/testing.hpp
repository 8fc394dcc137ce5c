// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/lsp/server.hpp"

/// For tests: an editor without a screen.
namespace robdef::lsp::testing {

/// A folder with files, a server, and what the server has sent.
class Editor {
 public:
  explicit Editor(Json capabilities = Json::object());
  ~Editor();
  Editor(const Editor&) = delete;
  Editor& operator=(const Editor&) = delete;

  /// Writes a file of the folder.
  void write(std::string_view name, std::string_view text) const;
  [[nodiscard]] std::string uri(std::string_view name) const;

  void open(std::string_view name, std::string_view text);
  /// Replaces a range of an open document.
  void edit(std::string_view name, const Range& range, std::string_view text);
  void close(std::string_view name);

  /// The whole answer.
  Json call(const char* method, Json params);
  void notify(const char* method, Json params);
  /// The result of a request about a place; an error is a failure of the test.
  Json at(const char* method, std::string_view name, Place place, Json more = Json::object());
  Json of(const char* method, std::string_view name);

  /// Those that were published last for a file.
  Json diagnostics(std::string_view name);
  /// Their codes.
  std::vector<std::string> codes(std::string_view name);

  Server server;
  std::vector<Json> sent;

 private:
  std::filesystem::path folder_;
  int next_id_ = 1;
  int version_ = 1;
};

/// The text after edits of a TextEdit list.
std::string with_edits(std::string text, const Json& edits);

}  // namespace robdef::lsp::testing
