// SPDX-License-Identifier: Apache-2.0
// How values travel; how they are converted is in convert*.cpp.
#include "runtime/cpp/src/dynamic/nodes.hpp"

#include <array>

#include "rr/registry.hpp"
#include "runtime/cpp/src/dynamic/content.hpp"
#include "runtime/cpp/src/dynamic/numbers.hpp"
#include "runtime/cpp/src/dynamic/tables.hpp"
#include "runtime/cpp/src/value/items.hpp"

namespace rr::dynamic {
namespace {

const Value& given(const void* value) { return *static_cast<const Value*>(value); }
Value& place_of(void* value) { return *static_cast<Value*>(value); }

bool is_struct(const RecordTable& table) { return table.kind == RecordKind::struct_; }

// Values are converted before they are written: another kind is a fault of the caller.
bool expect(Writer& writer, const ElementName& name, const Value& value, Kind kind) {
  if (value.kind() == kind) return true;
  writer.fail(ErrorCode::data_type_mismatch, "the value was not converted to its type", name.text);
  return false;
}

// What a value keeps besides itself, `more` bytes in it included.
template <class Content>
bool reserve_content(Decoder& decoder, const Element& element, std::size_t more = 0) {
  return decoder.reserve(value::allocation_cost + sizeof(Content) + more, element.name);
}

}  // namespace

NumberNode::NumberNode(ElementType number)
    : TypeNode(Kind::number, std::string(word_of(number))), number_(number) {}

void NumberNode::write(Writer& writer, const ElementName& name, const void* value) const {
  if (!expect(writer, name, given(value), Kind::number)) return;
  number_wire_type(number_).write(writer, name, given(value).bits());
}

bool NumberNode::read(Decoder& decoder, const Element& element, void* value) const {
  alignas(8) std::array<std::byte, 16> bits{};
  if (!number_wire_type(number_).read(decoder, element, bits.data())) return false;
  place_of(value) = Value(Kind::number, number_, bits.data(), nullptr);
  return true;
}

void TextNode::write(Writer& writer, const ElementName& name, const void* value) const {
  if (!expect(writer, name, given(value), Kind::text)) return;
  string_type.write(writer, name, &content_of<TextContent>(given(value)).text);
}

bool TextNode::read(Decoder& decoder, const Element& element, void* value) const {
  if (!reserve_content<TextContent>(decoder, element)) return false;
  std::string text;
  if (!string_type.read(decoder, element, &text)) return false;
  place_of(value) = Value(std::move(text));
  return true;
}

const std::string* EnumTable::name_of(std::int32_t number) const {
  for (const auto& [known, value] : values) {
    if (value == number) return &known;
  }
  return nullptr;
}

Value EnumNode::make(std::int32_t number) const {
  return {Kind::enumeration, ElementType::int32, &number,
          std::make_shared<EnumContent>(own(table_))};
}

void EnumNode::write(Writer& writer, const ElementName& name, const void* value) const {
  if (!expect(writer, name, given(value), Kind::enumeration)) return;
  number_wire_type(ElementType::int32).write(writer, name, given(value).bits());
}

bool EnumNode::read(Decoder& decoder, const Element& element, void* value) const {
  std::int32_t number = 0;
  if (!number_wire_type(ElementType::int32).read(decoder, element, &number)) return false;
  if (!reserve_content<EnumContent>(decoder, element)) return false;
  place_of(value) = make(number);
  return true;
}

ArrayNode::ArrayNode(const TypeNode& item, ElementType number, ArrayBounds bounds, std::string text)
    : TypeNode(Kind::array, std::move(text)),
      item_(item),
      number_(number),
      record_(nullptr),
      bounds_(std::move(bounds)),
      array_(number_item(number), bounds_.minimum, bounds_.maximum),
      multi_array_(number_item(number), bounds_.shape) {}

ArrayNode::ArrayNode(const TypeNode& item, const RecordTable& record, ArrayBounds bounds,
                     std::string text)
    : TypeNode(Kind::array, std::move(text)),
      item_(item),
      number_(ElementType::void_),
      record_(&record),
      bounds_(std::move(bounds)),
      array_(record.item, bounds_.minimum, bounds_.maximum),
      multi_array_(record.item, bounds_.shape) {}

const ItemType& ArrayNode::wire_item() const {
  return record_ != nullptr ? record_->item : number_item(number_);
}

const rr::Type& ArrayNode::wire_type() const {
  if (bounds_.has_dims) return multi_array_;
  return array_;
}

ElementType ArrayNode::element_type() const { return wire_type().element_type(); }

void ArrayNode::write(Writer& writer, const ElementName& name, const void* value) const {
  if (!expect(writer, name, given(value), Kind::array)) return;
  const auto& content = content_of<ArrayContent>(given(value));
  if (bounds_.has_dims) {
    multi_array_.write(writer, name, &content.data);
  } else {
    array_.write(writer, name, &content.data.items);
  }
}

bool ArrayNode::read(Decoder& decoder, const Element& element, void* value) const {
  if (!reserve_content<ArrayContent>(decoder, element)) return false;
  auto content = std::make_shared<ArrayContent>();
  content->number = number_;
  content->has_dims = bounds_.has_dims;
  const bool good = bounds_.has_dims ? multi_array_.read(decoder, element, &content->data)
                                     : array_.read(decoder, element, &content->data.items);
  if (!good) return false;
  if (record_ != nullptr) content->record = own(*record_);
  place_of(value) = value_of(Kind::array, std::move(content));
  return true;
}

ElementType RecordNode::number() const { return table_.number; }
ElementType RecordNode::element_type() const { return table_.wire_type->element_type(); }

void RecordNode::write(Writer& writer, const ElementName& name, const void* value) const {
  if (is_struct(table_) && given(value).is_null()) {
    writer.null_element(name);
    return;
  }
  if (!expect(writer, name, given(value), Kind::record)) return;
  if (is_struct(table_)) {
    table_.wire_type->write(writer, name, content_of<RecordContent>(given(value)).fields.data());
    return;
  }
  // Attached by the writer when large, so it must live until the message is sent.
  Array<std::uint8_t> memory(table_.size);
  pack(given(value), table_, reinterpret_cast<std::byte*>(memory.mutate().data()));
  value::write_items(writer, name, table_.item, memory.data(), 1, memory.owner());
}

bool RecordNode::read(Decoder& decoder, const Element& element, void* value) const {
  if (!is_struct(table_)) {
    if (!decoder.reserve(table_.size, element.name)) return false;
    const Array<std::uint8_t> memory(table_.size);
    auto* const bytes = const_cast<std::uint8_t*>(memory.data());
    if (!table_.wire_type->read(decoder, element, bytes)) return false;
    place_of(value) = unpack(table_, reinterpret_cast<const std::byte*>(bytes));
    return true;
  }
  if (element.type == ElementType::void_) {
    place_of(value) = Value();
    return true;
  }
  if (!reserve_content<RecordContent>(decoder, element, table_.fields.size() * sizeof(Value))) {
    return false;
  }
  auto content = std::make_shared<RecordContent>();
  content->fields.resize(table_.fields.size());
  if (!table_.wire_type->read(decoder, element, content->fields.data())) return false;
  content->table = own(table_);
  place_of(value) = value_of(Kind::record, std::move(content));
  return true;
}

ContainerNode::ContainerNode(Kind kind, const TypeNode& item, std::string text)
    : TypeNode(kind, std::move(text)),
      item_(item),
      list_(item, list_operations<Value>),
      int_map_(ElementType::vector, item, map_operations<std::int32_t, Value>),
      string_map_(ElementType::dictionary, item, map_operations<std::string, Value>) {}

ElementType ContainerNode::element_type() const {
  if (kind() == Kind::list) return list_.element_type();
  return kind() == Kind::int_map ? int_map_.element_type() : string_map_.element_type();
}

void ContainerNode::write(Writer& writer, const ElementName& name, const void* value) const {
  if (given(value).is_null()) {
    writer.null_element(name);
    return;
  }
  if (!expect(writer, name, given(value), kind())) return;
  if (kind() == Kind::list) {
    list_.write(writer, name, &content_of<ListContent>(given(value)).items);
  } else if (kind() == Kind::int_map) {
    int_map_.write(writer, name, &content_of<IntMapContent>(given(value)).items);
  } else {
    string_map_.write(writer, name, &content_of<StringMapContent>(given(value)).items);
  }
}

bool ContainerNode::read(Decoder& decoder, const Element& element, void* value) const {
  if (element.type == ElementType::void_) {
    place_of(value) = Value();
    return true;
  }
  if (!reserve_content<StringMapContent>(decoder, element)) return false;
  const auto read_into = [&](auto content, const rr::Type& type) {
    if (!type.read(decoder, element, &content->items)) return false;
    place_of(value) = value_of(kind(), std::move(content));
    return true;
  };
  if (kind() == Kind::list) return read_into(std::make_shared<ListContent>(), list_);
  if (kind() == Kind::int_map) return read_into(std::make_shared<IntMapContent>(), int_map_);
  return read_into(std::make_shared<StringMapContent>(), string_map_);
}

// What the value is says how it travels: items of containers do so by themselves again.
void AnyNode::write(Writer& writer, const ElementName& name, const void* value) const {
  const Value& any = given(value);
  switch (any.kind()) {
    case Kind::number:
    case Kind::enumeration:
      number_wire_type(any.number_type()).write(writer, name, any.bits());
      return;
    case Kind::text:
      text_node().write(writer, name, value);
      return;
    case Kind::array: {
      const auto& content = content_of<ArrayContent>(any);
      const ArrayNode& node = content.record == nullptr
                                  ? number_array_node(content.number, content.has_dims)
                              : content.has_dims ? *content.record->multi_array
                                                 : *content.record->array;
      node.write(writer, name, value);
      return;
    }
    case Kind::record:
      if (const auto& table = content_of<RecordContent>(any).table) {
        table->node->write(writer, name, value);
      } else {
        expect(writer, name, any, Kind::any);
      }
      return;
    case Kind::list:
    case Kind::int_map:
    case Kind::string_map:
      any_container_node(any.kind()).write(writer, name, value);
      return;
    case Kind::null:
    case Kind::any:
      writer.null_element(name);
      return;
  }
}

// As VarValueType does for C++ types.
bool AnyNode::read(Decoder& decoder, const Element& element, void* value) const {
  switch (element.type) {
    case ElementType::void_:
      place_of(value) = Value();
      return true;
    case ElementType::string:
      return text_node().read(decoder, element, value);
    case ElementType::list:
      return any_container_node(Kind::list).read(decoder, element, value);
    case ElementType::vector:
      return any_container_node(Kind::int_map).read(decoder, element, value);
    case ElementType::dictionary:
      return any_container_node(Kind::string_map).read(decoder, element, value);
    case ElementType::multidimarray: {
      Element array;
      if (!find_element(decoder, element.payload, element.count, "array", array)) {
        return decoder.fail(ErrorCode::message_element_not_found, "no such element", "array");
      }
      if (array.type == ElementType::string || item_size(array.type) == 0) {
        return value::fail_type(decoder, array);
      }
      return number_array_node(array.type, true).read(decoder, element, value);
    }
    case ElementType::structure:
    case ElementType::pod_array:
    case ElementType::pod_multidimarray:
    case ElementType::namedarray_array:
    case ElementType::namedarray_multidimarray:
      return read_named(decoder, element, value);
    default:
      if (item_size(element.type) != 0) {
        return number_array_node(element.type, false).read(decoder, element, value);
      }
      return decoder.fail(ErrorCode::data_type_error, "no type of a varvalue", element.name);
  }
}

bool AnyNode::read_named(Decoder& decoder, const Element& element, void* value) const {
  if (element.type_name.find('.') == std::string_view::npos) {
    return decoder.fail(ErrorCode::invalid_argument, "type name is not qualified", element.name);
  }
  const RecordType* const record =
      decoder.types() != nullptr ? decoder.types()->find_record(element.type_name) : nullptr;
  // Of the runtime's own records none travels in a varvalue.
  if (record == nullptr || record->operations().held_type == nullptr) {
    return decoder.fail(ErrorCode::service_error, "unknown type", element.name);
  }
  const auto& table = *static_cast<const RecordNode*>(record->operations().held_type)->record();
  const TypeNode* node = table.node.get();
  if (element.type == ElementType::pod_array || element.type == ElementType::namedarray_array) {
    node = table.array.get();
  } else if (element.type != ElementType::structure) {
    node = table.multi_array.get();
  }
  if (node == nullptr || node->element_type() != element.type) {
    return decoder.fail(ErrorCode::data_type_error, "type name of another kind", element.name);
  }
  return node->read(decoder, element, value);
}

const NumberNode& number_node(ElementType number) {
  return with_number(number, [](auto of) -> const NumberNode& {
    static const NumberNode node(number_of<typename decltype(of)::type>);
    return node;
  });
}

const TextNode& text_node() {
  static const TextNode node;
  return node;
}

const AnyNode& any_node() {
  static const AnyNode node;
  return node;
}

const ArrayNode& number_array_node(ElementType number, bool has_dims) {
  return with_number(number, [&](auto of) -> const ArrayNode& {
    constexpr ElementType type = number_of<typename decltype(of)::type>;
    static const ArrayNode array(number_node(type), type, {}, std::string(word_of(type)) + "[]");
    static const ArrayNode multi_array(number_node(type), type, {.has_dims = true},
                                       std::string(word_of(type)) + "[*]");
    return has_dims ? multi_array : array;
  });
}

const ContainerNode& any_container_node(Kind kind) {
  static const ContainerNode list(Kind::list, any_node(), "varvalue{list}");
  static const ContainerNode int_map(Kind::int_map, any_node(), "varvalue{int32}");
  static const ContainerNode string_map(Kind::string_map, any_node(), "varvalue{string}");
  if (kind == Kind::list) return list;
  return kind == Kind::int_map ? int_map : string_map;
}

}  // namespace rr::dynamic
