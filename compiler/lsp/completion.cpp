// SPDX-License-Identifier: Apache-2.0
// Looks at the line as far as it is written, since it can rarely be read yet.
#include "compiler/lsp/completion.hpp"

#include <algorithm>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/lsp/words.hpp"
#include "compiler/model/resolve.hpp"
#include "compiler/syntax/words.hpp"

namespace robdef::lsp {
namespace {

using syntax::Keyword;

// Kinds of the protocol.
enum ItemKind : int {
  property_item = 10,
  class_item = 7,
  interface_item = 8,
  module_item = 9,
  enum_item = 13,
  keyword_item = 14,
  constant_item = 21,
  struct_item = 22,
  type_item = 25,
};

std::string_view first_word(std::string_view line) {
  line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
  const auto end = std::ranges::find_if_not(line, syntax::is_word_character);
  return line.substr(0, static_cast<std::size_t>(end - line.begin()));
}

/// Where the cursor is.
struct Context {
  std::string_view before;  ///< the line up to the word that is completed
  std::uint32_t word_begin = 0;
  std::string_view word;
  Keyword block = Keyword::none;  ///< of the block around it
  std::string_view block_name;
  Keyword statement = Keyword::none;
};

Context context_at(std::string_view text, std::uint32_t offset) {
  Context context;
  offset = std::min(offset, static_cast<std::uint32_t>(text.size()));
  std::size_t begin = 0;
  for (;;) {
    const std::size_t end = text.find('\n', begin);
    if (end == text.npos || end >= offset) break;
    const std::string_view line = text.substr(begin, end - begin);
    const Keyword keyword = syntax::keyword_of(first_word(line));
    if (keyword == Keyword::end) context.block = Keyword::none;
    // A value of an enum may have any name.
    if (syntax::is_block_keyword(keyword) && context.block != Keyword::enum_) {
      context.block = keyword;
      std::string_view rest = line;
      rest.remove_prefix(rest.find(first_word(line)) + first_word(line).size());
      context.block_name = first_word(rest);
    }
    begin = end + 1;
  }
  const std::string_view line = text.substr(begin, offset - begin);
  std::size_t word = line.size();
  while (word > 0 && (syntax::is_word_character(line[word - 1]) || line[word - 1] == '.')) --word;
  context.before = line.substr(0, word);
  context.word = line.substr(word);
  context.word_begin = static_cast<std::uint32_t>(begin + word);
  context.statement = syntax::keyword_of(first_word(context.before));
  return context;
}

std::size_t count_words(std::string_view text) {
  std::size_t count = 0;
  bool is_in_word = false;
  for (const char c : text) {
    const bool is_blank = syntax::is_blank(c);
    if (!is_blank && !is_in_word) ++count;
    is_in_word = !is_blank;
  }
  return count;
}

ItemKind item_kind(const Symbol& symbol) {
  switch (symbol.kind) {
    case SymbolKind::enumeration:
      return enum_item;
    case SymbolKind::object:
      return interface_item;
    case SymbolKind::record:
      return struct_item;
    case SymbolKind::constant:
      return constant_item;
    default:
      return class_item;
  }
}

class Completer {
 public:
  Completer(const Analysis& analysis, Workspace& workspace, std::uint32_t offset, Encoding encoding)
      : analysis_(analysis),
        workspace_(workspace),
        context_(context_at(analysis.text().bytes(), offset)) {
    range_ = to_json(analysis.text().range({SourceId{}, context_.word_begin, offset}, encoding));
  }

  Json run() {
    find_items();
    return {{"isIncomplete", false}, {"items", std::move(items_)}};
  }

 private:
  void find_items() {
    const std::string_view before = context_.before;
    if (first_sign(before) == '#') return;
    if (before.find_first_not_of(" \t") == before.npos) return statements();
    switch (context_.statement) {
      case Keyword::import:
        return count_words(before) == 1 ? imports() : void();
      case Keyword::using_:
        return count_words(before) == 1 ? imported_names() : void();
      case Keyword::implements:
        return count_words(before) == 1 ? types(SymbolKind::object) : void();
      case Keyword::stdver:
        return add("0.10", keyword_item, "the usual version");
      case Keyword::none:
      case Keyword::service:
      case Keyword::end:
      case Keyword::exception:
      case Keyword::option:
        return;
      default:
        return in_member();
    }
  }

  static char first_sign(std::string_view line) {
    const std::size_t at = line.find_first_not_of(" \t");
    return at == line.npos ? '\0' : line[at];
  }

  void in_member() {
    const std::string_view before = context_.before;
    const std::size_t bracket = before.find_last_of("[]");
    if (bracket != before.npos && before[bracket] == '[') {
      const bool is_modifier = bracket > 0 && syntax::is_blank(before[bracket - 1]);
      return is_modifier ? modifiers(before.substr(bracket)) : void();
    }
    const std::size_t brace = before.find_last_of("{}");
    if (brace != before.npos && before[brace] == '{') return containers();
    const std::size_t parenthesis = before.find_last_of("()");
    if (parenthesis != before.npos) {
      const std::size_t start = before.find_last_of("(,");
      const bool is_first =
          before[parenthesis] == '(' && before.find_first_not_of(" \t", start + 1) == before.npos;
      return is_first ? types() : void();
    }
    if (count_words(before) == 1) first_type();
  }

  void first_type() {
    switch (context_.statement) {
      case Keyword::event:
        return;
      case Keyword::objref:
        add("varobject", type_item, help_of_word("varobject"));
        return types(SymbolKind::object);
      case Keyword::constant:
        for (const WordHelp& one : type_helps()) {
          if (syntax::is_number_type(one.word) && !one.word.starts_with('c') &&
              one.word != "bool") {
            add(one.word, type_item, one.help);
          }
        }
        add("string", type_item, help_of_word("string"));
        return add("struct", keyword_item, "a struct of constants");
      default:
        return syntax::is_block_keyword(context_.statement) ? void() : types();
    }
  }

  void statements() {
    if (context_.word.find('.') != std::string_view::npos) return;
    for (const WordHelp& one : keyword_helps()) {
      if (fits_here(syntax::keyword_of(one.word))) add(one.word, keyword_item, one.help);
    }
  }

  [[nodiscard]] bool fits_here(Keyword keyword) const {
    const bool is_part = syntax::is_member_keyword(keyword) || keyword == Keyword::implements;
    switch (context_.block) {
      case Keyword::none:
        if (keyword == Keyword::service) return !analysis_.file().service;
        return !is_part && keyword != Keyword::end && keyword != Keyword::field &&
               keyword != Keyword::option;
      case Keyword::enum_:
        return keyword == Keyword::end;
      case Keyword::object:
        return is_part || keyword == Keyword::constant || keyword == Keyword::end;
      default:
        return keyword == Keyword::field || keyword == Keyword::constant || keyword == Keyword::end;
    }
  }

  void modifiers(std::string_view inside) {
    const std::size_t open = inside.find_last_of("()");
    if (open != inside.npos && inside[open] == '(') return block_constants();
    const ast::MemberKind kind = member_kind();
    for (const WordHelp& one : modifier_helps()) {
      if (inside.find(one.word) == inside.npos && model::knows_modifier(kind, one.word)) {
        add(one.word, keyword_item, one.help);
      }
    }
  }

  [[nodiscard]] ast::MemberKind member_kind() const {
    for (int number = 0; number <= static_cast<int>(ast::MemberKind::memory); ++number) {
      const auto kind = static_cast<ast::MemberKind>(number);
      if (word_of(kind) == syntax::text_of(context_.statement)) return kind;
    }
    return ast::MemberKind::property;  // fields have its modifiers
  }

  void block_constants() {
    const Symbol* const block = analysis_.index().find(analysis_.file(), context_.block_name);
    if (block == nullptr) return;
    for (const Symbol& one : analysis_.index().symbols()) {
      if (one.owner == block && one.kind == SymbolKind::constant) add(one);
    }
  }

  void containers() {
    add("list", keyword_item, "values in order, any of them null");
    add("int32", keyword_item, "values by numbers");
    add("string", keyword_item, "values by texts");
    if (context_.statement == Keyword::function) {
      add("generator", keyword_item, "values one by one, as they are asked for");
    }
  }

  void imports() {
    std::set<std::string> known;
    for (const ast::Import& one : analysis_.file().imports) known.insert(one.name.text);
    // That of the line itself is read already when it has a name.
    known.erase(std::string(context_.word));
    for (const std::string& service : workspace_.importable_services(analysis_.path())) {
      if (!known.contains(service)) add(service, module_item, "service definition");
    }
  }

  void imported_names() {
    for (const Symbol& one : analysis_.index().symbols()) {
      if (one.owner == nullptr && is_imported(one))
        add(one.path(), item_kind(one), one.word, one.documentation);
    }
  }

  [[nodiscard]] bool is_imported(const Symbol& symbol) const {
    if (symbol.kind == SymbolKind::service || symbol.kind == SymbolKind::alias ||
        symbol.file == &analysis_.file() || !symbol.file->service) {
      return false;
    }
    return std::ranges::any_of(analysis_.file().imports, [&](const ast::Import& one) {
      return one.name.text == symbol.file->service->text;
    });
  }

  // Values, or objects alone.
  void types(SymbolKind wanted = SymbolKind::record) {
    const bool wants_objects = wanted == SymbolKind::object;
    if (!wants_objects && context_.word.find('.') == std::string_view::npos) {
      const bool can_be_void =
          context_.statement == Keyword::function || context_.statement == Keyword::callback;
      for (const WordHelp& one : type_helps()) {
        const bool is_void = one.word == "void";
        if (one.word == "varobject" || (is_void && !can_be_void)) continue;
        add(one.word, type_item, one.help);
      }
    }
    const auto fits = [&](const Symbol& one) {
      return wants_objects ? one.kind == SymbolKind::object
                           : one.kind == SymbolKind::record || one.kind == SymbolKind::enumeration;
    };
    std::set<const Symbol*> aliased;
    for (const ast::Using& one : analysis_.file().usings) {
      const std::string_view name =
          one.alias ? std::string_view(one.alias->text) : std::string_view(one.qualified.text);
      const Symbol* found = analysis_.index().find(analysis_.file(), name);
      if (found != nullptr && found->target != nullptr) found = found->target;
      if (found == nullptr || !fits(*found)) continue;
      aliased.insert(found);
      add(one.alias ? one.alias->text : found->name, item_kind(*found), found->path(),
          found->documentation);
    }
    for (const Symbol& one : analysis_.index().symbols()) {
      if (one.owner != nullptr || !fits(one) || aliased.contains(&one)) continue;
      if (one.file == &analysis_.file()) add(one);
      if (is_imported(one)) add(one.path(), item_kind(one), one.word, one.documentation);
    }
  }

  void add(const Symbol& symbol) {
    add(symbol.name, item_kind(symbol), symbol.word, symbol.documentation);
  }

  void add(std::string_view label, ItemKind kind, std::string_view detail,
           std::string_view documentation = {}) {
    Json item = {{"label", std::string(label)},
                 {"kind", static_cast<int>(kind)},
                 {"detail", std::string(detail)},
                 {"filterText", std::string(label)},
                 {"textEdit", {{"range", range_}, {"newText", std::string(label)}}}};
    if (!documentation.empty()) {
      item["documentation"] = {{"kind", "markdown"}, {"value", std::string(documentation)}};
    }
    items_.push_back(std::move(item));
  }

  const Analysis& analysis_;
  Workspace& workspace_;
  const Context context_;
  Json range_;
  Json items_ = Json::array();
};

}  // namespace

Json completions_at(const Analysis& analysis, Workspace& workspace, std::uint32_t offset,
                    Encoding encoding) {
  return Completer(analysis, workspace, offset, encoding).run();
}

}  // namespace robdef::lsp
