// SPDX-License-Identifier: Apache-2.0
// Finds the project file, and gives its keys their meaning.
#include "compiler/project/project.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <set>
#include <system_error>
#include <utility>

#include "compiler/diagnostics/spelling.hpp"
#include "compiler/project/globs.hpp"
#include "compiler/project/toml_file.hpp"
#include "compiler/syntax/read.hpp"

namespace robdef::project {
namespace {

namespace fs = std::filesystem;

using Kind = Value::Kind;

/// What is done with the value of a key.
struct Key {
  std::string_view name;
  std::function<void(const Value::Entry&)> take;
};

class Reader {
 public:
  Reader(Project& project, const std::vector<std::string_view>& languages, Report& report)
      : project_(project),
        languages_(languages),
        folder_(fs::path(project.path).parent_path()),
        report_(report) {}

  void run(const Value& file) {
    std::vector<Key> keys = {
        {"inputs", [&](const auto& entry) { take_inputs(entry); }},
        {"import-path", [&](const auto& entry) { take_import_folders(entry); }},
        {"strict", [&](const auto& entry) { take_strict(entry); }},
        {"levels", [&](const auto& entry) { take_levels(entry); }},
        {"plugin", [&](const auto& entry) { take_plugins(entry); }},
    };
    for (const std::string_view language : languages_) {
      keys.push_back({language, [&](const auto& entry) { take_language(entry); }});
    }
    take_all(file, keys, "");
    const auto place = [&](const Language& one) {
      return std::ranges::find(languages_, one.name) - languages_.begin();
    };
    std::ranges::sort(project_.languages, {}, place);
  }

 private:
  void take_all(const Value& table, const std::vector<Key>& keys, const std::string& owner) {
    for (const Value::Entry& entry : table.entries) {
      const auto key = std::ranges::find(keys, entry.key, &Key::name);
      if (key == keys.end()) {
        unknown_key(entry, keys, owner);
      } else {
        key->take(entry);
      }
    }
  }

  void unknown_key(const Value::Entry& entry, const std::vector<Key>& keys,
                   const std::string& owner) {
    std::vector<std::string_view> names;
    std::string all;
    for (const Key& key : keys) {
      names.push_back(key.name);
      all += fmt::format("{}`{}`", all.empty() ? "" : ", ", key.name);
    }
    const std::string_view near = nearest(entry.key, names);
    Diagnostic& diagnostic =
        report_.add(Code::R0802, entry.span, fmt::format("unknown key `{}`", entry.key));
    diagnostic.label(owner.empty() ? "no key of a project file"
                                   : fmt::format("no key of `[{}]`", owner));
    diagnostic.help(near.empty() ? "known: " + all : fmt::format("did you mean `{}`?", near));
  }

  bool has_kind(const Value::Entry& entry, Kind kind, std::string_view wanted) {
    if (entry.value.kind == kind) return true;
    report_
        .add(Code::R0803, entry.value.span,
             fmt::format("`{}` has a value of another type", entry.key))
        .label(fmt::format("expected {}", wanted));
    return false;
  }

  /// The texts of a list, with what is wrong reported.
  std::vector<const Value*> texts(const Value::Entry& entry) {
    std::vector<const Value*> result;
    if (entry.value.kind == Kind::text) {
      report_
          .add(Code::R0803, entry.value.span,
               fmt::format("`{}` has a value of another type", entry.key))
          .label("expected a list")
          .help(fmt::format("write `{} = [\"{}\"]`", entry.key, entry.value.text));
      return result;
    }
    if (!has_kind(entry, Kind::list, "a list of texts")) return result;
    for (const Value& item : entry.value.items) {
      if (item.kind == Kind::text && !item.text.empty()) {
        result.push_back(&item);
      } else {
        report_
            .add(Code::R0803, item.span, fmt::format("`{}` has an item of another type", entry.key))
            .label("expected a text that is not empty");
      }
    }
    return result;
  }

  /// Seen from the current folder. One that is given whole stays.
  [[nodiscard]] std::string placed(const std::string& path) const {
    const std::string result = (folder_ / path).lexically_normal().generic_string();
    return result;
  }

  void take_inputs(const Value::Entry& entry) {
    project_.has_inputs = true;
    std::set<std::string> seen;
    for (const Value* item : texts(entry)) {
      for (std::string& file : files_of(*item)) {
        if (seen.insert(ast::identity_of(file)).second) project_.inputs.push_back(std::move(file));
      }
    }
  }

  std::vector<std::string> files_of(const Value& item) {
    std::string path = placed(item.text);
    if (is_pattern(item.text)) {
      std::vector<std::string> files = matching_files(path);
      if (files.empty()) {
        report_.add(Code::R0804, item.span, fmt::format("no file fits `{}`", item.text))
            .help(fmt::format("paths begin at the folder of {}", file_name));
      }
      return files;
    }
    std::error_code error;
    if (fs::exists(path, error)) return {std::move(path)};
    report_.add(Code::R0804, item.span, fmt::format("there is no file `{}`", path))
        .help(fmt::format("paths begin at the folder of {}", file_name));
    return {};
  }

  void take_import_folders(const Value::Entry& entry) {
    for (const Value* item : texts(entry)) project_.import_folders.push_back(placed(item->text));
  }

  void take_strict(const Value::Entry& entry) {
    if (has_kind(entry, Kind::flag, "`true` or `false`")) project_.is_strict = entry.value.is_true;
  }

  void take_levels(const Value::Entry& levels) {
    if (!has_kind(levels, Kind::table, "a table")) return;
    for (const Value::Entry& entry : levels.value.entries) {
      const auto level = entry.value.kind == Kind::text ? level_of(entry.value.text) : std::nullopt;
      if (!level) {
        report_.add(Code::R0803, entry.value.span, fmt::format("`{}` has no such level", entry.key))
            .label("expected \"allow\", \"warn\" or \"deny\"");
      }
      const std::string fault = project_.levels.set(entry.key, level.value_or(Level::warn));
      if (!fault.empty()) report_.add(Code::R0803, entry.span, fault);
    }
  }

  void take_language(const Value::Entry& table) {
    if (!has_kind(table, Kind::table, "a table")) return;
    Language language;
    language.name = table.key;
    language.span = table.span;
    std::vector<Key> keys = shared_keys(language);
    keys.push_back(
        {"templates", [&](const auto& entry) { take_folder(entry, language.template_folder); }});
    take_all(table.value, keys, table.key);
    project_.languages.push_back(std::move(language));
  }

  /// What languages and plug-ins have alike.
  std::vector<Key> shared_keys(Language& language) {
    return {
        {"output", [&](const auto& entry) { take_folder(entry, language.output_folder); }},
        {"rename", [&](const auto& entry) { take_renames(entry, language); }},
    };
  }

  void take_plugins(const Value::Entry& plugins) {
    if (!has_kind(plugins, Kind::table, "a table for each plug-in, `[plugin.NAME]`")) return;
    for (const Value::Entry& entry : plugins.value.entries) take_plugin(entry);
  }

  void take_plugin(const Value::Entry& table) {
    if (!has_kind(table, Kind::table, "a table")) return;
    Plugin plugin;
    plugin.name = table.key;
    plugin.span = table.span;
    if (!is_plain(table.key)) {
      report_.add(Code::R0803, table.span, fmt::format("`{}` is no name of a plug-in", table.key))
          .label("expected letters, digits, `_` and `-`");
      return;
    }
    std::vector<Key> keys = shared_keys(plugin);
    keys.push_back({"program", [&](const auto& entry) { take_program(entry, plugin); }});
    keys.push_back({"options", [&](const auto& entry) { take_options(entry, plugin); }});
    take_all(table.value, keys, fmt::format("plugin.{}", table.key));
    const bool has_program = std::ranges::any_of(
        table.value.entries, [](const auto& one) { return one.key == "program"; });
    if (!has_program) {
      report_.add(Code::R0803, table.span, fmt::format("`[plugin.{}]` has no `program`", table.key))
          .label("which program makes the files?");
    }
    project_.plugins.push_back(std::move(plugin));
  }

  /// A name that files may have everywhere: the manifest has it.
  static bool is_plain(std::string_view name) {
    return !name.empty() && name.size() <= 64 && std::ranges::all_of(name, [](char c) {
      return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
             c == '_' || c == '-';
    });
  }

  /// A path begins at the folder of the file, also without `/` if the file is there; another name
  /// is one along PATH.
  void take_program(const Value::Entry& entry, Plugin& plugin) {
    if (!has_kind(entry, Kind::text, "the path of a program")) return;
    const std::string& text = entry.value.text;
    if (text.empty()) {
      report_.add(Code::R0803, entry.value.span, "`program` is empty");
      return;
    }
    plugin.program = placed(text);
    std::error_code error;
    const bool is_path = text.find('/') != std::string::npos;
    if (!is_path && !fs::exists(plugin.program, error)) {
      plugin.program = text;
    } else if (plugin.program.find('/') == std::string::npos) {
      plugin.program.insert(0, "./");
    }
  }

  void take_options(const Value::Entry& options, Plugin& plugin) {
    if (!has_kind(options, Kind::table, "a table of texts")) return;
    for (const Value::Entry& entry : options.value.entries) {
      if (has_kind(entry, Kind::text, "a text")) plugin.options[entry.key] = entry.value.text;
    }
  }

  void take_folder(const Value::Entry& entry, std::string& folder) {
    if (!has_kind(entry, Kind::text, "the path of a folder")) return;
    if (entry.value.text.empty()) {
      report_.add(Code::R0803, entry.value.span, fmt::format("`{}` is empty", entry.key))
          .help("write `\".\"` for the folder of the project file");
      return;
    }
    folder = placed(entry.value.text);
    if (folder.size() > 1 && folder.ends_with('/')) folder.pop_back();
  }

  void take_renames(const Value::Entry& renames, Language& language) {
    if (!has_kind(renames, Kind::table, "a table")) return;
    for (const Value::Entry& entry : renames.value.entries) {
      if (entry.value.kind == Kind::table) {
        report_
            .add(Code::R0803, entry.span, fmt::format("the rename of `{}` is a table", entry.key))
            .label("expected a text")
            .help("put quotes around the whole name: `\"example.arm.Arm.move\" = \"go\"`");
      } else if (has_kind(entry, Kind::text, "a name")) {
        language.renames.push_back({entry.key, entry.value.text, entry.span});
      }
    }
  }

  Project& project_;
  const std::vector<std::string_view>& languages_;
  const fs::path folder_;
  Report& report_;
};

}  // namespace

const Language* Project::find(std::string_view language) const {
  const auto found = std::ranges::find(languages, language, &Language::name);
  return found == languages.end() ? nullptr : &*found;
}

const Plugin* Project::find_plugin(std::string_view name) const {
  const auto found = std::ranges::find(plugins, name, &Plugin::name);
  return found == plugins.end() ? nullptr : &*found;
}

std::string find_file() {
  std::error_code error;
  const fs::path current = fs::current_path(error);
  fs::path path(file_name);
  for (fs::path folder = current; !error; folder = folder.parent_path()) {
    if (fs::is_regular_file(folder / file_name, error)) return path.generic_string();
    error.clear();
    if (folder == folder.parent_path()) break;
    path = ".." / path;
  }
  return "";
}

std::string find_file(const std::string& folder) {
  std::error_code error;
  for (fs::path at(folder);; at = at.parent_path()) {
    const fs::path path = at / file_name;
    if (fs::is_regular_file(path, error)) return path.generic_string();
    if (at == at.parent_path()) return "";
  }
}

Project read(const std::string& path, const std::vector<std::string_view>& languages,
             Sources& sources, Report& report) {
  Project project;
  project.path = path;
  ast::FileText read = ast::read_file(path);
  const bool is_read = read.text.has_value();
  const SourceId id = sources.add(path, std::move(read.text).value_or(std::string()));
  if (!is_read) {
    report.add(Code::R0510, {id, 0, 0}, fmt::format("`{}` {}", path, read.failure));
    return project;
  }
  Reader(project, languages, report).run(parse_toml(sources[id], id, report));
  return project;
}

}  // namespace robdef::project
