// SPDX-License-Identifier: Apache-2.0
#include "compiler/syntax/read.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string_view>
#include <system_error>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "compiler/syntax/parse.hpp"

namespace robdef::ast {
namespace {

namespace fs = std::filesystem;

// Far beyond any definition, and well within what a span can reach.
constexpr std::size_t largest_file = 64U << 20U;

// What is in a file, or that it cannot be read and why, as far as that is known.
struct Contents {
  std::optional<std::string> text;
  std::string_view failure = "cannot be read";
};

Contents read_file(const std::string& path) {
  std::error_code error;
  // Opening a folder for reading succeeds on some systems.
  if (fs::is_directory(path, error)) return {};
  std::ifstream file(path, std::ios::binary);
  if (!file) return {};
  std::string text;
  std::array<char, 65536> buffer;
  do {
    file.read(buffer.data(), buffer.size());
    text.append(buffer.data(), static_cast<std::size_t>(file.gcount()));
    if (text.size() > largest_file) {
      static_assert(largest_file == 64U << 20U);
      return {std::nullopt, "cannot be read: it is larger than 64 MiB"};
    }
  } while (file);
  if (file.bad()) return {};
  return {std::move(text)};
}

bool exists(const std::string& path) {
  std::error_code error;
  return fs::exists(path, error);
}

// One spelling for each file, so that a file given twice is loaded once.
std::string identity(const std::string& path) {
  std::error_code error;
  const fs::path result = fs::weakly_canonical(path, error);
  return error ? path : result.string();
}

class Loader {
 public:
  Loader(const SearchPath& path, Sources& sources, Report& report)
      : path_(path), sources_(sources), report_(report) {}

  Program run(const std::vector<std::string>& inputs) {
    for (const std::string& input : inputs) load_input(input);
    follow_imports();
    return std::move(program_);
  }

  Program run(std::vector<NamedText> texts) {
    for (NamedText& text : texts) {
      const SourceId id = sources_.add(std::move(text.name), std::move(text.text));
      add(parse(sources_[id], id, report_), text.is_import);
    }
    return std::move(program_);
  }

 private:
  void load_input(const std::string& path) {
    if (!loaded_.insert(identity(path)).second) return;
    auto [text, failure] = read_file(path);
    const bool is_found = text.has_value();
    const SourceId id = sources_.add(path, std::move(text).value_or(std::string()));
    if (is_found) {
      add(parse(sources_[id], id, report_), false);
    } else if (exists(path)) {
      report_.add(Code::R0510, {id, 0, 0}, fmt::format("`{}` {}", path, failure));
    } else {
      report_.add(Code::R0509, {id, 0, 0}, fmt::format("there is no file `{}`", path));
    }
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
        const bool is_fit = load_import(name);
        program_.files[file].file.imports[import].is_reported = !is_fit;
      }
    }
  }

  // False if something was found that is not the definition.
  bool load_import(const Name& name) {
    const std::string path = find(name);
    if (path.empty()) return true;
    auto [text, failure] = read_file(path);
    if (!text) {
      report_.add(Code::R0510, name.span, fmt::format("`{}` {}", path, failure))
          .label("imported here");
      return false;
    }
    if (!loaded_.insert(identity(path)).second) return true;
    const SourceId id = sources_.add(path, *std::move(text));
    File file = parse(sources_[id], id, report_);
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
    const std::string file = name.text + ".robdef";
    const fs::path importing(sources_[name.span.source].name());
    std::string beside = (importing.parent_path() / file).string();
    if (exists(beside)) return beside;
    for (const std::string& folder : path_.folders) {
      std::string candidate = (fs::path(folder) / file).string();
      if (exists(candidate)) return candidate;
    }
    return {};
  }

  const SearchPath& path_;
  Sources& sources_;
  Report& report_;
  Program program_;
  std::unordered_map<std::string, Span> services_;
  std::unordered_set<std::string> loaded_;
};

}  // namespace

SearchPath make_search_path(std::vector<std::string> folders, std::string_view variable) {
  SearchPath path{std::move(folders)};
  while (!variable.empty()) {
    const std::size_t end = std::min(variable.find_first_of(":;"), variable.size());
    if (end > 0) path.folders.emplace_back(variable.substr(0, end));
    variable.remove_prefix(std::min(end + 1, variable.size()));
  }
  return path;
}

Program read(const std::vector<std::string>& inputs, const SearchPath& path, Sources& sources,
             Report& report) {
  return Loader(path, sources, report).run(inputs);
}

Program read_texts(std::vector<NamedText> texts, Sources& sources, Report& report) {
  const SearchPath nowhere;
  return Loader(nowhere, sources, report).run(std::move(texts));
}

}  // namespace robdef::ast
