// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstring>

#include "rr/error.hpp"
#include "runtime/cpp/src/dynamic/content.hpp"
#include "runtime/cpp/src/dynamic/definition_tables.hpp"
#include "runtime/cpp/src/dynamic/numbers.hpp"
#include "runtime/cpp/src/dynamic/tables.hpp"

namespace rr::dynamic {
namespace {

[[noreturn]] void mismatch(const std::string& expected, const Value& value) {
  throw Error(ErrorCode::data_type_mismatch, "expected " + expected + ", got " + value.type_text());
}

const ArrayContent& array_of(const Value& value, const char* expected) {
  if (value.kind() != Kind::array) mismatch(expected, value);
  return content_of<ArrayContent>(value);
}

const ItemType& item_of(const ArrayContent& array) {
  const auto* const record = array.record.get();
  return record != nullptr ? record->item : number_item(array.number);
}

// -1 for none.
std::size_t find_field(const RecordContent& record, std::string_view name) {
  const std::size_t count = record.fields.size();
  for (std::size_t i = 0; i < count; ++i) {
    if ((record.table ? record.table->fields[i].name : record.names[i]) == name) return i;
  }
  return count;
}

bool same_bytes(const ArrayContent& a, const ArrayContent& b) {
  if (a.number != b.number || a.has_dims != b.has_dims || a.data.dims != b.data.dims ||
      (a.record == nullptr) != (b.record == nullptr) ||
      a.data.items.count() != b.data.items.count()) {
    return false;
  }
  if (a.record == nullptr) {
    const std::size_t size = a.data.items.count() * item_size(a.number);
    return size == 0 || std::memcmp(a.data.items.items(), b.data.items.items(), size) == 0;
  }
  return a.record->name == b.record->name;  // items are compared one by one: they have gaps
}

}  // namespace

Value::Value(Kind kind, ElementType number, const void* bits,
             std::shared_ptr<const Content> content)
    : kind_(kind), number_(number), content_(std::move(content)) {
  if (bits != nullptr) std::memcpy(bits_.data(), bits, item_size(number));
}

Value::Value(std::string text)
    : Value(value_of(Kind::text, std::make_shared<TextContent>(std::move(text)))) {}

Value::Value(ElementType number, const void* items, const std::vector<std::uint32_t>* dims) {
  auto content = std::make_shared<ArrayContent>();
  content->number = number;
  content->has_dims = dims != nullptr;
  content->data.items = *static_cast<const ArrayStorage*>(items);
  if (dims != nullptr) {
    content->data.dims = *dims;
    std::uint64_t product = dims->empty() ? 0 : 1;
    for (const std::uint32_t dim : *dims) {
      if (__builtin_mul_overflow(product, dim, &product)) product = ~std::uint64_t{0};
    }
    if (product != content->data.items.count()) {
      throw Error(ErrorCode::invalid_argument, "dims do not fit the items");
    }
  }
  kind_ = Kind::array;
  content_ = std::move(content);
}

Value::Value(List items) {
  auto content = std::make_shared<ListContent>();
  content->items = std::move(items);
  *this = value_of(Kind::list, std::move(content));
}

Value::Value(IntMap items) {
  auto content = std::make_shared<IntMapContent>();
  content->items = std::move(items);
  *this = value_of(Kind::int_map, std::move(content));
}

Value::Value(StringMap items) {
  auto content = std::make_shared<StringMapContent>();
  content->items = std::move(items);
  *this = value_of(Kind::string_map, std::move(content));
}

Value Value::record(Fields fields) {
  auto content = std::make_shared<RecordContent>();
  for (auto& [name, value] : fields) {
    content->names.push_back(std::move(name));
    content->fields.push_back(std::move(value));
  }
  return value_of(Kind::record, std::move(content));
}

std::string Value::type_text() const {
  switch (kind_) {
    case Kind::number:
      return std::string(word_of(number_));
    case Kind::text:
      return "string";
    case Kind::enumeration:
      return content_of<EnumContent>(*this).table->name;
    case Kind::array: {
      const auto& array = content_of<ArrayContent>(*this);
      return (array.record ? array.record->name : std::string(word_of(array.number))) +
             (array.has_dims ? "[*]" : "[]");
    }
    case Kind::record: {
      const auto& table = content_of<RecordContent>(*this).table;
      return table ? table->name : "fields";
    }
    case Kind::list:
      return "list";
    case Kind::int_map:
    case Kind::string_map:
      return "map";
    default:
      return "null";
  }
}

ValueType Value::type() const {
  switch (kind_) {
    case Kind::number:
    case Kind::enumeration:
      return {nullptr, &number_node(number_)};
    case Kind::text:
      return {nullptr, &text_node()};
    case Kind::array: {
      const auto& array = content_of<ArrayContent>(*this);
      if (!array.record) return {nullptr, &number_array_node(array.number, array.has_dims)};
      const RecordTable& record = *array.record;
      return record.tables->handle(array.has_dims ? record.multi_array.get() : record.array.get());
    }
    case Kind::record: {
      const auto& table = content_of<RecordContent>(*this).table;
      return table ? table->tables->handle(table->node.get()) : ValueType();
    }
    case Kind::list:
    case Kind::int_map:
    case Kind::string_map:
      return {nullptr, &any_container_node(kind_)};
    default:
      return {};
  }
}

ElementType Value::number_type() const {
  return kind_ == Kind::array ? content_of<ArrayContent>(*this).number : number_;
}

void Value::get_number(ElementType type, void* number) const {
  if (kind_ == Kind::array && size() == 1 && number_type() != ElementType::void_) {
    at(0).get_number(type, number);
    return;
  }
  if (kind_ != Kind::number && kind_ != Kind::enumeration) {
    mismatch(std::string(word_of(type)), *this);
  }
  if (!convert_number(number_, bits_.data(), type, number)) {
    throw Error(ErrorCode::data_type_mismatch,
                std::string(word_of(type)) + " cannot hold " + number_text(number_, bits_.data()));
  }
}

void Value::get_array(ElementType type, void* array) const {
  const std::string expected = std::string(word_of(type)) + "[]";
  const ArrayContent& content = array_of(*this, expected.c_str());
  auto& to = *static_cast<ArrayStorage*>(array);
  if (content.record == nullptr && content.number == type) {
    to = content.data.items;
    return;
  }
  if (content.record == nullptr || content.record->number != type) mismatch(expected, *this);
  to.share(content.data.items.items(), content.data.items.count() * content.record->number_count,
           content.data.items.owner());
}

std::string Value::text() const {
  if (kind_ == Kind::text) return content_of<TextContent>(*this).text;
  if (kind_ != Kind::enumeration) mismatch("string", *this);
  const std::string* const name = content_of<EnumContent>(*this).table->name_of(as<std::int32_t>());
  return name != nullptr ? *name : number_text(number_, bits_.data());
}

std::size_t Value::size() const {
  switch (kind_) {
    case Kind::array:
      return content_of<ArrayContent>(*this).data.items.count();
    case Kind::record:
      return content_of<RecordContent>(*this).fields.size();
    case Kind::list:
      return list().size();
    case Kind::int_map:
      return int_map().size();
    case Kind::string_map:
      return string_map().size();
    default:
      mismatch("an array, list, map or record", *this);
  }
}

Value Value::at(std::size_t index) const {
  if (kind_ != Kind::list && kind_ != Kind::array) mismatch("an array or list", *this);
  if (index >= size()) {
    throw Error(ErrorCode::out_of_range,
                "no item " + std::to_string(index) + " of " + std::to_string(size()));
  }
  if (kind_ == Kind::list) return list()[index];
  const auto& array = content_of<ArrayContent>(*this);
  const auto* const item =
      static_cast<const std::byte*>(array.data.items.items()) + index * item_of(array).size;
  if (array.record) return unpack(*array.record, item);
  return {Kind::number, array.number, item, nullptr};
}

bool Value::has(std::string_view name) const {
  if (kind_ == Kind::string_map) return string_map().contains(std::string(name));
  if (kind_ != Kind::record) return false;
  const auto& record = content_of<RecordContent>(*this);
  return find_field(record, name) != record.fields.size();
}

Value Value::at(std::string_view name) const {
  if (kind_ == Kind::string_map) {
    const auto found = string_map().find(std::string(name));
    if (found != string_map().end()) return found->second;
    throw Error(ErrorCode::key_not_found, "no item `" + std::string(name) + "`");
  }
  if (kind_ != Kind::record) mismatch("a record or map", *this);
  const auto& record = content_of<RecordContent>(*this);
  const std::size_t i = find_field(record, name);
  if (i != record.fields.size()) return record.fields[i];
  throw Error(ErrorCode::key_not_found,
              "`" + type_text() + "` has no field `" + std::string(name) + "`");
}

Value Value::at_key(std::int32_t key) const {
  const auto found = int_map().find(key);
  if (found != int_map().end()) return found->second;
  throw Error(ErrorCode::key_not_found, "no item " + std::to_string(key));
}

std::vector<std::uint32_t> Value::dims() const {
  const ArrayContent& array = array_of(*this, "an array");
  if (array.has_dims) return array.data.dims;
  return {static_cast<std::uint32_t>(array.data.items.count())};
}

bool Value::has_dims() const {
  return kind_ == Kind::array && content_of<ArrayContent>(*this).has_dims;
}

const List& Value::list() const {
  if (kind_ != Kind::list) mismatch("a list", *this);
  return content_of<ListContent>(*this).items;
}

const IntMap& Value::int_map() const {
  if (kind_ != Kind::int_map) mismatch("a map with int32 keys", *this);
  return content_of<IntMapContent>(*this).items;
}

const StringMap& Value::string_map() const {
  if (kind_ != Kind::string_map) mismatch("a map with string keys", *this);
  return content_of<StringMapContent>(*this).items;
}

Fields Value::fields() const {
  if (kind_ != Kind::record) mismatch("a record", *this);
  const auto& record = content_of<RecordContent>(*this);
  Fields fields;
  fields.reserve(record.fields.size());
  for (std::size_t i = 0; i < record.fields.size(); ++i) {
    fields.emplace_back(record.table ? record.table->fields[i].name : record.names[i],
                        record.fields[i]);
  }
  return fields;
}

List Value::items() const {
  if (kind_ == Kind::list) return list();
  if (kind_ == Kind::record) return content_of<RecordContent>(*this).fields;
  List items;
  items.reserve(size());
  for (std::size_t i = 0; i < size(); ++i) items.push_back(at(i));
  return items;
}

bool Value::is_same_as(const Value& b) const {
  const Value& a = *this;
  if (a.kind_ != b.kind_) return false;
  switch (a.kind_) {
    case Kind::number:
      return a.number_ == b.number_ &&
             std::memcmp(a.bits_.data(), b.bits_.data(), item_size(a.number_)) == 0;
    case Kind::text:
      return content_of<TextContent>(a).text == content_of<TextContent>(b).text;
    case Kind::enumeration:
      return a.as<std::int32_t>() == b.as<std::int32_t>() && a.type_text() == b.type_text();
    case Kind::array: {
      const auto& array = content_of<ArrayContent>(a);
      if (!same_bytes(array, content_of<ArrayContent>(b))) return false;
      return array.record == nullptr || a.items() == b.items();
    }
    case Kind::record:
      return a.type_text() == b.type_text() && a.fields() == b.fields();
    case Kind::list:
      return a.list() == b.list();
    case Kind::int_map:
      return a.int_map() == b.int_map();
    case Kind::string_map:
      return a.string_map() == b.string_map();
    default:
      return true;
  }
}

}  // namespace rr::dynamic
