// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "compiler/diagnostics/source.hpp"
#include "compiler/syntax/ast.hpp"

namespace robdef::lsp {

enum class SymbolKind : std::uint8_t {
  service,
  alias,  ///< the name behind `as`
  constant,
  exception,
  enumeration,
  enum_value,
  record,
  object,
  field,
  member,
  parameter,
};

/// Something that has a name, as written. Valid as long as the program that it was found in.
struct Symbol {
  SymbolKind kind{};
  std::string name;
  std::string_view word;  ///< of the language: `pod`, `property`; `value`, `parameter`
  Span span;              ///< the name
  Span line;              ///< its line; of what is a block the first one
  std::string_view documentation;
  const ast::File* file = nullptr;
  const Symbol* owner = nullptr;   ///< the block, or the member of a parameter
  const Symbol* target = nullptr;  ///< alias: what it stands for

  /// Service, owners and name with dots.
  [[nodiscard]] std::string path() const;
};

/// A name in the text.
struct Occurrence {
  Span span;
  const Symbol* symbol = nullptr;
  bool is_declaration = false;
};

/// What each name of a program's first file stands for, and all that the files of the program
/// declare. Looks at names only, so it works in files with mistakes, too.
class Index {
 public:
  /// The program must outlive it.
  explicit Index(const ast::Program& program);

  /// Of the first file, by their places.
  [[nodiscard]] const std::vector<Occurrence>& occurrences() const { return occurrences_; }
  /// The name at an offset of the first file, or that ends there; nullptr when there is none.
  [[nodiscard]] const Occurrence* at(std::uint32_t offset) const;
  /// Of all files.
  [[nodiscard]] const std::deque<Symbol>& symbols() const { return symbols_; }
  /// Members of objects of the first file, each with the one of an object that it implements: they
  /// have to have the same name.
  [[nodiscard]] const std::vector<std::pair<const Symbol*, const Symbol*>>& same_members() const {
    return same_members_;
  }

  /// What a file calls by this name, plain or with a service. Aliases are symbols of their own.
  [[nodiscard]] const Symbol* find(const ast::File& user, std::string_view name) const;
  [[nodiscard]] const Symbol* find_service(std::string_view name) const;
  /// A part of a block.
  [[nodiscard]] const Symbol* part_of(const Symbol& owner, std::string_view name) const;

 private:
  struct Scope {
    const Symbol* service = nullptr;
    std::unordered_map<std::string_view, const Symbol*> names;  ///< own ones, and those of using
  };

  const Symbol* add(Symbol symbol);
  void declare(const ast::File& file);
  void declare_part(const Symbol& owner, const ast::Name& name, SymbolKind kind,
                    std::string_view word, Span line, std::string_view documentation);
  void declare_object(const ast::Object& object, const Symbol& symbol);
  void declare_usings(const ast::File& file);

  /// What is declared at a place.
  [[nodiscard]] const Symbol& declared(Span name) const;
  const Symbol& note_declared(Span name);
  void note(Span span, const Symbol* symbol, bool is_declaration = false);
  /// The first one that begins after a place.
  [[nodiscard]] std::vector<Occurrence>::const_iterator occurrence_after(
      std::uint32_t offset) const;
  void note_name(const ast::File& file, const ast::Name& name);
  void note_type(const ast::File& file, const ast::TypeRef& type);
  void note_modifiers(const Symbol& owner, const std::vector<ast::Modifier>& modifiers);
  void note_constant(const ast::File& file, const Symbol* owner, const ast::Constant& constant);
  void note_object(const ast::File& file, const ast::Object& object, const Symbol& symbol);
  void note_record(const ast::File& file, const ast::Record& record, const Symbol& symbol);
  void note_file(const ast::File& file);

  std::deque<Symbol> symbols_;
  std::unordered_map<const ast::File*, Scope> scopes_;
  std::unordered_map<std::string_view, const Symbol*> services_;
  std::unordered_map<const Symbol*, std::unordered_map<std::string_view, const Symbol*>> parts_;
  std::unordered_map<std::uint64_t, const Symbol*> places_;
  std::vector<Occurrence> occurrences_;  // by their places
  std::vector<std::pair<const Symbol*, const Symbol*>> same_members_;
};

/// `property`, ...
std::string_view word_of(ast::MemberKind kind);

}  // namespace robdef::lsp
