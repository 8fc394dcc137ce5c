// SPDX-License-Identifier: Apache-2.0
#include "compiler/driver/version.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <ostream>
#include <utility>
#include <vector>

#include "compiler/diagnostics/excerpt.hpp"
#include "compiler/diagnostics/render.hpp"
#include "compiler/driver/command_table.hpp"
#include "compiler/driver/revision.hpp"
#include "compiler/driver/version_error.hpp"
#include "compiler/model/check.hpp"
#include "compiler/model/evaluate.hpp"
#include "compiler/model/layout.hpp"
#include "compiler/model/resolve.hpp"
#include "compiler/syntax/read.hpp"

namespace robdef {
namespace {

namespace fs = std::filesystem;

enum class Kind { files, revision, sent };

bool is_url(const std::string& text) { return text.find("://") != std::string::npos; }

Kind kind_of(const std::string& what, const CommandTable& table) {
  std::error_code error;
  if (ast::is_standard_input(what) || fs::is_directory(what, error)) return Kind::files;
  const bool may_be_sent = table.is_sent != nullptr && table.is_sent(what);
  if (fs::exists(what, error)) return may_be_sent && !is_url(what) ? Kind::sent : Kind::files;
  if (may_be_sent) return Kind::sent;
  if (is_url(what))
    throw VersionError("this robdef is the compiler alone, and connects to nothing");
  return what.find(':') == std::string::npos ? Kind::files : Kind::revision;
}

bool is_definition(const fs::directory_entry& entry) {
  return entry.path().extension() == ".robdef" && entry.is_regular_file();
}

// In the order of their names. Hidden folders are left out.
std::vector<std::string> files_in(const std::string& folder) {
  std::vector<std::string> files;
  fs::recursive_directory_iterator entry(folder);
  for (; entry != fs::recursive_directory_iterator(); ++entry) {
    if (entry->is_directory() && entry->path().filename().string().starts_with('.')) {
      entry.disable_recursion_pending();
    } else if (is_definition(*entry)) {
      files.push_back(entry->path().generic_string());
    }
  }
  std::sort(files.begin(), files.end());
  if (files.empty()) throw VersionError("there is no .robdef file in this folder");
  return files;
}

std::vector<std::string> files_of(const std::string& what) {
  std::error_code error;
  return fs::is_directory(what, error) ? files_in(what) : std::vector<std::string>{what};
}

// Of every node, and no part of what a service offers. Recorders of nodes hear of it.
constexpr const char* service_index = "RobotRaconteurServiceIndex";

// What a service has sent is of one set: only what nothing else imports was asked for.
ast::Program read_sent(std::vector<ast::NamedText> texts, Sources& sources, Report& report) {
  ast::Program program = ast::read_texts(std::move(texts), sources, report);
  std::vector<std::string> imported = {service_index};
  for (const ast::ProgramFile& one : program.files) {
    for (const ast::Import& import : one.file.imports) imported.push_back(import.name.text);
  }
  std::sort(imported.begin(), imported.end());
  for (ast::ProgramFile& one : program.files) {
    one.is_import = one.file.service &&
                    std::binary_search(imported.begin(), imported.end(), one.file.service->text);
  }
  return program;
}

class VersionReader {
 public:
  VersionReader(const std::string& what, const Options& options, Sources& sources,
                std::ostream& err)
      : what_(what),
        kind_(kind_of(what, *options.table)),
        options_(options),
        sources_(sources),
        report_(is_sent() ? Origin::network : Origin::user),
        err_(err) {}

  std::optional<Version> read() {
    const ast::Program program = read_program();
    Version version{printable(ast::shown_name(what_)), model::resolve(program, sources_, report_),
                    is_sent(), kind_ == Kind::files};
    model::evaluate(version.model, report_);
    model::lay_out(version.model, report_);
    // A client takes what a service sends, whatever rules it breaks.
    if (!is_sent()) model::check(version.model, report_);
    if (!report_.has_errors()) return version;
    print_errors();
    return std::nullopt;
  }

 private:
  [[nodiscard]] bool is_sent() const { return kind_ == Kind::sent; }

  ast::Program read_program() {
    switch (kind_) {
      case Kind::files:
        return ast::read(files_of(what_), options_.search_path, sources_, report_);
      case Kind::revision: {
        const Revision revision(what_);
        return ast::read_texts(
            revision.definitions(),
            [&](const std::string& service, const std::string& importing) {
              return revision.find_import(service, importing, options_.search_path);
            },
            sources_, report_);
      }
      case Kind::sent:
        break;
    }
    return read_sent(options_.table->read_sent(what_, options_, err_), sources_, report_);
  }

  void print_errors() const {
    for (const Diagnostic* const diagnostic : report_.sorted()) {
      if (diagnostic->severity() == Severity::error) err_ << to_text(*diagnostic, sources_) << '\n';
    }
    err_ << "robdef: " << printable(ast::shown_name(what_))
         << ": has errors, and is not compared\n";
  }

  const std::string& what_;
  const Kind kind_;
  const Options& options_;
  Sources& sources_;
  Report report_;
  std::ostream& err_;
};

}  // namespace

std::optional<Version> read_version(const std::string& what, const Options& options,
                                    Sources& sources, std::ostream& err) {
  try {
    return VersionReader(what, options, sources, err).read();
  } catch (const VersionError& error) {
    err << "robdef: " << printable(what) << ": " << printable(error.what()) << '\n';
  } catch (const fs::filesystem_error& error) {
    err << "robdef: " << printable(what) << ": cannot be read: " << error.code().message() << '\n';
  }
  return std::nullopt;
}

}  // namespace robdef
