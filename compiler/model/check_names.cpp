// SPDX-License-Identifier: Apache-2.0
// Rules on names: V01, V02, V07, V08, V15, V23.
#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "compiler/model/phrases.hpp"
#include "compiler/model/rules.hpp"
#include "compiler/syntax/words.hpp"

namespace robdef::model::rules {
namespace {

constexpr std::array<std::string_view, 3> self_words{"this", "self", "Me"};

// What is wrong with a word that no declaration may use; empty when nothing is.
std::string reservation_of(std::string_view name) {
  const bool is_self = std::find(self_words.begin(), self_words.end(), name) != self_words.end();
  if (is_self || syntax::is_reserved_word(name)) return "is a reserved word";
  if (syntax::has_reserved_prefix(name)) return "begins with a reserved prefix";
  return {};
}

void explain_prefix(Diagnostic& diagnostic) {
  diagnostic.note(
      "names that begin, in any case, with `get_`, `set_`, `async_`, `rr` or `robotraconteur` are "
      "set aside for generated code");
}

std::string form_problem(std::string_view name) {
  if (name.empty() || !syntax::is_letter(name.front())) return "does not begin with a letter";
  if (name.find('.') != name.npos) return "holds a dot";
  if (name.back() == '_') return "ends in an underscore";
  const bool is_clean =
      std::all_of(name.begin(), name.end(), [](char c) { return syntax::is_word_character(c); });
  return is_clean ? "" : "holds more than letters, digits and underscores";
}

// V08 for one name.
void check_name(std::string_view name, Span span, std::string_view what, Report& report) {
  std::string problem = form_problem(name);
  if (problem.empty()) problem = reservation_of(name);
  if (problem.empty()) return;
  Diagnostic& diagnostic = report.add(
      Code::R0205, span, in_ticks(name) + " cannot be the name of " + with_article(what));
  diagnostic.label(std::move(problem));
  if (syntax::has_reserved_prefix(name)) explain_prefix(diagnostic);
}

struct First {
  Span span;
  std::string_view kind;
};

// The first of each name. A few names are compared with each other, many are looked up.
class Firsts {
 public:
  // Nothing for a new name.
  std::optional<First> add(std::string_view name, First first) {
    if (few_.size() < most) {
      for (const auto& [other, known] : few_) {
        // Names that are numbered differ at their ends.
        const bool may_be_same =
            other.size() == name.size() && (name.empty() || other.back() == name.back());
        if (may_be_same && other == name) return known;
      }
      few_.emplace_back(name, first);
      return std::nullopt;
    }
    if (many_.empty()) many_.insert(few_.begin(), few_.end());
    const auto [known, is_new] = many_.try_emplace(name, first);
    return is_new ? std::nullopt : std::optional(known->second);
  }

 private:
  static constexpr std::size_t most = 12;
  std::vector<std::pair<std::string_view, First>> few_;
  std::unordered_map<std::string_view, First> many_;
};

// Reports every name that has been seen before, of V07 and V23.
class Uniqueness {
 public:
  Uniqueness(Code code, std::string_view scope, Report& report)
      : code_(code), scope_(scope), report_(report) {}

  void add(std::string_view name, Span span, std::string_view kind) {
    const std::optional<First> first = firsts_.add(name, {span, kind});
    if (!first) return;
    report_
        .add(code_, span,
             "the name " + in_ticks(name) + " occurs twice in this " + std::string(scope_))
        .label(with_article(kind) + " of the same name")
        .also(first->span, "first declared here, as " + with_article(first->kind))
        .help("rename one of the two");
  }

 private:
  Code code_;
  std::string_view scope_;
  Report& report_;
  Firsts firsts_;
};

// The kind of a declaration.
struct KindOf {
  std::string_view operator()(const Constant*) const { return "constant"; }
  std::string_view operator()(const Exception*) const { return "exception"; }
  std::string_view operator()(const Enum*) const { return "enum"; }
  std::string_view operator()(const Record* record) const { return name_of(record->kind); }
  std::string_view operator()(const Object*) const { return "object"; }
};

void check_constant_names(const std::vector<Constant>& constants, Report& report) {
  for (const Constant& constant : constants) {
    check_name(constant.name, constant.span, "constant", report);
    const auto* fields = std::get_if<std::vector<StructValueField>>(&constant.value);
    if (fields == nullptr) continue;
    for (const StructValueField& field : *fields) {
      check_name(field.field, field.span, "field", report);
    }
  }
}

// An alias without `as` has the name of what it stands for, which is checked where it is declared.
bool has_name_of_its_own(const Alias& alias) {
  return !alias.qualified_name.ends_with('.' + alias.name);
}

}  // namespace

void service_name_is_valid(const Definition& definition, const SyntaxErrors& syntax_errors,
                           Report& report) {
  const std::string& name = definition.name;
  if (name.empty()) {
    if (syntax_errors.any_in(definition)) return;
    report.add(Code::R0201, definition.span, "the file has no service line")
        .label("a definition begins with its name")
        .help("write `service` and a name as the first statement");
    return;
  }
  const bool is_exempt =
      name == "RobotRaconteurServiceIndex" || name.starts_with("RobotRaconteurTestService");
  if (is_exempt) return;
  std::string problem = reservation_of(name);
  if (problem.empty()) return;
  Diagnostic& diagnostic =
      report.add(Code::R0201, definition.span, in_ticks(name) + " cannot be the name of a service");
  diagnostic.label(std::move(problem));
  if (syntax::has_reserved_prefix(name)) explain_prefix(diagnostic);
}

void service_name_is_not_signed(const Definition& definition, Report& report) {
  if (!definition.name.ends_with("_signed")) return;
  report.add(Code::R0202, definition.span, "the service name ends in `_signed`")
      .label("this ending is set aside for signed definitions");
}

void file_names_are_unique(const Definition& definition, Report& report) {
  Uniqueness names(Code::R0204, "file", report);
  for (const Alias& alias : definition.aliases) names.add(alias.name, alias.span, "alias");
  for (const Declaration& declaration : definition.declarations) {
    const std::string_view kind = std::visit(KindOf{}, declaration);
    std::visit([&](const auto* item) { names.add(item->name, item->span, kind); }, declaration);
  }
}

void names_are_allowed(const Definition& definition, Report& report) {
  for (const Alias& alias : definition.aliases) {
    if (has_name_of_its_own(alias)) check_name(alias.name, alias.span, "alias", report);
  }
  check_constant_names(definition.constants, report);
  for (const Exception& exception : definition.exceptions) {
    check_name(exception.name, exception.span, "exception", report);
  }
  for (const Enum& enumeration : definition.enums) {
    check_name(enumeration.name, enumeration.span, "enum", report);
    for (const EnumValue& value : enumeration.values) {
      check_name(value.name, value.span, "enum value", report);
    }
  }
  for (const Record& record : definition.records) {
    check_name(record.name, record.span, KindOf{}(&record), report);
    check_constant_names(record.constants, report);
    for (const Field& field : record.fields) {
      check_name(field.name, field.span, "field", report);
    }
  }
  for (const Object& object : definition.objects) {
    check_name(object.name, object.span, "object", report);
    check_constant_names(object.constants, report);
    for (const Member& member : object.members) {
      check_name(member.name, member.span, name_of(member.kind), report);
    }
  }
}

void parameter_names_are_unique(const Definition& definition, Report& report) {
  for (const Object& object : definition.objects) {
    for (const Member& member : object.members) {
      if (member.parameters.size() < 2) continue;
      Firsts firsts;
      for (const Parameter& parameter : member.parameters) {
        const auto first = firsts.add(parameter.name, {parameter.span, "parameter"});
        if (!first) continue;
        report
            .add(Code::R0602, parameter.span,
                 "two parameters of " + in_ticks(member.name) + " are named " +
                     in_ticks(parameter.name))
            .label("has the name of an earlier parameter")
            .also(first->span, "first used here");
      }
    }
  }
}

void block_names_are_unique(const Definition& definition, Report& report) {
  for (const Record& record : definition.records) {
    Uniqueness names(Code::R0605, name_of(record.kind), report);
    for (const Constant& constant : record.constants) {
      names.add(constant.name, constant.span, "constant");
    }
    for (const Field& field : record.fields) names.add(field.name, field.span, "field");
  }
  for (const Object& object : definition.objects) {
    Uniqueness names(Code::R0605, "object", report);
    for (const Constant& constant : object.constants) {
      names.add(constant.name, constant.span, "constant");
    }
    for (const Member& member : object.members) {
      names.add(member.name, member.span, name_of(member.kind));
    }
  }
}

}  // namespace robdef::model::rules
