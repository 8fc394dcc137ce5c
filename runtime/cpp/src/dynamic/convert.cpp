// SPDX-License-Identifier: Apache-2.0
// Values that a program has made, as values of a declared type: single ones and records.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>

#include "runtime/cpp/src/dynamic/content.hpp"
#include "runtime/cpp/src/dynamic/nodes.hpp"
#include "runtime/cpp/src/dynamic/numbers.hpp"
#include "runtime/cpp/src/dynamic/tables.hpp"

namespace rr::dynamic {
namespace {

using Bits = std::array<std::byte, 16>;

// Numbers that JSON has no word for, and integers as texts.
bool number_of_text(const std::string& text, ElementType type, void* bits) {
  double special = std::numeric_limits<double>::quiet_NaN();
  if (text == "Infinity") special = std::numeric_limits<double>::infinity();
  if (text == "-Infinity") special = -std::numeric_limits<double>::infinity();
  if (text == "NaN" || !std::isnan(special)) {
    const bool is_real =
        type == ElementType::double_ || type == ElementType::single || is_complex(type);
    return is_real && convert_number(ElementType::double_, &special, type, bits);
  }
  const auto parse = [&](auto number, ElementType number_type) {
    const char* const end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, number);
    return error == std::errc() && stop == end && convert_number(number_type, &number, type, bits);
  };
  if (text.empty() || type == ElementType::bool_) return false;
  return parse(std::int64_t{}, ElementType::int64) || parse(std::uint64_t{}, ElementType::uint64);
}

bool is_plain(const Value& value) {
  return value.kind() == Kind::number || value.kind() == Kind::enumeration;
}

std::string names_of(const EnumTable& table) {
  std::string names;
  for (const auto& [name, number] : table.values) names += (names.empty() ? "" : ", ") + name;
  return names;
}

// The fields that a value has for a record, by name; null where it has none.
class GivenFields {
 public:
  explicit GivenFields(const Value& value) : value_(value) {
    if (value.kind() == Kind::record) content_ = &content_of<RecordContent>(value);
  }
  [[nodiscard]] const Value* find(std::string_view name) const {
    if (content_ == nullptr) {
      const StringMap& map = content_of<StringMapContent>(value_).items;
      const auto found = map.find(std::string(name));
      return found == map.end() ? nullptr : &found->second;
    }
    for (std::size_t i = 0; i < content_->fields.size(); ++i) {
      if (name_of(i) == name) return &content_->fields[i];
    }
    return nullptr;
  }
  // Calls `visit` with each name.
  template <class Visit>
  void each_name(Visit visit) const {
    if (content_ == nullptr) {
      for (const auto& [name, item] : content_of<StringMapContent>(value_).items) visit(name);
      return;
    }
    for (std::size_t i = 0; i < content_->fields.size(); ++i) visit(name_of(i));
  }

 private:
  [[nodiscard]] const std::string& name_of(std::size_t i) const {
    return content_->table ? content_->table->fields[i].name : content_->names[i];
  }
  const Value& value_;
  const RecordContent* content_ = nullptr;
};

}  // namespace

void TypeNode::refuse(const Value& value, const Place& place) const {
  place.fail("expected " + text_ + ", got " + value.type_text());
}

Value NumberNode::convert(const Value& value, const Place& place) const {
  Bits bits{};
  const auto made = [&] { return Value(Kind::number, number_, bits.data(), nullptr); };
  if (value.kind() == Kind::number && value.number_type() == number_) return value;
  if (is_plain(value)) {
    if (convert_number(value.number_type(), value.bits(), number_, bits.data())) return made();
    const bool is_flag = value.number_type() == ElementType::bool_ || number_ == ElementType::bool_;
    if (is_flag) refuse(value, place);
    place.fail("expected " + text() + ", which cannot hold " +
               number_text(value.number_type(), value.bits()));
  }
  if (value.kind() == Kind::text && place.is_json() &&
      number_of_text(value.text(), number_, bits.data())) {
    return made();
  }
  if (value.kind() == Kind::list && is_complex(number_) && value.size() == 2) {
    const ElementType part =
        number_ == ElementType::cdouble ? ElementType::double_ : ElementType::single;
    for (std::size_t i = 0; i < 2; ++i) {
      const Value one = number_node(part).convert(value.list()[i], place.item(i));
      std::memcpy(bits.data() + i * item_size(part), one.bits(), item_size(part));
    }
    return made();
  }
  refuse(value, place);
}

Value TextNode::convert(const Value& value, const Place& place) const {
  if (value.kind() != Kind::text) refuse(value, place);
  return value;
}

Value EnumNode::convert(const Value& value, const Place& place) const {
  if (is_plain(value)) {
    std::int32_t number = 0;
    if (!convert_number(value.number_type(), value.bits(), ElementType::int32, &number)) {
      refuse(value, place);
    }
    return make(number);
  }
  if (value.kind() != Kind::text) refuse(value, place);
  const std::string wanted = value.text();
  for (const auto& [name, number] : table_.values) {
    if (name == wanted) return make(number);
  }
  place.fail("expected " + text() + " (" + names_of(table_) + "), got \"" + wanted + "\"");
}

Value RecordNode::convert(const Value& value, const Place& place) const {
  if (place.is_too_deep()) place.fail("the value is too deep");
  if (value.is_null() && table_.kind == RecordKind::struct_) return value;
  if (value.kind() == Kind::record) {
    const auto& content = content_of<RecordContent>(value);
    if (content.table.get() == &table_) return value;
    if (content.table && content.table->name != table_.name) refuse(value, place);
    return convert_fields(value, place);
  }
  if (value.kind() == Kind::string_map) return convert_fields(value, place);
  const bool is_flat = value.kind() == Kind::array || value.kind() == Kind::list;
  if (table_.kind == RecordKind::namedarray && is_flat) return convert_numbers(value, place);
  refuse(value, place);
}

Value RecordNode::convert_fields(const Value& value, const Place& place) const {
  const GivenFields given(value);
  given.each_name([&](const std::string& name) {
    const bool is_known = std::any_of(table_.fields.begin(), table_.fields.end(),
                                      [&](const FieldTable& field) { return field.name == name; });
    if (!is_known) place.fail("`" + table_.name + "` has no field `" + name + "`");
  });
  auto content = std::make_shared<RecordContent>();
  content->table = own(table_);
  content->fields.reserve(table_.fields.size());
  for (const FieldTable& field : table_.fields) {
    const Value* const found = given.find(field.name);
    if (found == nullptr) {
      place.field(field.name).fail("missing, expected " + field.type->text());
    }
    content->fields.push_back(field.type->convert(*found, place.field(field.name)));
  }
  return value_of(Kind::record, std::move(content));
}

// A namedarray from the flat list of its numbers.
Value RecordNode::convert_numbers(const Value& value, const Place& place) const {
  const TypeNode& numbers = number_array_node(table_.number, false);
  const bool is_of_records =
      value.kind() == Kind::array && content_of<ArrayContent>(value).record != nullptr;
  if (is_of_records) {
    const bool is_one =
        content_of<ArrayContent>(value).record->name == table_.name && value.size() == 1;
    if (!is_one) refuse(value, place);
    return convert(value.at(0), place);
  }
  const Value array = numbers.convert(value, place);
  if (array.size() != table_.number_count) {
    place.fail("expected " + text() + ", which has " + std::to_string(table_.number_count) +
               " numbers, got " + std::to_string(array.size()));
  }
  return unpack(table_,
                static_cast<const std::byte*>(content_of<ArrayContent>(array).data.items.items()));
}

}  // namespace rr::dynamic
