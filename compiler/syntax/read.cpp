// SPDX-License-Identifier: Apache-2.0
#include "compiler/syntax/read.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string_view>
#include <system_error>
#include <unordered_map>
#include <unordered_set>
#include <utility>

namespace robdef::ast {
namespace {

namespace fs = std::filesystem;

// Far beyond any definition, and well within what a span can reach.
constexpr std::size_t largest_file = 64U << 20U;

std::string reason(int code) {
  return "cannot be read: " + std::error_code(code, std::generic_category()).message();
}

struct CloseFile {
  void operator()(std::FILE* file) const {
    if (file != stdin) std::fclose(file);
  }
};

using OpenFile = std::unique_ptr<std::FILE, CloseFile>;

bool exists(const std::string& path) {
  std::error_code error;
  return fs::exists(path, error);
}

// Where the first folder of a list ends. Folders may have a `:` in their names: of what begins the
// list, the longest text that names a folder is one.
std::size_t first_folder_end(std::string_view list, std::string_view separators) {
  const std::size_t first = std::min(list.find_first_of(separators), list.size());
  std::size_t result = first;
  constexpr int most_colons = 16;
  std::size_t end = first;
  for (int colon = 0; colon < most_colons && end < list.size() && list[end] == ':'; ++colon) {
    end = std::min(list.find_first_of(separators, end + 1), list.size());
    std::error_code error;
    const bool is_whole = end > 0 && list[end - 1] != ':';
    if (is_whole && fs::is_directory(fs::path(list.substr(0, end)), error)) result = end;
  }
  return result;
}

class Loader {
 public:
  // Without `find` imports are files.
  Loader(const SearchPath& path, Sources& sources, Report& report, FindImport find = {},
         EarlierFiles earlier = {})
      : path_(path),
        sources_(sources),
        report_(report),
        find_(std::move(find)),
        earlier_(std::move(earlier)) {}

  Program run(const std::vector<std::string>& inputs) {
    for (const std::string& input : inputs) load_input(input);
    follow_imports();
    return std::move(program_);
  }

  Program run(std::vector<NamedText> texts) {
    for (NamedText& text : texts) {
      const SourceId id = sources_.add(std::move(text.name), std::move(text.text));
      add(parsed(id), text.is_import);
    }
    if (find_) follow_imports();
    return std::move(program_);
  }

 private:
  void load_input(const std::string& path) {
    if (!loaded_.insert(identity_of(path)).second) return;
    FileText read = read_file(path);
    const bool is_read = read.text.has_value();
    const SourceId id =
        sources_.add(shown_name(path), std::move(read.text).value_or(std::string()));
    if (is_read) {
      add(parsed(id), false);
    } else if (read.is_missing) {
      report_.add(Code::R0509, {id, 0, 0}, fmt::format("there is no file `{}`", path));
    } else {
      report_.add(Code::R0510, {id, 0, 0}, fmt::format("`{}` {}", path, read.failure));
    }
  }

  File parsed(SourceId id) {
    const Source& source = sources_[id];
    auto earlier = earlier_.extract(source.name());
    return earlier ? parse(source, id, report_, std::move(earlier.mapped()))
                   : parse(source, id, report_);
  }

  void add(File file, bool is_import) {
    if (file.service) {
      const auto [first, is_new] = services_.try_emplace(file.service->text, file.service->span);
      if (!is_new) {
        report_
            .add(Code::R0511, file.service->span,
                 fmt::format("the service `{}` is defined twice", file.service->text))
            .also(first->second, "first here");
        return;
      }
    }
    program_.files.push_back({std::move(file), is_import});
  }

  // Files are appended while the list is walked, so imports of imports are met as well.
  void follow_imports() {
    for (std::size_t file = 0; file < program_.files.size(); ++file) {
      const std::size_t count = program_.files[file].file.imports.size();
      for (std::size_t import = 0; import < count; ++import) {
        // A copy: the list moves when a file is added.
        const Name name = program_.files[file].file.imports[import].name;
        if (services_.contains(name.text)) continue;
        const bool is_fit = find_ ? load_found(name) : load_import(name);
        program_.files[file].file.imports[import].is_reported = !is_fit;
      }
    }
  }

  // False if something was found that is not the definition.
  bool load_import(const Name& name) {
    const std::string path = find(name);
    if (path.empty()) return true;
    FileText read = read_file(path);
    if (!read.text) {
      report_.add(Code::R0510, name.span, fmt::format("`{}` {}", path, read.failure))
          .label("imported here");
      return false;
    }
    if (!loaded_.insert(identity_of(path)).second) return true;
    return add_import(name, path, *std::move(read.text));
  }

  bool load_found(const Name& name) {
    std::optional<NamedText> found = find_(name.text, sources_[name.span.source].name());
    if (!found || !loaded_.insert(found->name).second) return true;
    return add_import(name, found->name, std::move(found->text));
  }

  bool add_import(const Name& name, const std::string& path, std::string text) {
    const SourceId id = sources_.add(path, std::move(text));
    File file = parsed(id);
    // Without a name the file has a mistake of its own.
    if (file.service && file.service->text != name.text) {
      report_
          .add(Code::R0512, name.span,
               fmt::format("`{}` is not the definition of `{}`", path, name.text))
          .label("imported here")
          .also(file.service->span, "the file defines this service");
      return false;
    }
    add(std::move(file), true);
    return true;
  }

  // Empty when there is none.
  [[nodiscard]] std::string find(const Name& name) const {
    for (std::string& place : import_places(name.text, sources_[name.span.source].name(), path_)) {
      if (exists(place)) return std::move(place);
    }
    return {};
  }

  const SearchPath& path_;
  Sources& sources_;
  Report& report_;
  const FindImport find_;
  EarlierFiles earlier_;
  Program program_;
  std::unordered_map<std::string, Span> services_;
  std::unordered_set<std::string> loaded_;
};

}  // namespace

bool is_standard_input(std::string_view path) { return path == "-"; }

std::string shown_name(const std::string& path) {
  return is_standard_input(path) ? "<stdin>" : path;
}

std::string identity_of(const std::string& path) {
  std::error_code error;
  const fs::path result = fs::weakly_canonical(path, error);
  return error || is_standard_input(path) ? path : result.string();
}

FileText read_file(const std::string& path) {
  std::error_code error;
  // Opening a folder for reading succeeds on some systems.
  if (fs::is_directory(path, error)) return {std::nullopt, reason(EISDIR), false};
  const OpenFile file(is_standard_input(path) ? stdin : std::fopen(path.c_str(), "rb"));
  if (!file) return {std::nullopt, reason(errno), errno == ENOENT};
  FileText read{std::string(), {}, false};
  std::array<char, 65536> buffer;
  for (std::size_t count = 1; count > 0;) {
    count = std::fread(buffer.data(), 1, buffer.size(), file.get());
    read.text->append(buffer.data(), count);
    if (read.text->size() > largest_file) {
      static_assert(largest_file == 64U << 20U);
      return {std::nullopt, "cannot be read: it is larger than 64 MiB", false};
    }
  }
  if (std::ferror(file.get()) != 0) return {std::nullopt, reason(errno), false};
  return read;
}

SearchPath make_search_path(std::vector<std::string> folders, std::string_view variable,
                            std::string_view separators) {
  SearchPath path{std::move(folders)};
  while (!variable.empty()) {
    const std::size_t end = first_folder_end(variable, separators);
    if (end > 0) path.folders.emplace_back(variable.substr(0, end));
    variable.remove_prefix(std::min(end + 1, variable.size()));
  }
  return path;
}

std::vector<std::string> import_places(const std::string& service, const std::string& importing,
                                       const SearchPath& path) {
  const std::string file = service + ".robdef";
  std::vector<std::string> places{(fs::path(importing).parent_path() / file).generic_string()};
  for (const std::string& folder : path.folders) {
    places.push_back((fs::path(folder) / file).generic_string());
  }
  return places;
}

Program read(const std::vector<std::string>& inputs, const SearchPath& path, Sources& sources,
             Report& report) {
  return Loader(path, sources, report).run(inputs);
}

Program read_texts(std::vector<NamedText> texts, Sources& sources, Report& report) {
  const SearchPath nowhere;
  return Loader(nowhere, sources, report).run(std::move(texts));
}

Program read_texts(std::vector<NamedText> texts, const FindImport& find, Sources& sources,
                   Report& report, EarlierFiles earlier) {
  const SearchPath nowhere;
  return Loader(nowhere, sources, report, find, std::move(earlier)).run(std::move(texts));
}

}  // namespace robdef::ast
