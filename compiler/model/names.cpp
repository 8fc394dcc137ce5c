// SPDX-License-Identifier: Apache-2.0
#include "compiler/model/names.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "compiler/diagnostics/spelling.hpp"
#include "compiler/model/insertions.hpp"
#include "compiler/model/phrases.hpp"

namespace robdef::model {
namespace {

bool is_anything(const Named&) { return true; }
bool is_type(const Named& named) { return named.is_type(); }
bool is_object(const Named& named) { return named.is_object(); }

constexpr Wanted a_type{Code::R0203, "type", is_type};

constexpr std::array<std::string_view, 16> built_in{
    "double", "single", "int8",   "uint8",   "int16",   "uint16", "int32",    "uint32",
    "int64",  "uint64", "string", "cdouble", "csingle", "bool",   "varvalue", "void"};

// Words of other languages that people write by habit.
constexpr std::array<std::pair<std::string_view, std::string_view>, 14> habits{{
    {"float", "single"},
    {"float32", "single"},
    {"float64", "double"},
    {"int", "int32"},
    {"uint", "uint32"},
    {"integer", "int32"},
    {"short", "int16"},
    {"long", "int64"},
    {"byte", "uint8"},
    {"char", "uint8"},
    {"boolean", "bool"},
    {"complex", "cdouble"},
    {"str", "string"},
    {"any", "varvalue"},
}};

std::string absence(std::string_view noun) {
  return noun == "object" ? "no object has this name"
                          : "no struct, pod, namedarray or enum has this name";
}

}  // namespace

ast::Name service_part(const ast::Name& qualified) {
  const std::size_t dot = qualified.text.rfind('.');
  if (dot == std::string::npos) return qualified;
  ast::Name part{qualified.text.substr(0, dot), qualified.span};
  part.span.end = part.span.begin + static_cast<std::uint32_t>(dot);
  return part;
}

ast::Name last_part(const ast::Name& qualified) {
  const std::size_t dot = qualified.text.rfind('.');
  if (dot == std::string::npos) return qualified;
  ast::Name part{qualified.text.substr(dot + 1), qualified.span};
  part.span.begin += static_cast<std::uint32_t>(dot + 1);
  return part;
}

void Names::add(const Definition& definition) {
  Scope& scope = scopes_[&definition];
  scope.definition = &definition;
  order_.push_back(&definition);
  const auto enter = [&scope](const auto& item, std::string_view kind, Base base) {
    const Named named{item.name, kind, base, item.span};
    const auto [place, is_new] = scope.declared.try_emplace(item.name, named);
    if (is_new) {
      scope.order.push_back(item.name);
    } else if (named.is_type() && !place->second.is_type()) {
      place->second = named;  // a name declared twice: better a type than none
    }
  };
  for (const Constant& constant : definition.constants) enter(constant, "constant", Unknown{});
  for (const Exception& exception : definition.exceptions) {
    enter(exception, "exception", Unknown{});
  }
  for (const Enum& enumeration : definition.enums) enter(enumeration, "enum", &enumeration);
  for (const Record& record : definition.records) enter(record, name_of(record.kind), &record);
  for (const Object& object : definition.objects) enter(object, "object", &object);
}

void Names::add_import(const Definition& user, std::string_view service,
                       const Definition* imported) {
  Scope& scope = scope_of(user);
  if (scope.imports.try_emplace(service, imported).second) scope.import_order.push_back(service);
}

void Names::add_alias(const Definition& user, std::string_view alias, const ast::Name& qualified) {
  Scope& scope = scope_of(user);
  const auto [place, is_new] = scope.aliases.try_emplace(alias, nullptr);
  const ast::Name service = service_part(qualified);
  const ast::Name name = last_part(qualified);
  const auto import = scope.imports.find(service.text);
  if (import == scope.imports.end()) {
    if (syntax_errors_.mention(user, service.text)) return;
    Diagnostic& diagnostic =
        report_.add(Code::R0508, service.span, "using names a definition that is not imported");
    diagnostic.label(in_ticks(service.text) + " is not imported here");
    suggest_import(diagnostic, scope, service.text);
    return;
  }
  if (import->second == nullptr) return;
  const Scope& target = scope_of(*import->second);
  const auto found = target.declared.find(name.text);
  if (found != target.declared.end()) {
    if (is_new) {
      place->second = &found->second;
      scope.alias_order.push_back(alias);
    }
    return;
  }
  if (syntax_errors_.mention(*target.definition, name.text)) return;
  Diagnostic& diagnostic = report_.add(
      Code::R0508, name.span, "using names " + in_ticks(qualified.text) + ", which does not exist");
  diagnostic.label(in_ticks(service.text) + " declares no such type, constant or exception");
  suggest_declared(diagnostic, target, name.text, is_anything);
}

Base Names::type(const Definition& user, const ast::Name& name) {
  const Named* found = find(user, name, a_type);
  return found == nullptr ? Base{Unknown{}} : found->base;
}

const Object* Names::object(const Definition& user, const ast::Name& name, Code code) {
  const Named* found = find(user, name, Wanted{code, "object", is_object});
  return found == nullptr ? nullptr : std::get<const Object*>(found->base);
}

const Named* Names::find(const Definition& user, const ast::Name& name, const Wanted& wanted) {
  const Scope& scope = scope_of(user);
  const bool is_plain = name.text.find('.') == std::string::npos;
  const Named* found =
      is_plain ? find_plain(scope, name, wanted) : find_qualified(scope, name, wanted);
  if (found == nullptr || wanted.fits(*found)) return found;
  report_
      .add(wanted.code, name.span,
           in_ticks(name.text) + " is " + with_article(found->kind) + ", not " +
               with_article(wanted.noun))
      .label(with_article(wanted.noun) + " is needed here")
      .also(found->span, "declared here");
  return nullptr;
}

const Named* Names::find_plain(const Scope& scope, const ast::Name& name, const Wanted& wanted) {
  const auto alias = scope.aliases.find(name.text);
  if (alias != scope.aliases.end()) return alias->second;
  const auto found = scope.declared.find(name.text);
  if (found != scope.declared.end()) return &found->second;
  if (!syntax_errors_.mention(*scope.definition, name.text)) report_plain(scope, name, wanted);
  return nullptr;
}

const Named* Names::find_qualified(const Scope& scope, const ast::Name& name,
                                   const Wanted& wanted) {
  const ast::Name service = service_part(name);
  const ast::Name last = last_part(name);
  const auto import = scope.imports.find(service.text);
  if (import == scope.imports.end()) {
    if (service.text == scope.definition->name) {
      report_own(scope, name, wanted);
    } else if (!syntax_errors_.mention(*scope.definition, service.text)) {
      report_not_imported(scope, name, wanted);
    }
    return nullptr;
  }
  if (import->second == nullptr) return nullptr;
  const Scope& target = scope_of(*import->second);
  const auto found = target.declared.find(last.text);
  if (found != target.declared.end()) return &found->second;
  if (syntax_errors_.mention(*target.definition, last.text)) return nullptr;
  Diagnostic& diagnostic = report_.add(
      wanted.code, last.span, "unknown " + std::string(wanted.noun) + ' ' + in_ticks(name.text));
  diagnostic.label(in_ticks(service.text) + " declares no such " + std::string(wanted.noun));
  suggest_declared(diagnostic, target, last.text, wanted.fits);
  return nullptr;
}

void Names::report_plain(const Scope& scope, const ast::Name& name, const Wanted& wanted) {
  Diagnostic& diagnostic = report_.add(
      wanted.code, name.span, "unknown " + std::string(wanted.noun) + ' ' + in_ticks(name.text));
  diagnostic.label(absence(wanted.noun));
  if (!suggest_elsewhere(diagnostic, scope, name.text, wanted)) {
    suggest_near(diagnostic, scope, name.text, wanted);
  }
}

void Names::report_own(const Scope& scope, const ast::Name& name, const Wanted& wanted) {
  const ast::Name last = last_part(name);
  const auto found = scope.declared.find(last.text);
  if (found == scope.declared.end() || !wanted.fits(found->second)) {
    if (!syntax_errors_.mention(*scope.definition, last.text)) report_plain(scope, name, wanted);
    return;
  }
  report_
      .add(wanted.code, name.span,
           "an own " + std::string(wanted.noun) + " is named with its service")
      .label("this is " + in_ticks(last.text) + " of this very file")
      .also(found->second.span, "declared here")
      .help("write " + in_ticks(last.text))
      .edit(name.span, last.text)
      .note("only what is imported is named with its service");
}

void Names::report_not_imported(const Scope& scope, const ast::Name& name, const Wanted& wanted) {
  const ast::Name service = service_part(name);
  Diagnostic& diagnostic = report_.add(
      wanted.code, name.span, "unknown " + std::string(wanted.noun) + ' ' + in_ticks(name.text));
  diagnostic.label(in_ticks(service.text) + " is not imported here");
  suggest_import(diagnostic, scope, service.text);
}

// A plain name that another definition declares: the import, or the qualification, was forgotten.
bool Names::suggest_elsewhere(Diagnostic& diagnostic, const Scope& scope, std::string_view name,
                              const Wanted& wanted) const {
  if (!report_.may_suggest(scope.import_order.size() + order_.size())) return false;
  const auto declares = [&](const Definition* definition) {
    if (definition == nullptr || definition->name.empty()) return false;
    const auto& declared = scopes_.at(definition).declared;
    const auto found = declared.find(name);
    return found != declared.end() && wanted.fits(found->second);
  };
  for (const std::string_view service : scope.import_order) {
    if (!declares(scope.imports.at(service))) continue;
    const std::string qualified = std::string(service) + '.' + std::string(name);
    diagnostic.help("write " + in_ticks(qualified) + ", or add " + in_ticks("using " + qualified))
        .edit(diagnostic.primary().span, qualified);
    return true;
  }
  for (const Definition* definition : order_) {
    if (definition == scope.definition || !declares(definition)) continue;
    const std::string qualified = definition->name + '.' + std::string(name);
    const Replacement import = import_line(*scope.definition, definition->name);
    diagnostic
        .help("add " + in_ticks("import " + definition->name) + " and write " + in_ticks(qualified))
        .edit(import.span, import.text)
        .edit(diagnostic.primary().span, qualified);
    return true;
  }
  return false;
}

void Names::suggest_near(Diagnostic& diagnostic, const Scope& scope, std::string_view name,
                         const Wanted& wanted) {
  const bool any_type = wanted.noun == "type";
  for (const auto& [habit, word] : habits) {
    if (any_type && habit == name) {
      diagnostic.help("write " + in_ticks(word)).edit(diagnostic.primary().span, std::string(word));
      return;
    }
  }
  const std::size_t count = scope.alias_order.size() + scope.order.size() + built_in.size();
  if (!report_.may_suggest(count, comparisons(name))) return;
  // A name that is gone is often written many times.
  const auto [known, is_new] = near_.try_emplace({&scope, wanted.noun, std::string(name)});
  if (is_new) known->second = near_name(scope, name, wanted);
  const std::string_view near = known->second;
  if (near.empty()) return;
  const auto own = scope.declared.find(near);
  if (own != scope.declared.end()) {
    diagnostic.help(in_ticks(near) + ", declared on " + line_of(own->second.span) + ", is close");
  } else {
    diagnostic.help(in_ticks(near) + " is close");
  }
  diagnostic.edit(diagnostic.primary().span, std::string(near));
}

std::string_view Names::near_name(const Scope& scope, std::string_view name, const Wanted& wanted) {
  std::vector<std::string_view> candidates;
  for (const std::string_view alias : scope.alias_order) {
    if (wanted.fits(*scope.aliases.at(alias))) candidates.push_back(alias);
  }
  for (const std::string_view own : scope.order) {
    if (wanted.fits(scope.declared.at(own))) candidates.push_back(own);
  }
  if (wanted.noun == "type") {
    candidates.insert(candidates.end(), built_in.begin(), built_in.end());
  }
  return nearest(name, candidates);
}

void Names::suggest_declared(Diagnostic& diagnostic, const Scope& scope, std::string_view name,
                             bool (*fits)(const Named&)) const {
  if (!report_.may_suggest(scope.order.size(), comparisons(name))) return;
  std::vector<std::string_view> candidates;
  for (const std::string_view candidate : scope.order) {
    if (fits(scope.declared.at(candidate))) candidates.push_back(candidate);
  }
  const std::string_view near = nearest(name, candidates);
  if (near.empty()) return;
  diagnostic.help(in_ticks(near) + " is close").edit(diagnostic.primary().span, std::string(near));
}

void Names::suggest_import(Diagnostic& diagnostic, const Scope& scope,
                           std::string_view service) const {
  const std::size_t count = order_.size() + 2 * scope.import_order.size();
  if (!report_.may_suggest(count, comparisons(service))) return;
  for (const Definition* definition : order_) {
    if (definition->name != service) continue;
    const Replacement import = import_line(*scope.definition, std::string(service));
    diagnostic.help("add " + in_ticks("import " + std::string(service)))
        .edit(import.span, import.text);
    for (const std::string_view name : scope.import_order) {
      const Definition* imported = scope.imports.at(name);
      if (imported == nullptr || !scopes_.at(imported).imports.contains(service)) continue;
      diagnostic.note(in_ticks(name) + " imports it, but imports are not passed on");
      return;
    }
    return;
  }
  const std::string_view near = nearest(service, scope.import_order);
  if (near.empty()) return;
  Span written = diagnostic.primary().span;
  written.end = written.begin + static_cast<std::uint32_t>(service.size());
  diagnostic.help("the import " + in_ticks(near) + " is close").edit(written, std::string(near));
}

std::string Names::line_of(Span span) const {
  return "line " + std::to_string(sources_[span.source].position(span.begin).line);
}

}  // namespace robdef::model
