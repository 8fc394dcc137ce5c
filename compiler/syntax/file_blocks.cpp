// SPDX-License-Identifier: Apache-2.0
// Blocks: their lines, their order and their ends. Reports P17, P18, P20, P21, P31 (commas); warns
// of Q17.
#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "compiler/syntax/constants.hpp"
#include "compiler/syntax/file_parser.hpp"
#include "compiler/syntax/versions.hpp"

namespace robdef::syntax {
namespace {

ast::RecordKind record_kind(Keyword keyword) {
  if (keyword == Keyword::pod) return ast::RecordKind::pod;
  if (keyword == Keyword::namedarray) return ast::RecordKind::namedarray;
  return ast::RecordKind::struct_;
}

}  // namespace

void FileParser::open_block(Keyword keyword, bool has_name) {
  const bool is_enum = keyword == Keyword::enum_;
  if (is_enum) is_too_late(Part::names, Code::R0116, "enums stand before all types and objects");
  enter(is_enum ? Part::names : Part::types);
  expects_strays_ = false;
  block_ = {};
  block_.keyword = keyword;
  block_.header = first_word_span();
  block_.kind = is_enum                      ? BlockKind::enumeration
                : keyword == Keyword::object ? BlockKind::object
                                             : BlockKind::record;
  std::optional<ast::Name> name;
  if (has_name) name = parser_.header(line_, report());
  if (!name) return;
  block_.name = name->text;
  block_.header = name->span;
  switch (block_.kind) {
    case BlockKind::enumeration:
      block_.enumeration = {std::move(*name), {}, line_.documentation(), line_.span()};
      break;
    case BlockKind::object:
      block_.object.name = std::move(*name);
      block_.object.documentation = line_.documentation();
      block_.object.span = line_.span();
      break;
    case BlockKind::none:
    case BlockKind::record:
      block_.record.kind = record_kind(keyword);
      block_.record.name = std::move(*name);
      block_.record.documentation = line_.documentation();
      block_.record.span = line_.span();
      break;
  }
}

void FileParser::read_in_record(Keyword keyword) {
  switch (keyword) {
    case Keyword::none:
      return unknown_statement();
    case Keyword::end:
      return end();
    case Keyword::option:
      return option();
    case Keyword::constant:
      return block_constant();
    case Keyword::field:
      return field();
    default:
      break;
  }
  if (keyword == Keyword::implements || is_member_keyword(keyword)) return misplaced(keyword);
  outside_only(keyword);
}

void FileParser::read_in_object(Keyword keyword) {
  switch (keyword) {
    case Keyword::none:
      return unknown_statement();
    case Keyword::end:
      return end();
    case Keyword::option:
      return option();
    case Keyword::constant:
      return block_constant();
    case Keyword::implements:
      return implements();
    case Keyword::field:
      return misplaced(keyword);
    default:
      break;
  }
  if (is_member_keyword(keyword)) return member();
  outside_only(keyword);
}

void FileParser::block_constant() {
  if (!has_operand(Keyword::constant)) return;
  if (block_.first_member) {
    report()
        .add(Code::R0123, first_word_span(),
             fmt::format("constants of {} stand before its {}", with_article(block_.keyword),
                         block_.kind == BlockKind::object ? "members" : "fields"))
        .label("too late in the block")
        .also(*block_.first_member, "has to come after it");
  }
  auto constant = statement(&Earlier::constant, &LineParser::constant);
  if (!constant) return;
  auto& constants =
      block_.kind == BlockKind::object ? block_.object.constants : block_.record.constants;
  constants.push_back(std::move(*constant));
}

void FileParser::implements() {
  if (!has_operand(Keyword::implements)) return;
  if (block_.first_member) {
    report()
        .add(Code::R0122, first_word_span(), "`implements` stands before the first member")
        .label("too late in the object")
        .also(*block_.first_member, "has to come after it");
  }
  auto implements = parser_.implements(line_, report());
  if (implements) block_.object.implements.push_back(std::move(*implements));
}

void FileParser::field() {
  if (!block_.first_member) block_.first_member = first_word_span();
  if (!has_operand(Keyword::field)) return;
  auto field = statement(&Earlier::field, &LineParser::field);
  if (field) block_.record.fields.push_back(std::move(*field));
}

void FileParser::member() {
  if (!block_.first_member) block_.first_member = first_word_span();
  if (!has_operand(keyword_of(first_word()))) return;
  auto member = statement(&Earlier::member, &LineParser::member);
  if (member) block_.object.members.push_back(std::move(*member));
}

// A line of an enum is a list of values, unless it says `end`. Values may have the names of
// keywords as far as the grammar goes, but no value is followed by another word.
void FileParser::read_in_enum(Keyword keyword) {
  if (keyword == Keyword::end) return end();
  std::string_view rest = line_.text().substr(first_word().size());
  rest.remove_prefix(std::min(rest.find_first_not_of(" \t"), rest.size()));
  const bool is_statement = !rest.empty() && is_word_character(rest.front());
  if (is_statement && is_block_keyword(keyword)) return outside_only(keyword);
  enum_values();
}

void FileParser::enum_values() {
  if (block_.missing_comma) {
    report()
        .add(Code::R0132, *block_.missing_comma, "a comma is missing after this value")
        .label("more values follow");
    block_.missing_comma.reset();
  }
  auto values = statement(&Earlier::enum_line, &LineParser::enum_line);
  if (!values) {
    block_.is_whole = false;
    return;
  }
  if (!values->ends_in_comma) {
    const ast::EnumValue& last = values->values.back();
    block_.missing_comma = last.value ? last.value->span : last.name.span;
  }
  auto& all = block_.enumeration.values;
  std::move(values->values.begin(), values->values.end(), std::back_inserter(all));
}

void FileParser::end() {
  const auto end = parser_.end(line_, report());
  if (end && end->kind) is_plain_ = false;  // it depends on the version
  if (end && end->kind && keyword_of(end->kind->text) != block_.keyword) {
    report()
        .add(Code::R0120, end->kind->span,
             fmt::format("`end {}` closes {}", end->kind->text, with_article(block_.keyword)))
        .label("another kind of block")
        .also(block_.header, "the block")
        .help("write `end`")
        .edit(line_.span(), "end");
  } else if (end && end->kind && forbids_options()) {
    report()
        .add(Code::R0120, end->kind->span,
             fmt::format("`end {}` in a file of version {}", end->kind->text,
                         text_of(file_.version)))
        .label("from version 0.9.2 on `end` stands alone")
        .help("write `end`")
        .edit(line_.span(), "end");
  }
  if (!block_.has_content && !block_.name.empty() && block_.keyword != Keyword::namedarray) {
    report()
        .add(Code::R0422, block_.header,
             fmt::format("{} without content", with_article(block_.keyword)))
        .label(fmt::format("nothing stands in the {}", text_of(block_.keyword)));
  }
  close_block();
}

void FileParser::close_block() {
  Block block = std::exchange(block_, {});
  if (block.kind == BlockKind::enumeration) {
    check_enum(block.enumeration, block.is_whole, report_);
  }
  // Without a name nobody can refer to it; the header is reported.
  if (block.name.empty()) return;
  if (block.kind == BlockKind::enumeration) {
    file_.declarations.emplace_back(std::move(block.enumeration));
  } else if (block.kind == BlockKind::object) {
    file_.declarations.emplace_back(std::move(block.object));
  } else {
    file_.declarations.emplace_back(std::move(block.record));
  }
}

// The block ends where another begins, or with the file.
void FileParser::leave_block_open(std::optional<Span> next) {
  Diagnostic& diagnostic = report_
                               .add(Code::R0119, block_.header,
                                    fmt::format("the {} is never closed", text_of(block_.keyword)))
                               .label("this block has no `end`");
  if (next) diagnostic.also(*next, "the next block begins before the end");
  close_block();
}

}  // namespace robdef::syntax
