// SPDX-License-Identifier: Apache-2.0
#include "compiler/driver/format.hpp"

#include <filesystem>
#include <ostream>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "compiler/format/format.hpp"
#include "compiler/output/pending_files.hpp"
#include "compiler/syntax/parse.hpp"
#include "compiler/syntax/read.hpp"

namespace robdef {
namespace {

/// One definition and what has to change in it.
struct LaidOut {
  std::string path;  ///< as given
  Source source;
  ast::File file;
  std::vector<format::Edit> edits;

  [[nodiscard]] std::string text() const { return format::with_edits(source.text(), edits); }
};

LaidOut lay_out(const std::string& path, std::string text) {
  Source source(ast::shown_name(path), std::move(text));
  Report unused;
  ast::File file = ast::parse(source, SourceId{}, unused);
  std::vector<format::Edit> edits = format::edits(file.written, source.text());
  return {path, std::move(source), std::move(file), std::move(edits)};
}

// All files, each once; fewer when one cannot be read, which is told.
bool read_all(const std::vector<std::string>& paths, std::vector<LaidOut>& all, std::ostream& err) {
  bool is_complete = true;
  std::set<std::string> known;
  for (const std::string& path : paths) {
    if (!known.insert(ast::identity_of(path)).second) continue;
    ast::FileText read = ast::read_file(path);
    if (read.text) {
      all.push_back(lay_out(path, *std::move(read.text)));
    } else {
      err << "robdef: " << ast::shown_name(path) << ": " << read.failure << '\n';
      is_complete = false;
    }
  }
  return is_complete;
}

// Once for each line and reason.
bool print_changes(const LaidOut& one, std::ostream& out) {
  std::set<std::pair<std::uint32_t, format::Reason>> told;
  for (const format::Edit& edit : one.edits) {
    const Position place = one.source.position(edit.begin);
    if (!told.insert({place.line, edit.reason}).second) continue;
    out << one.source.name() << ':' << place.line << ':' << place.column << ": "
        << format::text_of(edit.reason) << '\n';
  }
  return !told.empty();
}

void print_unread(const LaidOut& one, std::ostream& err) {
  for (const ast::Line& line : one.file.written.lines) {
    if (line.kind != ast::LineKind::unread) continue;
    err << one.source.name() << ':' << one.source.position(line.begin).line
        << ": left as it is, because it cannot be read\n";
  }
}

std::string write_all(const std::vector<LaidOut>& all, std::ostream& out) {
  PendingFiles files;
  for (const LaidOut& one : all) {
    if (ast::is_standard_input(one.path)) {
      out << one.text();
    } else if (!one.edits.empty()) {
      // The file itself, not a link to it.
      const std::string failure =
          files.write(std::filesystem::weakly_canonical(one.path), one.text());
      if (!failure.empty()) return failure;
    }
  }
  return files.move_all();
}

}  // namespace

ExitStatus format_files(const Options& options, std::ostream& out, std::ostream& err) {
  std::vector<LaidOut> all;
  if (!read_all(options.inputs, all, err)) return exit_errors;
  for (const LaidOut& one : all) print_unread(one, err);
  if (options.checks_only) {
    bool is_any = false;
    for (const LaidOut& one : all) is_any = print_changes(one, out) || is_any;
    return is_any ? exit_errors : exit_fine;
  }
  const std::string failure = write_all(all, out);
  if (failure.empty()) return exit_fine;
  err << "robdef: " << failure << '\n';
  return exit_errors;
}

}  // namespace robdef
