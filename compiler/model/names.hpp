// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <tuple>
#include <unordered_map>
#include <vector>

#include "compiler/diagnostics/report.hpp"
#include "compiler/diagnostics/source.hpp"
#include "compiler/model/model.hpp"
#include "compiler/model/syntax_errors.hpp"
#include "compiler/syntax/ast.hpp"

namespace robdef::model {

/// A declaration of a file under its name.
struct Named {
  std::string_view name;
  std::string_view kind;  ///< `struct`, `exception`, ...
  Base base = Unknown{};  ///< Unknown for constants and exceptions, which are not types
  Span span;

  [[nodiscard]] bool is_type() const { return !std::holds_alternative<Unknown>(base); }
  [[nodiscard]] bool is_object() const { return std::holds_alternative<const Object*>(base); }
};

/// What a name is looked for as, and how its absence is reported.
struct Wanted {
  Code code;
  std::string_view noun;  ///< `type` or `object`
  bool (*fits)(const Named&);
};

/// The names of all definitions of a model. Finds what a written name stands for, or says why there
/// is nothing and what was probably meant. In silence where the reason has been reported before: an
/// alias of something unknown, an import that was not found, a line that could not be parsed.
class Names {
 public:
  Names(const Sources& sources, const SyntaxErrors& syntax_errors, Report& report)
      : sources_(sources), syntax_errors_(syntax_errors), report_(report) {}

  /// Enters a definition with everything it declares. Each definition is added before any look-up.
  void add(const Definition& definition);
  /// An import line, found or not.
  void add_import(const Definition& user, std::string_view service, const Definition* imported);
  /// A using line; reports R0508 when it names nothing.
  void add_alias(const Definition& user, std::string_view alias, const ast::Name& qualified);

  /// The type of that name, or Unknown; reports R0203.
  Base type(const Definition& user, const ast::Name& name);
  /// The object of that name, or nullptr; reports `code`.
  const Object* object(const Definition& user, const ast::Name& name, Code code);

 private:
  struct Scope {
    const Definition* definition = nullptr;
    std::unordered_map<std::string_view, Named> declared;
    std::vector<std::string_view> order;  ///< of `declared`
    /// nullptr for one that has been reported.
    std::unordered_map<std::string_view, const Named*> aliases;
    std::vector<std::string_view> alias_order;
    std::unordered_map<std::string_view, const Definition*> imports;
    std::vector<std::string_view> import_order;
  };

  const Named* find(const Definition& user, const ast::Name& name, const Wanted& wanted);
  const Named* find_plain(const Scope& scope, const ast::Name& name, const Wanted& wanted);
  const Named* find_qualified(const Scope& scope, const ast::Name& name, const Wanted& wanted);
  void report_plain(const Scope& scope, const ast::Name& name, const Wanted& wanted);
  void report_own(const Scope& scope, const ast::Name& name, const Wanted& wanted);
  void report_not_imported(const Scope& scope, const ast::Name& name, const Wanted& wanted);
  bool suggest_elsewhere(Diagnostic& diagnostic, const Scope& scope, std::string_view name,
                         const Wanted& wanted) const;
  void suggest_near(Diagnostic& diagnostic, const Scope& scope, std::string_view name,
                    const Wanted& wanted);
  static std::string_view near_name(const Scope& scope, std::string_view name,
                                    const Wanted& wanted);
  void suggest_declared(Diagnostic& diagnostic, const Scope& scope, std::string_view name,
                        bool (*fits)(const Named&)) const;
  void suggest_import(Diagnostic& diagnostic, const Scope& scope, std::string_view service) const;
  [[nodiscard]] std::string line_of(Span span) const;
  Scope& scope_of(const Definition& definition) { return scopes_.at(&definition); }

  const Sources& sources_;
  const SyntaxErrors& syntax_errors_;
  Report& report_;
  std::unordered_map<const Definition*, Scope> scopes_;
  /// What was close to unknown names, of a scope and as what they were wanted.
  std::map<std::tuple<const Scope*, std::string_view, std::string>, std::string_view> near_;
  std::vector<const Definition*> order_;  ///< of `scopes_`, never iterated itself
};

/// The part of `a.b.C` before the last dot, with its place.
ast::Name service_part(const ast::Name& qualified);
/// The part of `a.b.C` after the last dot, with its place.
ast::Name last_part(const ast::Name& qualified);

}  // namespace robdef::model
