// SPDX-License-Identifier: Apache-2.0
// Connects definitions with those they import. Reads import lines and versions; fills
// Definition::imports. Reports R0505 (not found), R0506 (circles), R0507 (versions).
#include "compiler/model/imports.hpp"

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "compiler/diagnostics/spelling.hpp"
#include "compiler/model/graph.hpp"
#include "compiler/model/phrases.hpp"

namespace robdef::model {
namespace {

std::string_view file_name(std::string_view path) {
  const std::size_t slash = path.find_last_of("/\\");
  return slash == path.npos ? path : path.substr(slash + 1);
}

class ImportRules {
 public:
  ImportRules(const ast::Program& program, const Model& model, const Sources& sources,
              const SyntaxErrors& syntax_errors, Report& report)
      : program_(program),
        model_(model),
        sources_(sources),
        syntax_errors_(syntax_errors),
        report_(report) {}

  void run() {
    for (std::size_t i = 0; i < program_.files.size(); ++i) {
      for (const ast::Import& import : file(i).imports) resolve_import(import, definition(i));
    }
    check_import_cycles();
  }

 private:
  const ast::File& file(std::size_t index) const { return program_.files[index].file; }
  Definition& definition(std::size_t index) const { return *model_.definitions()[index]; }

  void resolve_import(const ast::Import& import, Definition& user);
  void report_missing_import(const ast::Import& import, const Definition& user);
  void check_import_version(const ast::Import& import, const Definition& user,
                            const Definition& imported);
  void check_import_cycles();
  void report_cycle(const std::vector<Graph::Edge>& cycle);

  const ast::Program& program_;
  const Model& model_;
  const Sources& sources_;
  const SyntaxErrors& syntax_errors_;
  Report& report_;
};

void ImportRules::resolve_import(const ast::Import& import, Definition& user) {
  const Definition* imported = model_.find(import.name.text);
  if (imported == nullptr) {
    if (!import.is_reported) report_missing_import(import, user);
    return;
  }
  if (imported == &user) return;  // a circle of one
  check_import_version(import, user, *imported);
  if (std::find(user.imports.begin(), user.imports.end(), imported) == user.imports.end()) {
    user.imports.push_back(imported);
  }
}

// V03
void ImportRules::report_missing_import(const ast::Import& import, const Definition& user) {
  const std::string& name = import.name.text;
  const std::string expected_file = name + ".robdef";
  std::vector<std::string_view> loaded;
  const Definition* in_its_file = nullptr;
  if (!report_.may_suggest(model_.definitions().size(), comparisons(name))) {
    report_.add(Code::R0505, import.name.span, "the import " + in_ticks(name) + " is not found")
        .label("no definition of this name is loaded");
    return;
  }
  for (const auto& definition : model_.definitions()) {
    const bool is_importable = !definition->name.empty() && definition.get() != &user;
    if (is_importable) loaded.push_back(definition->name);
    const Source& source = sources_[definition->source];
    if (file_name(source.name()) == expected_file) in_its_file = definition.get();
  }
  if (in_its_file != nullptr && in_its_file->name.empty()) return;
  Diagnostic& diagnostic =
      report_.add(Code::R0505, import.name.span, "the import " + in_ticks(name) + " is not found");
  diagnostic.label("no definition of this name is loaded");
  if (in_its_file != nullptr) {
    diagnostic.also(in_its_file->span, "the file of that name has another service name");
    diagnostic.help(
        in_its_file == &user
            ? "write " + in_ticks("service " + name) + " if this file is meant, and no import"
            : "import " + in_ticks(in_its_file->name) + ", or correct its service line");
    return;
  }
  const std::string_view near = nearest(name, loaded);
  if (!near.empty()) {
    diagnostic.help(in_ticks(near) + " is close").edit(import.name.span, std::string(near));
  }
  diagnostic.help("name the file of the definition, or the folder of " + in_ticks(expected_file) +
                  " with -I");
}

// V05
void ImportRules::check_import_version(const ast::Import& import, const Definition& user,
                                       const Definition& imported) {
  if (user.version_spelling == ast::VersionSpelling::none) return;
  const std::string version = text_of(user.version);
  if (imported.version_spelling == ast::VersionSpelling::none) {
    if (syntax_errors_.any_in(imported)) return;
    report_
        .add(Code::R0507, import.name.span,
             in_ticks(imported.name) + " declares no version and cannot be imported here")
        .label("has no version line")
        .also(user.version_span, "this file declares " + version)
        .help("add a version of " + version + " or less to the imported file");
    return;
  }
  if (imported.version <= user.version) return;
  const std::string imported_version = text_of(imported.version);
  report_
      .add(Code::R0507, import.name.span,
           in_ticks(imported.name) + " needs a higher version than this file declares")
      .label("declares version " + imported_version)
      .also(user.version_span, "this file declares " + version)
      .help("write " + in_ticks("stdver " + imported_version))
      .edit(user.version_span, imported_version);
}

// V04
void ImportRules::check_import_cycles() {
  std::unordered_map<const Definition*, std::size_t> number;
  for (std::size_t i = 0; i < program_.files.size(); ++i) number[&definition(i)] = i;
  Graph graph(program_.files.size());
  for (std::size_t i = 0; i < program_.files.size(); ++i) {
    for (std::size_t line = 0; line < file(i).imports.size(); ++line) {
      const Definition* imported = model_.find(file(i).imports[line].name.text);
      if (imported != nullptr) graph.add_edge(i, number.at(imported), line);
    }
  }
  for (const std::vector<Graph::Edge>& cycle : graph.cycles()) report_cycle(cycle);
}

void ImportRules::report_cycle(const std::vector<Graph::Edge>& cycle) {
  const auto import = [&](const Graph::Edge& edge) -> const ast::Name& {
    return file(edge.from).imports[edge.label].name;
  };
  const ast::Name& first = import(cycle.front());
  if (cycle.size() == 1) {
    report_.add(Code::R0506, first.span, in_ticks(first.text) + " imports itself")
        .label("this is the file's own service name")
        .help("remove the line");
    return;
  }
  Diagnostic& diagnostic = report_.add(Code::R0506, first.span, "imports go round in a circle");
  diagnostic.label("imports " + in_ticks(first.text) + ", ...");
  for (std::size_t i = 1; i < cycle.size(); ++i) {
    const ast::Name& next = import(cycle[i]);
    const bool is_last = i + 1 == cycle.size();
    diagnostic.also(next.span, std::string(is_last ? "... which imports " : "... imports ") +
                                   in_ticks(next.text) + (is_last ? " again" : ""));
  }
  diagnostic.help("move what both need into a definition of its own");
}

}  // namespace

void resolve_imports(const ast::Program& program, const Sources& sources,
                     const SyntaxErrors& syntax_errors, Model& model, Report& report) {
  ImportRules(program, model, sources, syntax_errors, report).run();
}

}  // namespace robdef::model
