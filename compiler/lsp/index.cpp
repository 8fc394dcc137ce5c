// SPDX-License-Identifier: Apache-2.0
#include "compiler/lsp/index.hpp"

#include <algorithm>
#include <utility>
#include <variant>

#include "compiler/model/model.hpp"
#include "compiler/syntax/words.hpp"

namespace robdef::lsp {
namespace {

// The parts of `a.b.C` around the last dot; the first is empty for a plain name.
std::pair<ast::Name, ast::Name> cut(const ast::Name& name) {
  const std::size_t dot = name.text.rfind('.');
  if (dot == std::string::npos) return {{}, name};
  const auto at = static_cast<std::uint32_t>(dot);
  const Span span = name.span;
  return {{name.text.substr(0, dot), {span.source, span.begin, span.begin + at}},
          {name.text.substr(dot + 1), {span.source, span.begin + at + 1, span.end}}};
}

// A name that is broken over lines has a longer span than text, and its parts no known places.
bool is_whole(const ast::Name& name) { return name.span.end - name.span.begin == name.text.size(); }

std::uint64_t key_of(Span span) {
  return std::uint64_t{static_cast<std::uint32_t>(span.source)} << 32U | span.begin;
}

}  // namespace

std::string_view word_of(ast::MemberKind kind) { return model::name_of(kind); }

std::string Symbol::path() const {
  if (kind == SymbolKind::service || kind == SymbolKind::alias) return name;
  if (owner != nullptr) return owner->path() + '.' + name;
  return (file->service ? file->service->text + '.' : std::string()) + name;
}

Index::Index(const ast::Program& program) {
  for (const ast::ProgramFile& one : program.files) declare(one.file);
  for (const ast::ProgramFile& one : program.files) declare_usings(one.file);
  if (!program.files.empty()) note_file(program.files.front().file);
}

const Symbol* Index::add(Symbol symbol) {
  const Symbol& added = symbols_.emplace_back(std::move(symbol));
  places_[key_of(added.span)] = &added;
  return &added;
}

const Symbol& Index::declared(Span name) const { return *places_.at(key_of(name)); }

// By its place, since a name may be declared twice.
const Symbol& Index::note_declared(Span name) {
  const Symbol& symbol = declared(name);
  note(name, &symbol, true);
  return symbol;
}

void Index::declare_part(const Symbol& owner, const ast::Name& name, SymbolKind kind,
                         std::string_view word, Span line, std::string_view documentation) {
  const Symbol* const part =
      add({kind, name.text, word, name.span, line, documentation, owner.file, &owner, nullptr});
  parts_[&owner].try_emplace(part->name, part);
}

void Index::declare_object(const ast::Object& object, const Symbol& symbol) {
  for (const ast::Constant& one : object.constants) {
    declare_part(symbol, one.name, SymbolKind::constant, "constant", one.span, one.documentation);
  }
  for (const ast::Member& one : object.members) {
    declare_part(symbol, one.name, SymbolKind::member, word_of(one.kind), one.span,
                 one.documentation);
    const Symbol& member = symbols_.back();
    for (const ast::Parameter& parameter : one.parameters) {
      declare_part(member, parameter.name, SymbolKind::parameter, "parameter", one.span, {});
    }
  }
}

void Index::declare(const ast::File& file) {
  Scope& scope = scopes_[&file];
  if (file.service) {
    scope.service = add({SymbolKind::service, file.service->text, "service", file.service->span,
                         file.service->span, file.documentation, &file, nullptr, nullptr});
    services_.try_emplace(scope.service->name, scope.service);
  }
  const auto enter = [&](const auto& written, SymbolKind kind, std::string_view word) {
    const Symbol* const symbol =
        add({kind, written.name.text, word, written.name.span, written.span, written.documentation,
             &file, nullptr, nullptr});
    scope.names.try_emplace(symbol->name, symbol);
    return symbol;
  };
  for (const ast::Declaration& declaration : file.declarations) {
    if (const auto* constant = std::get_if<ast::Constant>(&declaration)) {
      enter(*constant, SymbolKind::constant, "constant");
    } else if (const auto* exception = std::get_if<ast::Exception>(&declaration)) {
      enter(*exception, SymbolKind::exception, "exception");
    } else if (const auto* enumeration = std::get_if<ast::Enum>(&declaration)) {
      const Symbol& owner = *enter(*enumeration, SymbolKind::enumeration, "enum");
      for (const ast::EnumValue& one : enumeration->values) {
        declare_part(owner, one.name, SymbolKind::enum_value, "value", one.name.span,
                     one.documentation);
      }
    } else if (const auto* record = std::get_if<ast::Record>(&declaration)) {
      const Symbol& owner = *enter(*record, SymbolKind::record, model::name_of(record->kind));
      for (const ast::Constant& one : record->constants) {
        declare_part(owner, one.name, SymbolKind::constant, "constant", one.span,
                     one.documentation);
      }
      for (const ast::Field& one : record->fields) {
        declare_part(owner, one.name, SymbolKind::field, "field", one.span, one.documentation);
      }
    } else if (const auto* object = std::get_if<ast::Object>(&declaration)) {
      declare_object(*object, *enter(*object, SymbolKind::object, "object"));
    }
  }
}

void Index::declare_usings(const ast::File& file) {
  Scope& scope = scopes_.at(&file);
  for (const ast::Using& written : file.usings) {
    const Symbol* const target = find(file, written.qualified.text);
    if (!written.alias) {
      // Without `as` the name itself is used.
      if (target != nullptr) scope.names.try_emplace(target->name, target);
      continue;
    }
    const Symbol* const alias = add(
        {SymbolKind::alias, written.alias->text, "using", written.alias->span, written.span,
         target == nullptr ? std::string_view() : target->documentation, &file, nullptr, target});
    scope.names.try_emplace(alias->name, alias);
  }
}

const Symbol* Index::find_service(std::string_view name) const {
  const auto found = services_.find(name);
  return found == services_.end() ? nullptr : found->second;
}

const Symbol* Index::find(const ast::File& user, std::string_view name) const {
  const std::size_t dot = name.rfind('.');
  const ast::File* file = &user;
  if (dot != name.npos) {
    const Symbol* const service = find_service(name.substr(0, dot));
    if (service == nullptr) return nullptr;
    file = service->file;
    name.remove_prefix(dot + 1);
  }
  const auto& names = scopes_.at(file).names;
  const auto found = names.find(name);
  if (found == names.end()) return nullptr;
  // What another file has by using is not its own.
  const bool is_own = found->second->file == file && found->second->kind != SymbolKind::alias;
  return dot == std::string_view::npos || is_own ? found->second : nullptr;
}

const Symbol* Index::part_of(const Symbol& owner, std::string_view name) const {
  const auto parts = parts_.find(&owner);
  if (parts == parts_.end()) return nullptr;
  const auto found = parts->second.find(name);
  return found == parts->second.end() ? nullptr : found->second;
}

const Occurrence* Index::at(std::uint32_t offset) const {
  const auto after = occurrence_after(offset);
  if (after == occurrences_.begin()) return nullptr;
  const Occurrence& before = *std::prev(after);
  return offset <= before.span.end ? &before : nullptr;
}

// Most come in the order of the text.
void Index::note(Span span, const Symbol* symbol, bool is_declaration) {
  if (symbol == nullptr) return;
  occurrences_.insert(occurrence_after(span.begin), {span, symbol, is_declaration});
}

std::vector<Occurrence>::const_iterator Index::occurrence_after(std::uint32_t offset) const {
  return std::upper_bound(
      occurrences_.begin(), occurrences_.end(), offset,
      [](std::uint32_t at, const Occurrence& one) { return at < one.span.begin; });
}

void Index::note_name(const ast::File& file, const ast::Name& name) {
  if (!is_whole(name)) return;
  const auto [service, last] = cut(name);
  if (!service.text.empty()) note(service.span, find_service(service.text));
  note(last.span, find(file, name.text));
}

void Index::note_type(const ast::File& file, const ast::TypeRef& type) {
  if (!syntax::is_built_in_type(type.base.text)) note_name(file, type.base);
}

void Index::note_modifiers(const Symbol& owner, const std::vector<ast::Modifier>& modifiers) {
  for (const ast::Modifier& modifier : modifiers) {
    for (const ast::ModifierArgument& argument : modifier.arguments) {
      if (argument.is_name) note(argument.span, part_of(owner, argument.text));
    }
  }
}

void Index::note_constant(const ast::File& file, const Symbol* owner,
                          const ast::Constant& constant) {
  const auto named = [&](const std::string& name) {
    return owner == nullptr ? find(file, name) : part_of(*owner, name);
  };
  note_declared(constant.name.span);
  const auto* const fields = std::get_if<ast::StructLiteral>(&constant.value);
  if (fields == nullptr) return;
  for (const ast::StructLiteralField& field : fields->fields) {
    note(field.constant.span, named(field.constant.text));
  }
}

void Index::note_record(const ast::File& file, const ast::Record& record, const Symbol& symbol) {
  for (const ast::Constant& one : record.constants) note_constant(file, &symbol, one);
  for (const ast::Field& one : record.fields) {
    note_type(file, one.type);
    note_declared(one.name.span);
    note_modifiers(symbol, one.modifiers);
  }
}

void Index::note_object(const ast::File& file, const ast::Object& object, const Symbol& symbol) {
  for (const ast::Constant& one : object.constants) note_constant(file, &symbol, one);
  for (const ast::Implements& one : object.implements) note_name(file, one.name);
  for (const ast::Member& one : object.members) {
    if (one.type) note_type(file, *one.type);
    const Symbol& member = note_declared(one.name.span);
    for (const ast::Parameter& parameter : one.parameters) {
      note_type(file, parameter.type);
      note_declared(parameter.name.span);
    }
    note_modifiers(symbol, one.modifiers);
    for (const ast::Implements& base : object.implements) {
      const Symbol* other = find(file, base.name.text);
      if (other != nullptr && other->kind == SymbolKind::alias) other = other->target;
      const Symbol* const same = other == nullptr ? nullptr : part_of(*other, one.name.text);
      if (same != nullptr && same->kind == SymbolKind::member) {
        same_members_.emplace_back(&member, same);
      }
    }
  }
}

void Index::note_file(const ast::File& file) {
  if (file.service) note_declared(file.service->span);
  for (const ast::Import& one : file.imports) {
    if (is_whole(one.name)) note(one.name.span, find_service(one.name.text));
  }
  for (const ast::Using& one : file.usings) {
    note_name(file, one.qualified);
    if (one.alias) note_declared(one.alias->span);
  }
  for (const ast::Declaration& declaration : file.declarations) {
    if (const auto* constant = std::get_if<ast::Constant>(&declaration)) {
      note_constant(file, nullptr, *constant);
      continue;
    }
    const ast::Name& name =
        std::visit([](const auto& one) -> const ast::Name& { return one.name; }, declaration);
    const Symbol& symbol = note_declared(name.span);
    if (const auto* enumeration = std::get_if<ast::Enum>(&declaration)) {
      for (const ast::EnumValue& one : enumeration->values) {
        note_declared(one.name.span);
      }
    } else if (const auto* record = std::get_if<ast::Record>(&declaration)) {
      note_record(file, *record, symbol);
    } else if (const auto* object = std::get_if<ast::Object>(&declaration)) {
      note_object(file, *object, symbol);
    }
  }
}

}  // namespace robdef::lsp
