// SPDX-License-Identifier: Apache-2.0
// Gives each written name the definition it stands for. Reads ast::Program; makes the Model in four
// steps: every definition with all that has a name, then imports, then using, then the types. So
// order does not matter to the language, and pointers do not move.
// Reports, through imports.cpp and names.cpp, R0505-R0508 (imports, using) and R0203, R0603, R0606
// (unknown names), and R0206 for the word `structure`.
#include "compiler/model/resolve.hpp"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_set>
#include <utility>
#include <vector>

#include "compiler/model/declare.hpp"
#include "compiler/model/imports.hpp"
#include "compiler/model/names.hpp"
#include "compiler/model/syntax_errors.hpp"

namespace robdef::model {
namespace {

std::vector<Modifier> resolved(const std::vector<ast::Modifier>& written) {
  std::vector<Modifier> modifiers;
  modifiers.reserve(written.size());
  for (const ast::Modifier& one : written) {
    Modifier& modifier = modifiers.emplace_back();
    modifier.name = one.name.text;
    modifier.span = one.name.span;
    for (const ast::ModifierArgument& argument : one.arguments) {
      modifier.arguments.push_back(argument.text);
      modifier.argument_spans.push_back(argument.span);
    }
  }
  return modifiers;
}

// `[0]` and `[0-]` limit nothing at run time (Q08).
void forget_zero_length(Type& type) {
  const bool has_limit =
      type.array == ArrayForm::fixed_length || type.array == ArrayForm::maximum_length;
  if (!has_limit || type.dimensions.front() != 0) return;
  type.array = ArrayForm::any_length;
  type.dimensions.clear();
}

class Resolver {
 public:
  Resolver(const ast::Program& program, const Sources& sources, Report& report)
      : program_(program),
        sources_(sources),
        report_(report),
        syntax_errors_(report),
        names_(sources, syntax_errors_, report) {}

  void declare();
  void resolve_imports();
  void resolve_usings();
  void resolve_types();
  Model model() && { return std::move(model_); }

 private:
  const ast::File& file(std::size_t index) const { return program_.files[index].file; }
  Definition& definition(std::size_t index) const { return *model_.definitions()[index]; }

  Type type(const ast::TypeRef& written, const Definition& user);
  Type value_type(const ast::TypeRef& written, const Definition& user);
  Field field(const ast::Field& written, const Record& record);
  Parameter parameter(const ast::Parameter& written, const Definition& user);
  Member member(const ast::Member& written,
                const std::unordered_set<std::string_view>& unreliable_pipes,
                const Definition& user);
  void resolve_reference(const ast::TypeRef& written, const Definition& user, Member& member);
  void resolve_signature(const ast::Member& written, const Definition& user, Member& member);
  void resolve_record(const ast::Record& written, Record& record);
  void resolve_object(const ast::Object& written, Object& object);

  const ast::Program& program_;
  const Sources& sources_;
  Report& report_;
  SyntaxErrors syntax_errors_;
  Names names_;
  Model model_;
};

void Resolver::declare() {
  for (const ast::ProgramFile& written : program_.files) {
    names_.add(model::declare(written, sources_[written.file.source], model_));
  }
}

void Resolver::resolve_imports() {
  model::resolve_imports(program_, sources_, syntax_errors_, model_, report_);
  for (std::size_t i = 0; i < program_.files.size(); ++i) {
    for (const ast::Import& import : file(i).imports) {
      names_.add_import(definition(i), import.name.text, model_.find(import.name.text));
    }
  }
}

// V10
void Resolver::resolve_usings() {
  for (std::size_t i = 0; i < program_.files.size(); ++i) {
    for (const ast::Using& line : file(i).usings) {
      const ast::Name name = line.alias ? *line.alias : last_part(line.qualified);
      Alias& alias =
          definition(i).aliases.emplace_back(Alias{name.text, line.qualified.text, name.span});
      const std::string_view stable_name =
          line.alias ? std::string_view(line.alias->text)
                     : std::string_view(line.qualified.text)
                           .substr(line.qualified.text.size() - alias.name.size());
      names_.add_alias(definition(i), stable_name, line.qualified);
    }
  }
}

void Resolver::resolve_types() {
  for (std::size_t i = 0; i < program_.files.size(); ++i) {
    std::size_t records = 0;
    std::size_t objects = 0;
    for (const ast::Declaration& written : file(i).declarations) {
      if (const auto* record = std::get_if<ast::Record>(&written)) {
        resolve_record(*record, definition(i).records[records++]);
      } else if (const auto* object = std::get_if<ast::Object>(&written)) {
        resolve_object(*object, definition(i).objects[objects++]);
      }
    }
  }
}

Type Resolver::type(const ast::TypeRef& written, const Definition& user) {
  Type type{Unknown{}, written.array, written.dimensions, written.container, written.span};
  const std::string& word = written.base.text;
  if (const std::optional<Primitive> primitive = primitive_of(word)) {
    type.base = *primitive;
  } else if (word == "varvalue") {
    type.base = VarValue{};
  } else if (word == "varobject" || word == "object") {
    type.base = VarObject{};
  } else if (word == "structure") {
    // A word of the protocol that older tools treat as a type and then refuse.
    report_.add(Code::R0206, written.base.span, "`structure` is not a type")
        .label("names no struct")
        .help("write the name of a struct, or `varvalue` for a value of any type");
  } else {
    type.base = names_.type(user, written.base);
  }
  return type;
}

Type Resolver::value_type(const ast::TypeRef& written, const Definition& user) {
  Type value = type(written, user);
  forget_zero_length(value);
  if (std::holds_alternative<VarValue>(value.base)) {  // Q07
    value.array = ArrayForm::none;
    value.dimensions.clear();
  }
  return value;
}

Field Resolver::field(const ast::Field& written, const Record& record) {
  Field field;
  field.name = written.name.text;
  // Pods and namedarrays keep a zero: there it is an error, or adds no element.
  field.type = record.kind == RecordKind::struct_ ? value_type(written.type, *record.definition)
                                                  : type(written.type, *record.definition);
  field.modifiers = resolved(written.modifiers);
  field.documentation = written.documentation;
  field.span = written.name.span;
  return field;
}

Parameter Resolver::parameter(const ast::Parameter& written, const Definition& user) {
  return {written.name.text, value_type(written.type, user), written.name.span};
}

void Resolver::resolve_record(const ast::Record& written, Record& record) {
  record.fields.reserve(written.fields.size());
  for (const ast::Field& line : written.fields) record.fields.push_back(field(line, record));
}

void Resolver::resolve_object(const ast::Object& written, Object& object) {
  std::unordered_set<const Object*> known;
  for (const ast::Implements& line : written.implements) {
    const Object* base = names_.object(*object.definition, line.name, Code::R0606);
    if (base == nullptr || !known.insert(base).second) continue;
    object.implements.push_back(base);
    object.implements_spans.push_back(line.name.span);
  }
  object.members.reserve(written.members.size());
  // The old spelling: `option pipe NAME unreliable`.
  std::unordered_set<std::string_view> unreliable_pipes;
  for (const ast::Option& option : written.options) {
    const std::vector<std::string_view> words = words_of(option.text);
    const bool is_one = words.size() == 3 && words[0] == "pipe" && words[2] == "unreliable";
    if (is_one) unreliable_pipes.insert(words[1]);
  }
  for (const ast::Member& line : written.members) {
    object.members.push_back(member(line, unreliable_pipes, *object.definition));
  }
}

Member Resolver::member(const ast::Member& written,
                        const std::unordered_set<std::string_view>& unreliable_pipes,
                        const Definition& user) {
  Member member;
  member.kind = written.kind;
  member.name = written.name.text;
  member.modifiers = resolved(written.modifiers);
  member.access = access_of(written.kind, member.modifiers);
  member.documentation = written.documentation;
  member.span = written.name.span;
  switch (written.kind) {
    case MemberKind::objref:
      if (written.type) resolve_reference(*written.type, user, member);
      break;
    case MemberKind::function:
    case MemberKind::event:
    case MemberKind::callback:
      resolve_signature(written, user, member);
      break;
    case MemberKind::memory:
      if (written.type) member.type = type(*written.type, user);
      // `[0]` is refused by V17, `[0-]` is as good as `[]`.
      if (member.type.array == ArrayForm::maximum_length) forget_zero_length(member.type);
      break;
    case MemberKind::property:
    case MemberKind::pipe:
    case MemberKind::wire:
      if (written.type) member.type = value_type(*written.type, user);
      break;
  }
  if (written.kind == MemberKind::pipe) {
    if (unreliable_pipes.contains(member.name)) member.access.is_unreliable = true;
  }
  return member;
}

void Resolver::resolve_reference(const ast::TypeRef& written, const Definition& user,
                                 Member& member) {
  if (written.container == ContainerForm::string_map) {
    member.index = IndexForm::string;
  } else if (written.container == ContainerForm::int32_map || written.array != ArrayForm::none) {
    member.index = IndexForm::int32;
  }
  member.type.span = written.span;
  if (written.base.text == "varobject") {
    member.type.base = VarObject{};
    return;
  }
  const Object* target = names_.object(user, written.base, Code::R0603);
  member.type.base = target == nullptr ? Base{Unknown{}} : Base{target};
}

void Resolver::resolve_signature(const ast::Member& written, const Definition& user,
                                 Member& member) {
  if (written.type) member.type = value_type(*written.type, user);
  member.parameters.reserve(written.parameters.size());
  for (const ast::Parameter& one : written.parameters) {
    member.parameters.push_back(parameter(one, user));
  }
  if (written.kind != MemberKind::function) return;
  const bool returns = member.type.container == ContainerForm::generator;
  const bool takes = !member.parameters.empty() &&
                     member.parameters.back().type.container == ContainerForm::generator;
  if (returns) member.type.container = ContainerForm::none;
  if (takes) {
    member.generator_parameter = std::move(member.parameters.back());
    member.generator_parameter->type.container = ContainerForm::none;
    member.parameters.pop_back();
  }
  member.generator = returns && takes ? GeneratorForm::both
                     : returns        ? GeneratorForm::returns
                     : takes          ? GeneratorForm::takes
                                      : GeneratorForm::none;
}

}  // namespace

Model resolve(const ast::Program& program, const Sources& sources, Report& report) {
  Resolver resolver(program, sources, report);
  resolver.declare();
  resolver.resolve_imports();
  resolver.resolve_usings();
  resolver.resolve_types();
  return std::move(resolver).model();
}

}  // namespace robdef::model
