// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/dynamic/definition_tables.hpp"

#include <array>
#include <utility>

#include "rr/error.hpp"
#include "rr/number.hpp"
#include "runtime/cpp/src/dynamic/type_text.hpp"

namespace rr::dynamic {
namespace {

ElementType number_of_word(std::string_view word) {
  constexpr std::array numbers = {ElementType::double_, ElementType::single,  ElementType::int8,
                                  ElementType::uint8,   ElementType::int16,   ElementType::uint16,
                                  ElementType::int32,   ElementType::uint32,  ElementType::int64,
                                  ElementType::uint64,  ElementType::cdouble, ElementType::csingle,
                                  ElementType::bool_};
  for (const ElementType number : numbers) {
    if (word_of(number) == word) return number;
  }
  return ElementType::void_;
}

[[noreturn]] void no_type(std::string_view text) {
  throw Error(ErrorCode::invalid_argument, "no type: `" + std::string(text) + "`");
}

}  // namespace

std::shared_ptr<const RecordTable> own(const RecordTable& table) {
  return {table.tables->shared_from_this(), &table};
}

std::shared_ptr<const EnumTable> own(const EnumTable& table) {
  return {table.tables->shared_from_this(), &table};
}

const MemberTable* ObjectTable::find(std::string_view member) const {
  for (const MemberTable& one : members) {
    if (one.name == member) return &one;
  }
  return nullptr;
}

const ObjectTable* Tables::find_object(std::string_view name) const {
  const auto found = objects_.find(name);
  return found == objects_.end() ? nullptr : &found->second;
}

Tables::Base Tables::find_base(std::string_view name) const {
  if (const ElementType number = number_of_word(name); number != ElementType::void_) {
    return {&number_node(number), nullptr, number};
  }
  if (name == "string") return {&text_node()};
  if (name == "varvalue") return {&any_node()};
  if (const auto record = records_.find(name); record != records_.end()) {
    return {record->second.node.get(), &record->second};
  }
  if (const auto found = enums_.find(name); found != enums_.end()) {
    std::unique_ptr<const TypeNode>& node = nodes_[std::string(name)];
    if (!node) node = std::make_unique<EnumNode>(found->second);
    return {node.get()};
  }
  return {};
}

const TypeNode& Tables::make_array(const Base& base, ArrayBounds bounds,
                                   const std::string& text) const {
  const bool is_plain = bounds.minimum == 0 && bounds.maximum == any_length && bounds.shape.empty();
  const bool is_number = base.number != ElementType::void_;
  if (!is_number && (base.record == nullptr || base.record->kind == RecordKind::struct_)) {
    no_type(text);
  }
  if (is_plain && is_number) return number_array_node(base.number, bounds.has_dims);
  std::unique_ptr<const TypeNode>& node = nodes_[text];
  if (node) return *node;
  if (is_number) {
    node = std::make_unique<ArrayNode>(*base.node, base.number, std::move(bounds), text);
  } else {
    node = std::make_unique<ArrayNode>(*base.node, *base.record, std::move(bounds), text);
  }
  return *node;
}

const TypeNode& Tables::make_container(const TypeNode& item, Kind kind,
                                       const std::string& text) const {
  if (&item == &any_node()) return any_container_node(kind);
  std::unique_ptr<const TypeNode>& node = nodes_[text];
  if (!node) node = std::make_unique<ContainerNode>(kind, item, text);
  return *node;
}

const TypeNode& Tables::type(std::string_view text) const {
  std::optional<TypeText> parsed = parse_type_text(text);
  if (!parsed) no_type(text);
  const std::string whole = parsed->text();
  const MutexLock lock(mutex_);
  if (const auto known = nodes_.find(whole); known != nodes_.end()) return *known->second;
  const Base base = find_base(parsed->base);
  if (base.node == nullptr) no_type(text);
  const TypeNode* node = base.node;
  if (parsed->is_array) {
    node = &make_array(base, std::move(parsed->bounds), parsed->base + parsed->array);
  }
  if (parsed->container == Kind::null) return *node;
  return make_container(*node, parsed->container, whole);
}

MemberDescription Tables::describe(const ObjectTable& object, const MemberTable& member) const {
  const Member& wire = object.wire(member);
  MemberDescription result{.kind = wire.kind,
                           .name = member.name,
                           .declaration = member.declaration,
                           .documentation = member.documentation,
                           .type = handle(member.type),
                           .parameters = {},
                           .generator = wire.generator,
                           .generator_parameter = handle(member.generator_parameter),
                           .index = wire.index,
                           .object_type = member.object_type,
                           .access = wire.access};
  for (const auto& [name, type] : member.parameters) {
    result.parameters.push_back({name, handle(type)});
  }
  return result;
}

Definitions::Definitions() : tables_(std::make_shared<const Tables>()) {}

ValueType Definitions::type(std::string_view text) const {
  return tables_->handle(&tables_->type(text));
}

const TypeRegistry& Definitions::registry() const { return std::as_const(*tables_).registry(); }

std::vector<std::string> Definitions::services() const {
  std::vector<std::string> names;
  for (const auto& [name, definition] : tables_->definitions()) names.push_back(name);
  return names;
}

namespace {

const DefinitionTable& need_definition(const Tables& tables, std::string_view service) {
  const auto found = tables.definitions().find(service);
  if (found != tables.definitions().end()) return found->second;
  throw Error(ErrorCode::key_not_found, "no definition `" + std::string(service) + "`");
}

}  // namespace

std::string Definitions::outline(std::string_view service) const {
  return need_definition(*tables_, service).outline;
}

std::string Definitions::text(std::string_view service) const {
  return need_definition(*tables_, service).text;
}

DeclaredNames Definitions::declared(std::string_view service) const {
  return need_definition(*tables_, service).declared;
}

const Fields* Tables::find_constants(std::string_view scope) const {
  const auto found = constants_.find(scope);
  return found == constants_.end() ? nullptr : &found->second;
}

Fields Definitions::constants(std::string_view scope) const {
  if (const Fields* const found = tables_->find_constants(scope)) return *found;
  throw Error(ErrorCode::key_not_found,
              "no definition, struct or object `" + std::string(scope) + "`");
}

namespace {

const ObjectTable& need_object(const Tables& tables, std::string_view object) {
  if (const ObjectTable* const table = tables.find_object(object)) return *table;
  throw Error(ErrorCode::key_not_found, "no object `" + std::string(object) + "`");
}

}  // namespace

std::vector<MemberDescription> Definitions::members(std::string_view object) const {
  const ObjectTable& table = need_object(*tables_, object);
  std::vector<MemberDescription> members;
  for (const MemberTable& member : table.members) {
    members.push_back(tables_->describe(table, member));
  }
  return members;
}

std::string Definitions::documentation(std::string_view object) const {
  return need_object(*tables_, object).documentation;
}

}  // namespace rr::dynamic
