// SPDX-License-Identifier: Apache-2.0
#include "rr/error.hpp"
#include "rr/number.hpp"
#include "runtime/cpp/src/dynamic/definition_tables.hpp"
#include "runtime/cpp/src/dynamic/json.hpp"

namespace rr::dynamic {
namespace {

// The same owner, another node.
ValueType sibling(const ValueType& type, const TypeNode* node) {
  if (node == nullptr) return {};
  return {type.tables(), node};
}

const TypeNode& need(const TypeNode* node) {
  if (node != nullptr) return *node;
  throw Error(ErrorCode::invalid_operation, "there is no value of type void");
}

}  // namespace

ValueType ValueType::parse(std::string_view text) { return Definitions().type(text); }

Kind ValueType::kind() const { return node_ != nullptr ? node_->kind() : Kind::null; }

const std::string& ValueType::text() const {
  static const std::string no_type = "void";
  return node_ != nullptr ? node_->text() : no_type;
}

ElementType ValueType::number() const {
  return node_ != nullptr ? node_->number() : ElementType::void_;
}

ValueType ValueType::item() const {
  return sibling(*this, node_ != nullptr ? node_->item() : nullptr);
}

const std::string& ValueType::name() const {
  static const std::string no_name;
  if (node_ != nullptr && node_->record() != nullptr) return node_->record()->name;
  if (node_ != nullptr && node_->enumeration() != nullptr) return node_->enumeration()->name;
  return no_name;
}

std::vector<Field> ValueType::fields() const {
  std::vector<Field> fields;
  if (kind() != Kind::record) return fields;
  for (const FieldTable& field : node_->record()->fields) {
    fields.push_back({field.name, sibling(*this, field.type), field.documentation});
  }
  return fields;
}

RecordKind ValueType::record_kind() const {
  const RecordTable* const record = need(node_).record();
  return record != nullptr ? record->kind : RecordKind::struct_;
}

std::vector<std::pair<std::string, std::int32_t>> ValueType::enum_values() const {
  const bool is_enum = node_ != nullptr && node_->enumeration() != nullptr;
  return is_enum ? node_->enumeration()->values
                 : std::vector<std::pair<std::string, std::int32_t>>();
}

bool ValueType::has_dims() const { return node_ != nullptr && node_->has_dims(); }

const rr::Type& ValueType::wire_type() const { return need(node_); }

Value ValueType::convert(const Value& value, std::string_view subject) const {
  return need(node_).convert(value, Place(subject));
}

Value ValueType::from_json(std::string_view json, std::string_view subject) const {
  const std::shared_ptr<const Tables> types = tables_ ? tables_ : Definitions().tables();
  return need(node_).convert(parse_json(json), Place(subject, types.get()));
}

std::string ValueType::to_json(const Value& value) const {
  std::string text;
  write_json(value, &need(node_), text);
  return text;
}

std::string Value::to_json() const {
  std::string text;
  write_json(*this, nullptr, text);
  return text;
}

Value Value::from_json(std::string_view json) { return parse_json(json); }

}  // namespace rr::dynamic
