// SPDX-License-Identifier: Apache-2.0
// From the texts of definitions to the tables: what the C++ backend does when a program is built.
#include <algorithm>
#include <utility>

#include "compiler/diagnostics/render.hpp"
#include "compiler/model/check.hpp"
#include "compiler/model/describe.hpp"
#include "compiler/model/evaluate.hpp"
#include "compiler/model/layout.hpp"
#include "compiler/model/print.hpp"
#include "compiler/model/resolve.hpp"
#include "compiler/syntax/read.hpp"
#include "rr/error.hpp"
#include "runtime/cpp/src/dynamic/definition_tables.hpp"

namespace rr::dynamic {
namespace {

namespace model = robdef::model;

std::uint8_t access_bits(const model::Access& access) {
  int bits = plain;
  if (access.is_readonly) bits |= readonly;
  if (access.is_writeonly) bits |= writeonly;
  if (access.is_unreliable) bits |= unreliable;
  if (access.is_nolock) bits |= nolock;
  if (access.is_nolockread) bits |= nolockread;
  if (access.is_perclient) bits |= perclient;
  if (access.is_urgent) bits |= urgent;
  return static_cast<std::uint8_t>(bits);
}

MemberKind kind_of(model::MemberKind kind) {
  switch (kind) {
    case model::MemberKind::property:
      return MemberKind::property;
    case model::MemberKind::function:
      return MemberKind::function;
    case model::MemberKind::event:
      return MemberKind::event;
    case model::MemberKind::objref:
      return MemberKind::objref;
    case model::MemberKind::pipe:
      return MemberKind::pipe;
    case model::MemberKind::callback:
      return MemberKind::callback;
    case model::MemberKind::wire:
      return MemberKind::wire;
    case model::MemberKind::memory:
      break;
  }
  return MemberKind::memory;
}

RecordKind kind_of(model::RecordKind kind) {
  if (kind == model::RecordKind::struct_) return RecordKind::struct_;
  return kind == model::RecordKind::pod ? RecordKind::pod : RecordKind::namedarray;
}

GeneratorForm form_of(model::GeneratorForm form) {
  switch (form) {
    case model::GeneratorForm::returns:
      return GeneratorForm::returns;
    case model::GeneratorForm::takes:
      return GeneratorForm::takes;
    case model::GeneratorForm::both:
      return GeneratorForm::both;
    case model::GeneratorForm::none:
      break;
  }
  return GeneratorForm::none;
}

IndexForm form_of(model::IndexForm form) {
  if (form == model::IndexForm::none) return IndexForm::none;
  return form == model::IndexForm::int32 ? IndexForm::int32 : IndexForm::string;
}

Value number_of_constant(const model::Number& number) {
  return std::visit([](const auto& one) { return Value(one); }, number);
}

// As the definition spells it: its type is known to the caller.
Value value_of_constant(const model::ConstantValue& value) {
  if (const auto* const number = std::get_if<model::Number>(&value)) {
    return number_of_constant(*number);
  }
  if (const auto* const text = std::get_if<std::string>(&value)) return *text;
  List items;
  for (const model::Number& number : std::get<std::vector<model::Number>>(value)) {
    items.push_back(number_of_constant(number));
  }
  return items;
}

}  // namespace

class TableBuilder {
 public:
  TableBuilder(const model::Model& model, Tables& tables, Tables::MakeStub make_stub)
      : model_(model), tables_(tables), make_stub_(make_stub) {}

  void build() {
    for (const auto& definition : model_.definitions()) declare(*definition);
    for (const auto& definition : model_.definitions()) {
      for (const model::Record& record : definition->records) complete_record(record, 0);
    }
    for (const auto& definition : model_.definitions()) {
      for (const model::Object& object : definition->objects) add_object(object);
    }
    for (const auto& definition : model_.definitions()) finish(*definition);
    for (const auto& definition : model_.definitions()) add_constants(*definition);
  }

 private:
  // Names first, since they may refer to each other.
  void declare(const model::Definition& definition) {
    DefinitionTable& table = tables_.definitions_[definition.name];
    table.name = definition.name;
    table.text = definition.text;
    table.outline = model::describe(definition);
    for (const model::Record& record : definition.records) {
      RecordTable& added = tables_.records_[record.qualified_name()];
      added.tables = &tables_;
      added.name = record.qualified_name();
      added.kind = kind_of(record.kind);
      added.node = std::make_unique<RecordNode>(added, added.name);
    }
    for (const model::Enum& one : definition.enums) {
      EnumTable& added = tables_.enums_[definition.name + "." + one.name];
      added.tables = &tables_;
      added.name = definition.name + "." + one.name;
      for (const model::EnumValue& value : one.values) {
        added.values.emplace_back(value.name, value.value);
      }
    }
  }

  // A pod after those that it holds. Deeper ones could not travel.
  void complete_record(const model::Record& record, int depth) {
    RecordTable& table = tables_.records_.find(record.qualified_name())->second;
    if (table.wire_type) return;
    if (depth > static_cast<int>(Limits::deepest)) {
      throw Error(ErrorCode::service_definition_error, "`" + table.name + "` is nested too deep");
    }
    if (table.kind != RecordKind::struct_) {
      for (const model::Field& field : record.fields) {
        const auto* const inner = std::get_if<const model::Record*>(&field.type.base);
        if (inner != nullptr) complete_record(**inner, depth + 1);
      }
    }
    table.fields.reserve(record.fields.size());
    for (const model::Field& field : record.fields) {
      table.fields.push_back({field.name, &node(field.type), field.documentation, 0});
    }
    // The model numbers types as the protocol does.
    complete(table, static_cast<ElementType>(record.number));
  }

  const TypeNode& node(const model::Type& type) { return tables_.type(type.text()); }

  void add_object(const model::Object& object) {
    ObjectTable& table = tables_.objects_[object.qualified_name()];
    table.tables = &tables_;
    table.name = object.qualified_name();
    table.documentation = object.documentation;
    for (const model::Object* const other : object.implements) {
      table.implements.push_back(other->definition == object.definition ? other->name
                                                                        : other->qualified_name());
    }
    table.implements_views.assign(table.implements.begin(), table.implements.end());
    table.members.reserve(object.members.size());
    for (const model::Member& member : object.members) add_member(table, object, member);
    DefinitionTable& definition = tables_.definitions_.find(object.definition->name)->second;
    table.wire_type = std::make_unique<OwnedObjectType>(OwnedObjectType{
        {table.name, definition.wire, table.implements_views, table.wire_members, make_stub_},
        &table});
  }

  void add_member(ObjectTable& object, const model::Object& owner, const model::Member& member) {
    MemberTable& table = object.members.emplace_back();
    table.name = member.name;
    table.declaration = model::written(member, *owner.definition);
    table.documentation = member.documentation;
    Member wire{.kind = kind_of(member.kind),
                .access = access_bits(member.access),
                .index = form_of(member.index),
                .generator = form_of(member.generator),
                .name = table.name};
    if (wire.kind == MemberKind::objref) {
      if (const auto* const type = std::get_if<const model::Object*>(&member.type.base)) {
        table.object_type = (*type)->qualified_name();
      }
      wire.object_type = table.object_type;
    } else if (!member.type.is_void()) {
      table.type = &node(member.type);
      // The runtime transfers memories as what lies in memory.
      wire.type = wire.kind == MemberKind::memory
                      ? &static_cast<const ArrayNode*>(table.type)->wire_type()
                      : table.type;
    }
    for (const model::Parameter& parameter : member.parameters) {
      table.parameters.emplace_back(parameter.name, &node(parameter.type));
    }
    for (const auto& [name, type] : table.parameters) table.wire_parameters.push_back({name, type});
    wire.parameters = table.wire_parameters;
    if (member.generator_parameter) {
      table.generator_parameter = &node(member.generator_parameter->type);
      wire.generator_parameter = table.generator_parameter;
    }
    if (wire.kind == MemberKind::pipe || wire.kind == MemberKind::wire) {
      wire.holding = &holding_of<Value>;
    }
    object.wire_members.push_back(wire);
  }

  static std::size_t size_of(const model::Constant& constant) {
    if (constant.is_struct) return 1;
    const auto* const numbers = std::get_if<std::vector<model::Number>>(&constant.value);
    return numbers == nullptr ? 1 : 1 + numbers->size();
  }

  // A constant of constants is made of copies, and may double its size with each line.
  Value typed_value(const model::Constant& constant, int depth = 0) {
    constexpr std::size_t most_values = 100'000;
    if (depth > static_cast<int>(Limits::deepest) ||
        (constant_values_ += size_of(constant)) > most_values) {
      throw Error(ErrorCode::service_definition_error,
                  "the constant `" + constant.name + "` has too many values in each other");
    }
    if (!constant.is_struct) {
      return node(constant.type).convert(value_of_constant(constant.value), Place({}));
    }
    Fields fields;
    for (const auto& field : std::get<std::vector<model::StructValueField>>(constant.value)) {
      fields.emplace_back(field.field, typed_value(*field.constant, depth + 1));
    }
    return Value::record(std::move(fields));
  }

  void add_constants(const std::string& scope, const std::vector<model::Constant>& constants) {
    Fields& added = tables_.constants_[scope];
    for (const model::Constant& one : constants) added.emplace_back(one.name, typed_value(one));
  }

  void add_constants(const model::Definition& definition) {
    DeclaredNames& declared = tables_.definitions_.find(definition.name)->second.declared;
    add_constants(definition.name, definition.constants);
    for (const model::Enum& one : definition.enums) {
      declared.enums.push_back(definition.name + "." + one.name);
    }
    for (const model::Record& record : definition.records) {
      declared.records.push_back(record.qualified_name());
      add_constants(record.qualified_name(), record.constants);
    }
    for (const model::Object& object : definition.objects) {
      declared.objects.push_back(object.qualified_name());
      add_constants(object.qualified_name(), object.constants);
    }
  }

  void finish(const model::Definition& definition) {
    DefinitionTable& table = tables_.definitions_.find(definition.name)->second;
    for (const model::Record& record : definition.records) {
      table.records.push_back(
          tables_.records_.find(record.qualified_name())->second.wire_type.get());
    }
    for (const model::Object& object : definition.objects) {
      table.objects.push_back(
          tables_.objects_.find(object.qualified_name())->second.wire_type.get());
    }
    table.wire.name = table.name;
    table.wire.text = table.text;
    const auto& numbers = definition.version.numbers;
    for (std::size_t i = 0; i < std::min(numbers.size(), table.wire.version.size()); ++i) {
      table.wire.version[i] = static_cast<std::uint16_t>(numbers[i]);
    }
    table.wire.records = table.records;
    table.wire.objects = table.objects;
    for (const model::Definition* const import : definition.imports) {
      table.imports.push_back(&tables_.definitions_.find(import->name)->second.wire);
    }
    table.wire.imports = table.imports;
    tables_.registry_.add(table.wire);
  }

  const model::Model& model_;
  Tables& tables_;
  const Tables::MakeStub make_stub_;
  std::size_t constant_values_ = 0;
};

std::shared_ptr<Tables> Tables::read(const std::vector<std::string>& texts, MakeStub make_stub) {
  std::vector<robdef::ast::NamedText> named;
  for (std::size_t i = 0; i < texts.size(); ++i) {
    named.push_back({"definition " + std::to_string(i + 1), texts[i]});
  }
  robdef::Sources sources;
  robdef::Report report(robdef::Origin::network);
  const robdef::ast::Program program = robdef::ast::read_texts(std::move(named), sources, report);
  model::Model model = model::resolve(program, sources, report);
  model::evaluate(model, report);
  model::lay_out(model, report);
  model::check(model, report);
  for (const robdef::Diagnostic* const finding : report.sorted()) {
    if (finding->severity() != robdef::Severity::error) continue;
    std::string line = robdef::to_line(*finding, sources);
    while (line.ends_with('\n')) line.pop_back();
    throw Error(ErrorCode::service_definition_error, line);
  }
  auto tables = std::make_shared<Tables>();
  TableBuilder(model, *tables, make_stub).build();
  return tables;
}

Definitions::Definitions(const std::vector<std::string>& texts)
    : tables_(Tables::read(texts, nullptr)) {}

}  // namespace rr::dynamic
