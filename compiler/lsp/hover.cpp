// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <string>
#include <string_view>

#include "compiler/lsp/navigation.hpp"
#include "compiler/lsp/words.hpp"

namespace robdef::lsp {
namespace {

// The bytes of a line with blanks in place of continuations.
std::string joined(std::string_view text) {
  std::string line;
  for (const char c : text) {
    const bool is_space = c == ' ' || c == '\t' || c == '\\' || c == '\r' || c == '\n';
    if (!is_space) {
      line += c;
    } else if (!line.empty() && line.back() != ' ') {
      line += ' ';
    }
  }
  while (line.ends_with(' ')) line.pop_back();
  return line;
}

std::string signature_of(const Analysis& analysis, const Symbol& symbol) {
  const std::string& text = analysis.sources[symbol.line.source].text();
  const auto written = [&](Span span) {
    return joined(text.substr(span.begin, span.end - span.begin));
  };
  switch (symbol.kind) {
    case SymbolKind::service:
      return "service " + symbol.name;
    case SymbolKind::enum_value:
    case SymbolKind::parameter:
      return symbol.owner->name + (symbol.kind == SymbolKind::parameter ? ": " : ".") + symbol.name;
    default:
      return written(symbol.line);
  }
}

std::string origin_of(const Symbol& symbol) {
  if (symbol.kind == SymbolKind::service || symbol.kind == SymbolKind::alias) return {};
  if (symbol.owner != nullptr) {
    return std::string(symbol.word) + " of `" + symbol.owner->path() + '`';
  }
  return symbol.file->service ? "declared by `" + symbol.file->service->text + '`' : std::string();
}

// What evaluate() and lay_out() have found.
std::string computed(const Analysis& analysis, const Symbol& symbol) {
  for (const auto& definition : analysis.model.definitions()) {
    if (definition->source != symbol.span.source) continue;
    if (symbol.kind == SymbolKind::enum_value) {
      for (const model::Enum& one : definition->enums) {
        const auto value = std::ranges::find(one.values, symbol.span, &model::EnumValue::span);
        if (value != one.values.end()) return "value " + std::to_string(value->value);
      }
    }
    const auto record = std::ranges::find(definition->records, symbol.span, &model::Record::span);
    if (symbol.kind != SymbolKind::record || record == definition->records.end()) continue;
    if (record->kind == model::RecordKind::namedarray && record->number_count > 0) {
      return std::to_string(record->number_count) + " numbers of type `" +
             std::string(model::name_of(record->number)) + "`";
    }
    if (record->kind == model::RecordKind::pod && record->packed_size > 0) {
      return "at most " + std::to_string(record->packed_size) + " bytes in a message";
    }
  }
  return {};
}

void add_paragraph(std::string& text, std::string_view paragraph) {
  if (!paragraph.empty()) text += "\n\n" + std::string(paragraph);
}

Json markdown(const std::string& text, const Range& range) {
  return {{"contents", {{"kind", "markdown"}, {"value", text}}}, {"range", to_json(range)}};
}

// A word of the language.
Json word_at(const Analysis& analysis, std::uint32_t offset, Encoding encoding) {
  const ast::LosslessText& written = analysis.file().written;
  const ast::Line* const line = written.line_at(offset);
  if (line == nullptr) return nullptr;
  for (const ast::Token& token : written.tokens_of(*line)) {
    if (offset < token.begin || offset > token.end) continue;
    const std::string_view word =
        std::string_view(analysis.text().bytes()).substr(token.begin, token.end - token.begin);
    const std::string_view help = help_of_word(word);
    if (help.empty()) continue;
    std::string text = "```robdef\n" + std::string(word) + "\n```";
    add_paragraph(text, help);
    return markdown(text, analysis.text().range({SourceId{}, token.begin, token.end}, encoding));
  }
  return nullptr;
}

}  // namespace

Json hover_at(const Analysis& analysis, std::uint32_t offset, Encoding encoding) {
  const Occurrence* const found = analysis.index().at(offset);
  if (found == nullptr) return word_at(analysis, offset, encoding);
  const Symbol* symbol = found->symbol;
  std::string text;
  if (symbol->target != nullptr) {
    text = "`" + symbol->name + "` stands for `" + symbol->target->path() + "`\n\n";
    symbol = symbol->target;
  }
  text += "```robdef\n" + signature_of(analysis, *symbol) + "\n```";
  add_paragraph(text, symbol->documentation);
  add_paragraph(text, computed(analysis, *symbol));
  add_paragraph(text, origin_of(*symbol));
  return markdown(text, analysis.text().range(found->span, encoding));
}

}  // namespace robdef::lsp
