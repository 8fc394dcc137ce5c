// SPDX-License-Identifier: Apache-2.0
#include "compiler/lsp/workspace.hpp"

#include <algorithm>
#include <set>
#include <system_error>
#include <utility>

#include "compiler/lsp/uri.hpp"
#include "compiler/model/check.hpp"
#include "compiler/model/evaluate.hpp"
#include "compiler/model/layout.hpp"
#include "compiler/model/resolve.hpp"
#include "compiler/syntax/words.hpp"

namespace robdef::lsp {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view extension = ".robdef";

// Of one that is not there, the least.
fs::file_time_type written_at(const std::string& path) {
  std::error_code error;
  const fs::file_time_type time = fs::last_write_time(path, error);
  return error ? fs::file_time_type::min() : time;
}

void add_files_below(const std::string& folder, std::set<std::string>& files) {
  constexpr std::size_t most_files = 10'000;
  constexpr std::size_t most_entries = 200'000;
  std::error_code error;
  fs::recursive_directory_iterator at(folder, fs::directory_options::skip_permission_denied, error);
  std::size_t entries = 0;
  for (; !error && at != fs::recursive_directory_iterator(); at.increment(error)) {
    if (++entries > most_entries || files.size() >= most_files) return;
    const std::string name = at->path().filename().string();
    std::error_code ignored;
    if (name.starts_with('.')) {
      if (at->is_directory(ignored)) at.disable_recursion_pending();
    } else if (name.ends_with(extension) && at->is_regular_file(ignored)) {
      files.insert(ast::identity_of(at->path().string()));
    }
  }
}

void add_services_in(const std::string& folder, std::set<std::string>& services) {
  std::error_code error;
  for (fs::directory_iterator at(folder, error); !error && at != fs::directory_iterator();
       at.increment(error)) {
    const std::string name = at->path().filename().string();
    if (name.size() > extension.size() && name.ends_with(extension)) {
      services.insert(name.substr(0, name.size() - extension.size()));
    }
  }
}

}  // namespace

std::string identity_of_uri(std::string_view uri) {
  const std::string path = path_of(uri);
  return path.starts_with('/') ? ast::identity_of(path) : path;
}

std::string declared_service(std::string_view text) {
  if (text.starts_with(byte_order_mark)) text.remove_prefix(byte_order_mark.size());
  while (!text.empty()) {
    std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(line.size() + 1, text.size()));
    line.remove_prefix(std::min(line.find_first_not_of(" \t\r"), line.size()));
    if (line.empty() || line.front() == '#') continue;
    constexpr std::string_view word = "service";
    if (!line.starts_with(word)) return {};
    line.remove_prefix(word.size());
    if (line.empty() || !syntax::is_blank(line.front())) return {};
    line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
    return std::string(line.substr(0, line.find_first_of(" \t\r")));
  }
  return {};
}

Document& Workspace::open(const std::string& uri, std::int64_t version, std::string text) {
  close(uri);
  const std::string path = identity_of_uri(uri);
  open_paths_[uri] = path;
  documents_.erase(path);
  Document& document =
      documents_.emplace(path, Document{uri, path, version, Text(std::move(text))}).first->second;
  forget(path);
  return document;
}

void Workspace::close(const std::string& uri) {
  const auto found = open_paths_.find(uri);
  if (found == open_paths_.end()) return;
  const std::string path = found->second;
  open_paths_.erase(found);
  documents_.erase(path);
  analyses_.erase(path);
  forget(path);
}

Document* Workspace::find(const std::string& uri) {
  const auto path = open_paths_.find(uri);
  if (path == open_paths_.end()) return nullptr;
  const auto found = documents_.find(path->second);
  return found == documents_.end() ? nullptr : &found->second;
}

void Workspace::forget(const std::string& path) {
  for (auto& [document, known] : analyses_) {
    if (known.is_outdated) continue;
    known.is_outdated =
        document == path || known.analysis->misses_import || known.analysis->reads(path);
  }
}

void Workspace::forget_all() {
  for (auto& [document, known] : analyses_) known.is_outdated = true;
  projects_.clear();
}

std::optional<std::string> Workspace::text_of(const std::string& path) const {
  const auto open = documents_.find(path);
  if (open != documents_.end()) return open->second.text.bytes();
  std::error_code error;
  if (!fs::is_regular_file(path, error)) return std::nullopt;
  return ast::read_file(path).text;
}

std::string Workspace::uri_of_path(const std::string& path) const {
  const auto open = documents_.find(path);
  return open == documents_.end() ? uri_of(path) : open->second.uri;
}

const Workspace::LoadedProject* Workspace::project_of(const std::string& path) {
  if (!path.starts_with('/')) return nullptr;
  const std::string file = project::find_file(fs::path(path).parent_path().string());
  if (file.empty()) return nullptr;
  const fs::file_time_type written = written_at(file);
  const auto known = projects_.find(file);
  if (known != projects_.end() && known->second.written == written) return &known->second;
  LoadedProject& loaded = projects_[file];
  Sources sources;
  Report report;
  loaded = {project::read(file, options_.languages, sources, report), written, {}};
  for (const std::string& input : loaded.project.inputs) {
    const std::string identity = ast::identity_of(input);
    const std::optional<std::string> text = text_of(identity);
    if (text) loaded.inputs.try_emplace(declared_service(*text), identity);
  }
  return &loaded;
}

ast::SearchPath Workspace::search_path_of(const LoadedProject* project) const {
  ast::SearchPath path = options_.search_path;
  if (project == nullptr) return path;
  const std::vector<std::string>& folders = project->project.import_folders;
  path.folders.insert(
      path.folders.begin() + static_cast<std::ptrdiff_t>(options_.own_import_folders),
      folders.begin(), folders.end());
  return path;
}

std::optional<ast::NamedText> Workspace::find_import(const std::string& service,
                                                     const std::string& importing,
                                                     const LoadedProject* project,
                                                     Analysis& analysis) {
  std::vector<std::string> places;
  // Inputs of one project are read together.
  if (project != nullptr) {
    const auto input = project->inputs.find(service);
    if (input != project->inputs.end()) places.push_back(input->second);
  }
  for (std::string& place : ast::import_places(service, importing, search_path_of(project))) {
    places.push_back(ast::identity_of(place));
  }
  for (const std::string& place : places) {
    std::optional<std::string> text = text_of(place);
    if (!text) continue;
    if (!documents_.contains(place)) analysis.read_files.emplace_back(place, written_at(place));
    return ast::NamedText{place, *std::move(text), true};
  }
  analysis.misses_import = true;
  return std::nullopt;
}

// Its last owner: what is left of `earlier` ends here.
std::shared_ptr<Analysis> Workspace::analyse(
    const std::string& path, std::string text,
    std::shared_ptr<Analysis> earlier) {  // NOLINT(performance-unnecessary-value-param)
  auto made = std::make_shared<Analysis>();
  const LoadedProject* const project = project_of(path);
  if (project != nullptr) set_levels(made->report, {&project->project.levels});
  const auto find = [&](const std::string& service, const std::string& importing) {
    return find_import(service, importing, project, *made);
  };
  std::vector<ast::NamedText> texts;
  texts.push_back({path, std::move(text), false});
  // What has not changed moves, which nobody else may see.
  ast::EarlierFiles files;
  if (earlier && earlier.use_count() == 1) files = std::move(*earlier).files();
  made->program =
      ast::read_texts(std::move(texts), find, made->sources, made->report, std::move(files));
  made->model = model::resolve(made->program, made->sources, made->report);
  model::evaluate(made->model, made->report);
  model::lay_out(made->model, made->report);
  model::check(made->model, made->report);
  if (project != nullptr && project->project.is_strict) {
    model::check_strictly(made->model, made->report);
  }
  return made;
}

bool Workspace::is_current(const Analysis& analysis) const {
  return std::ranges::all_of(
      analysis.read_files, [](const auto& file) { return written_at(file.first) == file.second; });
}

std::shared_ptr<const Analysis> Workspace::analysis(const std::string& path) {
  const auto known = analyses_.find(path);
  std::shared_ptr<Analysis> earlier;
  if (known != analyses_.end()) {
    if (!known->second.is_outdated && is_current(*known->second.analysis)) {
      return known->second.analysis;
    }
    earlier = std::move(known->second.analysis);
    analyses_.erase(known);
  }
  std::optional<std::string> text = text_of(path);
  if (!text) return nullptr;
  std::shared_ptr<Analysis> made = analyse(path, *std::move(text), std::move(earlier));
  if (documents_.contains(path)) analyses_[path] = {made};
  return made;
}

bool Workspace::depends(const Document& document, const std::string& path) {
  const auto known = analyses_.find(document.path);
  return known == analyses_.end() || known->second.is_outdated ||
         known->second.analysis->misses_import || known->second.analysis->reads(path);
}

std::vector<std::string> Workspace::files() {
  std::set<std::string> all;
  for (const std::string& folder : folders_) add_files_below(folder, all);
  for (const auto& [path, document] : documents_) {
    all.insert(path);
    const LoadedProject* const project = project_of(path);
    if (project == nullptr) continue;
    for (const auto& [service, input] : project->inputs) all.insert(input);
  }
  return {all.begin(), all.end()};
}

std::vector<std::string> Workspace::importable_services(const std::string& path) {
  std::set<std::string> all;
  const LoadedProject* const project = project_of(path);
  if (fs::path(path).is_absolute()) add_services_in(fs::path(path).parent_path().string(), all);
  for (const std::string& folder : search_path_of(project).folders) add_services_in(folder, all);
  if (project != nullptr) {
    for (const auto& [service, input] : project->inputs) all.insert(service);
  }
  for (const auto& [open, document] : documents_) {
    const bool is_beside = fs::path(open).parent_path() == fs::path(path).parent_path();
    if (is_beside) all.insert(declared_service(document.text.bytes()));
  }
  const std::optional<std::string> text = text_of(path);
  if (text) all.erase(declared_service(*text));
  all.erase("");
  return {all.begin(), all.end()};
}

}  // namespace robdef::lsp
