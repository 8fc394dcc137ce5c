// SPDX-License-Identifier: Apache-2.0
#include "compiler/syntax/earlier.hpp"

#include <algorithm>
#include <utility>
#include <variant>

namespace robdef::syntax {
namespace {

std::uint32_t begin_of(const ast::Declaration& declaration) {
  return std::visit([](const auto& node) { return node.span.begin; }, declaration);
}

std::uint32_t place_of(const ast::EnumValue& value) { return value.name.span.begin; }
template <class Node>
std::uint32_t place_of(const Node& node) {
  return node.span.begin;
}

// The nodes that stand on a line, of a list in the order of their places.
template <class Node>
std::span<Node> nodes_on(std::vector<Node>& nodes, const ast::Line& line) {
  const auto before = [](const Node& node, std::uint32_t place) { return place_of(node) < place; };
  const auto first = std::lower_bound(nodes.begin(), nodes.end(), line.begin, before);
  const auto last = std::lower_bound(first, nodes.end(), line.end, before);
  return {first, last};
}

// Compared by the piece, which the library does much faster than by the byte.
constexpr std::size_t piece = 256;

std::size_t common_begin(std::string_view a, std::string_view b) {
  const std::size_t most = std::min(a.size(), b.size());
  std::size_t same = 0;
  while (most - same >= piece && a.substr(same, piece) == b.substr(same, piece)) same += piece;
  while (same < most && a[same] == b[same]) ++same;
  return same;
}

std::size_t common_end(std::string_view a, std::string_view b) {
  const std::size_t most = std::min(a.size(), b.size());
  const auto before = [](std::string_view text, std::size_t end) {
    return text.substr(text.size() - end - piece, piece);
  };
  std::size_t same = 0;
  while (most - same >= piece && before(a, same) == before(b, same)) same += piece;
  while (same < most && a[a.size() - 1 - same] == b[b.size() - 1 - same]) ++same;
  return same;
}

template <class Node>
Node* node_on(std::vector<Node>& nodes, const ast::Line& line) {
  const std::span<Node> found = nodes_on(nodes, line);
  return found.empty() ? nullptr : &found.front();
}

}  // namespace

Earlier::Earlier(std::string_view earlier_text, ast::File& earlier, std::string_view text,
                 SourceId source)
    : earlier_text_(earlier_text), earlier_(earlier), text_(text), source_(source) {
  same_begin_ = common_begin(text, earlier_text_);
  same_end_ = common_end(text.substr(same_begin_), earlier_text_.substr(same_begin_));
}

// From the earlier text to this one, of lines of this one that both have; nothing for others. The
// line end belongs to a line: without it the line might go on.
std::optional<std::int64_t> Earlier::distance(std::uint32_t begin, std::uint32_t end) const {
  if (end == 0 || end > text_.size() || text_[end - 1] != '\n') return std::nullopt;
  if (end <= same_begin_) return 0;
  if (begin < text_.size() - same_end_) return std::nullopt;
  return static_cast<std::int64_t>(text_.size()) - static_cast<std::int64_t>(earlier_text_.size());
}

// Statements are asked for in their order, so the next one is near the last one.
const ast::Line* Earlier::line_at(std::uint32_t begin) {
  const std::vector<ast::Line>& lines = earlier_.written.lines;
  constexpr std::size_t near = 16;
  for (std::size_t step = 0; step < near && next_line_ < lines.size(); ++step) {
    if (lines[next_line_].begin >= begin) break;
    ++next_line_;
  }
  if (next_line_ >= lines.size() || lines[next_line_].begin != begin) {
    const auto found = std::lower_bound(
        lines.begin(), lines.end(), begin,
        [](const ast::Line& line, std::uint32_t place) { return line.begin < place; });
    next_line_ = static_cast<std::size_t>(found - lines.begin());
    if (found == lines.end() || found->begin != begin) return nullptr;
  }
  return &lines[next_line_];
}

// The earlier form of a line that has not changed.
const ast::Line* Earlier::same_line(const ast::Line& written) {
  const std::optional<std::int64_t> moved = distance(written.begin, written.end);
  if (!moved) return nullptr;
  const ast::Line* const line = line_at(static_cast<std::uint32_t>(written.begin - *moved));
  const bool is_same = line != nullptr && line->is_plain &&
                       line->kind == ast::LineKind::statement &&
                       line->end - line->begin == written.end - written.begin;
  if (!is_same) return nullptr;
  shift_ = {source_, *moved};
  return line;
}

// The last declaration that begins before a place.
ast::Declaration* Earlier::declaration_before(std::uint32_t end) {
  std::vector<ast::Declaration>& all = earlier_.declarations;
  const auto behind = std::partition_point(
      all.begin(), all.end(), [end](const ast::Declaration& one) { return begin_of(one) < end; });
  return behind == all.begin() ? nullptr : &*std::prev(behind);
}

std::optional<Earlier::Block> Earlier::block(std::uint32_t begin) {
  // Whatever the first line is, it has to have been the first line.
  const bool is_early = begin < same_begin_;
  if (!is_early && begin < text_.size() - same_end_) return std::nullopt;
  const std::int64_t moved = is_early ? 0
                                      : static_cast<std::int64_t>(text_.size()) -
                                            static_cast<std::int64_t>(earlier_text_.size());
  const ast::Line* const first = line_at(static_cast<std::uint32_t>(begin - moved));
  if (first == nullptr || !first->is_plain || first->is_in_block) return std::nullopt;
  const ast::Line* const end_of_lines =
      earlier_.written.lines.data() + earlier_.written.lines.size();
  const ast::Line* last = first + 1;
  while (last != end_of_lines && last->is_in_block && last->is_plain) ++last;
  const bool is_whole = last != end_of_lines && last->is_plain && !last->is_in_block &&
                        last->kind == ast::LineKind::statement;
  if (!is_whole) return std::nullopt;
  const Shift by{source_, moved};
  if (!distance(begin, by.moved(last->end))) return std::nullopt;
  ast::Declaration* const declaration = declaration_before(first->end);
  if (declaration == nullptr || begin_of(*declaration) < first->begin) return std::nullopt;
  next_line_ = static_cast<std::size_t>(last - earlier_.written.lines.data());
  Block block{std::move(*declaration), {first, last + 1}, by};
  // What is left keeps its place, by which others are found.
  if (moved != 0 || earlier_.source != source_) {
    std::visit([&by](auto& node) { shift(node, by); }, block.declaration);
  }
  return block;
}

template <class Node>
std::optional<Node> Earlier::given(Node* node, const LogicalLine& line, const ast::Line& earlier) {
  if (node == nullptr) return std::nullopt;
  // What is left keeps its place, by which others are found.
  std::optional<Node> result = std::move(*node);
  shift(*result, shift_);
  result->documentation = line.documentation();
  given_ = &earlier;
  return result;
}

std::optional<ast::Field> Earlier::field(const LogicalLine& line, const ast::Line& written) {
  const ast::Line* const earlier = same_line(written);
  if (earlier == nullptr) return std::nullopt;
  ast::Declaration* const declaration = declaration_before(earlier->begin);
  auto* const record = declaration == nullptr ? nullptr : std::get_if<ast::Record>(declaration);
  if (record == nullptr) return std::nullopt;
  return given(node_on(record->fields, *earlier), line, *earlier);
}

std::optional<ast::Member> Earlier::member(const LogicalLine& line, const ast::Line& written) {
  const ast::Line* const earlier = same_line(written);
  if (earlier == nullptr) return std::nullopt;
  ast::Declaration* const declaration = declaration_before(earlier->begin);
  auto* const object = declaration == nullptr ? nullptr : std::get_if<ast::Object>(declaration);
  if (object == nullptr) return std::nullopt;
  return given(node_on(object->members, *earlier), line, *earlier);
}

std::optional<ast::Constant> Earlier::constant(const LogicalLine& line, const ast::Line& written) {
  const ast::Line* const earlier = same_line(written);
  if (earlier == nullptr) return std::nullopt;
  ast::Declaration* const declaration = declaration_before(earlier->end);
  if (declaration == nullptr) return std::nullopt;
  if (auto* const constant = std::get_if<ast::Constant>(declaration)) {
    return given(constant->span.begin < earlier->begin ? nullptr : constant, line, *earlier);
  }
  if (auto* const record = std::get_if<ast::Record>(declaration)) {
    return given(node_on(record->constants, *earlier), line, *earlier);
  }
  auto* const object = std::get_if<ast::Object>(declaration);
  if (object == nullptr) return std::nullopt;
  return given(node_on(object->constants, *earlier), line, *earlier);
}

std::optional<EnumLine> Earlier::enum_line(const LogicalLine& line, const ast::Line& written) {
  const ast::Line* const earlier = same_line(written);
  if (earlier == nullptr) return std::nullopt;
  ast::Declaration* const declaration = declaration_before(earlier->begin);
  auto* const enumeration = declaration == nullptr ? nullptr : std::get_if<ast::Enum>(declaration);
  if (enumeration == nullptr) return std::nullopt;
  const std::span<ast::EnumValue> values = nodes_on(enumeration->values, *earlier);
  if (values.empty()) return std::nullopt;
  EnumLine result;
  for (ast::EnumValue& value : values) {
    shift(result.values.emplace_back(std::move(value)), shift_);
  }
  result.values.front().documentation = line.documentation();
  result.ends_in_comma = earlier_.written.tokens_of(*earlier).back().kind == ast::TokenKind::comma;
  given_ = earlier;
  return result;
}

void Earlier::append_tokens(const ast::Line& line, const Shift& by,
                            std::vector<ast::Token>& tokens) const {
  for (const ast::Token& token : earlier_.written.tokens_of(line)) {
    tokens.push_back({token.kind, by.moved(token.begin), by.moved(token.end)});
  }
}

std::uint32_t Earlier::take_tokens(std::vector<ast::Token>& tokens) {
  const ast::Line* const line = std::exchange(given_, nullptr);
  if (line == nullptr) return 0;
  append_tokens(*line, shift_, tokens);
  return line->token_count;
}

}  // namespace robdef::syntax
