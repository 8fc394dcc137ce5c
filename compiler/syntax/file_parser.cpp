// SPDX-License-Identifier: Apache-2.0
// Statements outside of blocks, and their order. Reports P02, P04, P05, P07, P08, P10, P12, P14,
// S1; warns of W4, Q01, Q02.
#include "compiler/syntax/file_parser.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "compiler/syntax/versions.hpp"

namespace robdef::syntax {

FileParser::FileParser(const Source& source, SourceId id, Report& report, ast::EarlierFile* earlier)
    : report_(report), reader_(source, id, report) {
  file_.source = id;
  if (earlier != nullptr) earlier_.emplace(earlier->text, earlier->file, source.text(), id);
}

ast::File FileParser::run() {
  first_remark_ = report_.remarks();
  while (reader_.next(is_in_block(), line_)) {
    read_line();
    mark_plain_lines();
  }
  finish();
  file_.written.lines = std::move(reader_.written());
  return std::move(file_);
}

std::string_view FileParser::first_word() const {
  const std::string_view text = line_.text();
  const auto end = std::find_if_not(text.begin(), text.end(), is_word_character);
  return text.substr(0, static_cast<std::size_t>(end - text.begin()));
}

// Of the lines since the statement before, the one that was read included.
void FileParser::mark_plain_lines() {
  const bool is_plain = std::exchange(is_plain_, true) && report_.remarks() == first_remark_;
  std::vector<ast::Line>& lines = reader_.written();
  for (; first_line_ < lines.size(); ++first_line_) lines[first_line_].is_plain = is_plain;
  first_remark_ = report_.remarks();
}

// A whole block that has not changed.
bool FileParser::take_block() {
  if (!earlier_ || is_in_block() || wants_service_ || line_.is_damaged()) return false;
  const Keyword keyword = keyword_of(first_word());
  const Part part = keyword == Keyword::enum_ ? Part::names : Part::types;
  if (!is_block_keyword(keyword) || part_ > part) return false;
  std::vector<ast::Line>& lines = reader_.written();
  auto block = earlier_->block(lines.back().begin);
  if (!block) return false;
  enter(part);
  expects_strays_ = false;
  const std::size_t first = lines.size();
  lines.pop_back();
  for (ast::Line line : block->lines) {
    const auto first_token = static_cast<std::uint32_t>(file_.written.tokens.size());
    earlier_->append_tokens(line, block->shift, file_.written.tokens);
    line.first_token = first_token;
    line.begin = block->shift.moved(line.begin);
    line.end = block->shift.moved(line.end);
    lines.push_back(line);
    // With what stands above.
    if (lines.size() == first) mark_plain_lines();
  }
  first_line_ = lines.size();
  reader_.skip_to(lines.back().end);
  std::visit([&](auto& node) { node.documentation = line_.documentation(); }, block->declaration);
  file_.declarations.push_back(std::move(block->declaration));
  return true;
}

void FileParser::read_line() {
  if (take_block()) return;
  if (cut_badly()) return;
  const Keyword keyword = keyword_of(first_word());
  block_.has_content = block_.has_content || keyword != Keyword::end;
  const std::size_t errors = report_.errors();
  const bool was_in_block = is_in_block();
  const Span block = block_.header;
  switch (block_.kind) {
    case BlockKind::none:
      read_outside(keyword);
      break;
    case BlockKind::record:
      read_in_record(keyword);
      break;
    case BlockKind::object:
      read_in_object(keyword);
      break;
    case BlockKind::enumeration:
      read_in_enum(keyword);
      break;
  }
  if (report_.errors() != errors || line_.is_damaged()) block_.is_whole = false;
  const bool is_same_block = is_in_block() && block_.header == block;
  if (was_in_block && is_in_block() && !is_same_block) leave_comments_outside();
  keep_line(was_in_block && is_same_block);
}

// Adds to what is kept of the line that was read.
void FileParser::keep_line(bool is_inside) {
  ast::Line& line = reader_.written().back();
  line.first_token = static_cast<std::uint32_t>(file_.written.tokens.size());
  line.is_in_block = is_inside;
  line.token_count = earlier_ ? earlier_->take_tokens(file_.written.tokens) : 0;
  if (line.token_count == 0) line.token_count = parser_.take_tokens(line_, file_.written.tokens);
  if (line.token_count == 0) return;
  line.kind = ast::LineKind::statement;
  if (!line_.is_damaged()) return;
  // Its tokens are those of the text that was read in place of the bytes.
  file_.written.tokens.resize(line.first_token);
  line.token_count = 0;
  line.kind = ast::LineKind::unread;
}

// Above a block that begins before another has ended, comments belong to what follows.
void FileParser::leave_comments_outside() {
  auto& lines = reader_.written();
  for (std::size_t above = lines.size() - 1; above > 0; --above) {
    ast::Line& line = lines[above - 1];
    if (line.kind == ast::LineKind::statement || line.kind == ast::LineKind::unread) return;
    line.is_in_block = false;
  }
}

void FileParser::read_outside(Keyword keyword) {
  if (keyword == Keyword::none) {
    unknown_statement();
    return;
  }
  if (std::exchange(wants_service_, false) && keyword != Keyword::service) {
    report()
        .add(Code::R0108, first_word_span(), "a definition begins with its service line")
        .label("comes before the service line")
        .help("write `service some.name` above");
  }
  if (keyword == Keyword::end || keyword == Keyword::implements || keyword == Keyword::field ||
      is_member_keyword(keyword)) {
    stray(keyword);
    return;
  }
  const bool is_complete = has_operand(keyword);
  if (is_block_keyword(keyword)) return open_block(keyword, is_complete);
  if (!is_complete) return;
  switch (keyword) {
    case Keyword::service:
      return service();
    case Keyword::stdver:
      return stdver();
    case Keyword::option:
      return option();
    case Keyword::import:
      return import();
    case Keyword::using_:
      return using_line();
    case Keyword::exception:
      return exception();
    default:
      return constant();
  }
}

void FileParser::service() {
  if (file_.service) {
    report()
        .add(Code::R0108, first_word_span(), "a second service line")
        .label("a file defines one service")
        .also(file_.service->span, "the first");
    return;
  }
  file_.documentation = line_.documentation();
  file_.service = parser_.service(line_, report());
}

void FileParser::stdver() {
  const bool is_late =
      is_too_late(Part::head, Code::R0110, "`stdver` stands before all imports and declarations");
  if (is_late && file_.version_spelling != ast::VersionSpelling::none) return;
  const auto version = parser_.stdver(line_, report());
  if (!version) return;
  if (version->version < first_with_stdver) {
    report()
        .add(Code::R0111, version->span,
             fmt::format("`stdver` cannot name version {}", text_of(version->version)))
        .label("the first version with `stdver` is 0.9")
        .help("write `stdver 0.10`")
        .edit(version->span, "0.10");
  }
  if (file_.version_spelling == ast::VersionSpelling::stdver) {
    report()
        .add(Code::R0141, first_word_span(), "a second stdver line")
        .label("this one counts")
        .also(file_.version_span, "the version before");
  }
  declare_version(ast::VersionSpelling::stdver, *version);
}

void FileParser::declare_version(ast::VersionSpelling spelling, const VersionLine& version) {
  const bool is_second =
      file_.version_spelling != ast::VersionSpelling::none &&
      (file_.version_spelling != spelling || spelling == ast::VersionSpelling::option);
  if (is_second) {
    report()
        .add(Code::R0114, version.span, "the version is declared twice")
        .label("second version")
        .also(file_.version_span, "first version");
    return;
  }
  file_.version_spelling = spelling;
  file_.version = version.version;
  file_.version_span = version.span;
}

bool FileParser::forbids_options() const {
  return file_.version_spelling == ast::VersionSpelling::stdver &&
         file_.version >= first_without_options;
}

// Inside and outside of blocks.
void FileParser::option() {
  is_plain_ = false;
  if (!has_operand(Keyword::option)) return;
  if (forbids_options()) {
    report()
        .add(Code::R0113, first_word_span(),
             fmt::format("`option` in a file of version {}", text_of(file_.version)))
        .label("not allowed from version 0.9.2 on")
        .also(file_.version_span, "the version")
        .help("use `constant`, or the modifier `[unreliable]` of a pipe");
    parser_.option(line_, discarded_);  // its form may be right
    return;
  }
  auto content = parser_.option(line_, report());
  if (!content) return;
  options_.push_back(first_word_span());
  std::string_view text = line_.text().substr(first_word().size());
  text.remove_prefix(std::min(text.find_first_not_of(" \t"), text.size()));
  const ast::Option written{std::string(text), line_.span()};
  auto* const constant = std::get_if<ast::Constant>(&*content);
  switch (block_.kind) {
    case BlockKind::record:
      block_.record.options.push_back(written);
      if (constant != nullptr) block_.record.constants.push_back(std::move(*constant));
      return;
    case BlockKind::object:
      block_.object.options.push_back(written);
      if (constant != nullptr) block_.object.constants.push_back(std::move(*constant));
      return;
    case BlockKind::none:
    case BlockKind::enumeration:
      break;
  }
  file_.options.push_back(written);
  if (constant != nullptr) file_.declarations.emplace_back(std::move(*constant));
  if (const auto* const version = std::get_if<VersionLine>(&*content)) {
    declare_version(ast::VersionSpelling::option, *version);
  }
}

void FileParser::enter(Part part) {
  part_ = std::max(part_, part);
  auto& begin = part_begin_[static_cast<std::size_t>(part)];
  if (!begin) begin = first_word_span();
}

// Reports a statement of an earlier part than the one that has begun.
bool FileParser::is_too_late(Part part, Code code, std::string message) {
  if (part_ <= part) return false;
  Diagnostic& diagnostic =
      report().add(code, first_word_span(), std::move(message)).label("too late in the file");
  for (auto later = static_cast<std::size_t>(part) + 1; later < std::size(part_begin_); ++later) {
    if (!part_begin_[later]) continue;
    diagnostic.also(*part_begin_[later], "has to come after it");
    break;
  }
  return true;
}

void FileParser::import() {
  is_too_late(Part::imports, Code::R0501, "`import` stands before `using` and all declarations");
  enter(Part::imports);
  auto import = parser_.import(line_, report());
  if (import) file_.imports.push_back(std::move(*import));
}

void FileParser::using_line() {
  is_too_late(Part::usings, Code::R0503, "`using` stands before all declarations");
  enter(Part::usings);
  auto written = parser_.using_line(line_, report());
  if (written) file_.usings.push_back(std::move(*written));
}

void FileParser::exception() {
  is_too_late(Part::names, Code::R0116, "exceptions stand before all types and objects");
  enter(Part::names);
  auto exception = parser_.exception(line_, report());
  if (exception) file_.declarations.emplace_back(std::move(*exception));
}

void FileParser::constant() {
  is_too_late(Part::names, Code::R0116, "constants of a file stand before all types and objects");
  enter(Part::names);
  auto constant = statement(&Earlier::constant, &LineParser::constant);
  if (constant) file_.declarations.emplace_back(std::move(*constant));
}

void FileParser::finish() {
  if (is_in_block()) leave_block_open(std::nullopt);
  const bool is_escape = forbids_options();
  for (const Span option : options_) {
    if (is_escape) {
      report_.add(Code::R0142, option, "`option` above a stdver line that forbids options")
          .label("not allowed from version 0.9.2 on")
          .also(file_.version_span, "the version")
          .help("remove the option");
    } else {
      report_.add(Code::R0136, option, "`option` is a relic")
          .label("not allowed from version 0.9.2 on")
          .help("use `stdver`, `constant`, or the modifier `[unreliable]` of a pipe");
    }
  }
  if (file_.version_spelling != ast::VersionSpelling::none && file_.version > newest_known) {
    report_
        .add(Code::R0134, file_.version_span,
             fmt::format("version {} is newer than this compiler", text_of(file_.version)))
        .label("the newest that can be read is 1.2.8")
        .help("write `stdver 0.10` unless the file needs more")
        .edit(file_.version_span, "0.10");
  }
}

}  // namespace robdef::syntax
