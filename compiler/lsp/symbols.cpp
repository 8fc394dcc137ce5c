// SPDX-License-Identifier: Apache-2.0
#include "compiler/lsp/symbols.hpp"

#include <algorithm>
#include <optional>
#include <unordered_map>
#include <utility>
#include <vector>

#include "compiler/format/format.hpp"
#include "compiler/syntax/words.hpp"

namespace robdef::lsp {
namespace {

// Numbers of the protocol.
int kind_number(const Symbol& symbol) {
  constexpr int name_space = 3, klass = 5, method = 6, property = 7, field = 8, enumeration = 10,
                interface = 11, variable = 13, constant = 14, enum_member = 22, record = 23,
                event = 24;
  switch (symbol.kind) {
    case SymbolKind::service:
      return name_space;
    case SymbolKind::alias:
    case SymbolKind::parameter:
      return variable;
    case SymbolKind::constant:
      return constant;
    case SymbolKind::exception:
      return klass;
    case SymbolKind::enumeration:
      return enumeration;
    case SymbolKind::enum_value:
      return enum_member;
    case SymbolKind::record:
      return record;
    case SymbolKind::object:
      return interface;
    case SymbolKind::field:
      return field;
    case SymbolKind::member:
      break;
  }
  if (symbol.word == "function" || symbol.word == "callback") return method;
  return symbol.word == "event" ? event : property;
}

/// A block, from its first line to its `end`.
struct Block {
  std::uint32_t begin = 0;
  std::uint32_t last_line = 0;  ///< begin of the line of `end`
  std::uint32_t end = 0;
};

// By where their first lines begin.
std::vector<Block> blocks_of(const Analysis& analysis) {
  const ast::LosslessText& written = analysis.file().written;
  const std::string_view text = analysis.text().bytes();
  std::vector<Block> blocks;
  std::optional<Block> open;
  const auto close = [&](std::uint32_t at, std::uint32_t end) {
    open->last_line = at;
    open->end = end;
    blocks.push_back(*open);
    open.reset();
  };
  for (const ast::Line& line : written.lines) {
    const auto tokens = written.tokens_of(line);
    if (tokens.empty()) continue;
    const ast::Token& first = tokens.front();
    const syntax::Keyword keyword =
        syntax::keyword_of(text.substr(first.begin, first.end - first.begin));
    if (open && keyword == syntax::Keyword::end) {
      close(first.begin, tokens.back().end);
    } else if (first.kind == ast::TokenKind::keyword && syntax::is_block_keyword(keyword)) {
      if (open) close(open->begin, open->begin);
      open = Block{first.begin, 0, 0};
    }
  }
  return blocks;
}

/// Puts declarations and their parts into one another.
class Outline {
 public:
  Outline(const Analysis& analysis, Encoding encoding)
      : analysis_(analysis), encoding_(encoding), blocks_(blocks_of(analysis)) {}

  Json run() {
    Json all = Json::array();
    std::unordered_map<const Symbol*, std::vector<const Symbol*>> parts;
    std::vector<const Symbol*> roots;
    for (const Symbol& one : analysis_.index().symbols()) {
      if (one.span.source != SourceId{} || one.kind == SymbolKind::service) continue;
      if (one.kind == SymbolKind::parameter || one.kind == SymbolKind::alias) continue;
      if (one.owner == nullptr) {
        roots.push_back(&one);
      } else {
        parts[one.owner].push_back(&one);
      }
    }
    for (const Symbol* root : roots) {
      Json json = symbol(*root, whole(*root));
      for (const Symbol* part : parts[root]) json["children"].push_back(symbol(*part, part->line));
      all.push_back(std::move(json));
    }
    return all;
  }

 private:
  [[nodiscard]] Json symbol(const Symbol& one, Span whole) const {
    return {{"name", one.name},
            {"detail", std::string(one.word)},
            {"kind", kind_number(one)},
            {"range", to_json(analysis_.text().range(whole, encoding_))},
            {"selectionRange", to_json(analysis_.text().range(one.span, encoding_))}};
  }

  [[nodiscard]] Span whole(const Symbol& one) const {
    Span span = one.line;
    const auto block = std::ranges::lower_bound(blocks_, span.begin, {}, &Block::begin);
    if (block != blocks_.end() && block->begin == span.begin)
      span.end = std::max(span.end, block->end);
    return span;
  }

  const Analysis& analysis_;
  const Encoding encoding_;
  const std::vector<Block> blocks_;
};

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; }

bool fits(std::string_view query, std::string_view name) {
  for (const char c : name) {
    if (query.empty()) return true;
    if (lower(c) == lower(query.front())) query.remove_prefix(1);
  }
  return query.empty();
}

}  // namespace

Json document_symbols(const Analysis& analysis, Encoding encoding) {
  return Outline(analysis, encoding).run();
}

Json workspace_symbols(Workspace& workspace, std::string_view query, Encoding encoding) {
  constexpr std::size_t most = 500;
  Json all = Json::array();
  for (const std::string& path : workspace.files()) {
    const auto analysis = workspace.analysis(path);
    if (!analysis) continue;
    for (const Symbol& one : analysis->index().symbols()) {
      if (one.span.source != SourceId{} || one.kind == SymbolKind::parameter ||
          one.kind == SymbolKind::alias || !fits(query, one.name)) {
        continue;
      }
      if (all.size() == most) return all;
      const Symbol* const owner = one.owner;
      const auto& service = one.file->service;
      all.push_back({{"name", one.name},
                     {"kind", kind_number(one)},
                     {"containerName", owner != nullptr ? owner->path()
                                       : service        ? service->text
                                                        : std::string()},
                     {"location",
                      {{"uri", workspace.uri_of_path(path)},
                       {"range", to_json(analysis->text().range(one.span, encoding))}}}});
    }
  }
  return all;
}

Json folding_ranges(const Analysis& analysis, Encoding encoding) {
  const Text& text = analysis.text();
  Json all = Json::array();
  const auto add = [&](std::uint32_t begin, std::uint32_t last, const char* kind) {
    const std::uint32_t first_line = text.place(begin, encoding).line;
    const std::uint32_t last_line = text.place(last, encoding).line;
    if (last_line <= first_line) return;
    Json range = {{"startLine", first_line}, {"endLine", last_line}};
    if (kind != nullptr) range["kind"] = kind;
    all.push_back(std::move(range));
  };
  for (const Block& block : blocks_of(analysis)) add(block.begin, block.last_line, nullptr);
  const ast::Line* first = nullptr;
  const ast::Line* last = nullptr;
  const auto end_comment = [&] {
    if (first != nullptr) add(first->begin, last->begin, "comment");
    first = nullptr;
  };
  for (const ast::Line& line : analysis.file().written.lines) {
    const bool is_comment =
        line.kind == ast::LineKind::comment || line.kind == ast::LineKind::documentation;
    if (!is_comment) {
      end_comment();
    } else {
      if (first == nullptr) first = &line;
      last = &line;
    }
  }
  end_comment();
  return all;
}

Json formatting_edits(const Analysis& analysis, Encoding encoding) {
  Json all = Json::array();
  const Text& text = analysis.text();
  for (const format::Edit& edit : format::edits(analysis.file().written, text.bytes())) {
    all.push_back({{"range", to_json(text.range({SourceId{}, edit.begin, edit.end}, encoding))},
                   {"newText", edit.replacement}});
  }
  return all;
}

}  // namespace robdef::lsp
