// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "rr/array_type.hpp"
#include "rr/container_type.hpp"
#include "rr/dynamic_value.hpp"
#include "rr/record.hpp"
#include "runtime/cpp/src/dynamic/place.hpp"

/// The types of values that are known at run time only. Each reads and writes a Value through the
/// runtime's own types for C++ values.
namespace rr::dynamic {

class Tables;
struct RecordTable;
struct EnumTable;

class TypeNode : public rr::Type {
 public:
  TypeNode(Kind kind, std::string text) : kind_(kind), text_(std::move(text)) {}
  virtual ~TypeNode() = default;
  TypeNode(const TypeNode&) = delete;
  TypeNode& operator=(const TypeNode&) = delete;

  [[nodiscard]] Kind kind() const { return kind_; }
  [[nodiscard]] const std::string& text() const { return text_; }
  /// See ValueType::convert.
  [[nodiscard]] virtual Value convert(const Value& value, const Place& place) const = 0;

  // What only some have.
  [[nodiscard]] virtual ElementType number() const { return ElementType::void_; }
  [[nodiscard]] virtual const TypeNode* item() const { return nullptr; }
  [[nodiscard]] virtual const RecordTable* record() const { return nullptr; }
  [[nodiscard]] virtual const EnumTable* enumeration() const { return nullptr; }
  [[nodiscard]] virtual bool has_dims() const { return false; }

 protected:
  /// Throws: `expected double[3], got string`.
  [[noreturn]] void refuse(const Value& value, const Place& place) const;

 private:
  const Kind kind_;
  const std::string text_;
};

class NumberNode final : public TypeNode {
 public:
  explicit NumberNode(ElementType number);
  [[nodiscard]] ElementType number() const override { return number_; }
  [[nodiscard]] ElementType element_type() const override { return number_; }
  void write(Writer& writer, const ElementName& name, const void* value) const override;
  bool read(Decoder& decoder, const Element& element, void* value) const override;
  [[nodiscard]] Value convert(const Value& value, const Place& place) const override;

 private:
  const ElementType number_;
};

class TextNode final : public TypeNode {
 public:
  TextNode() : TypeNode(Kind::text, "string") {}
  [[nodiscard]] ElementType element_type() const override { return ElementType::string; }
  void write(Writer& writer, const ElementName& name, const void* value) const override;
  bool read(Decoder& decoder, const Element& element, void* value) const override;
  [[nodiscard]] Value convert(const Value& value, const Place& place) const override;
};

/// An enum of a definition.
struct EnumTable {
  const Tables* tables = nullptr;
  std::string name;  ///< qualified
  std::vector<std::pair<std::string, std::int32_t>> values;

  /// Null for a number without a name.
  [[nodiscard]] const std::string* name_of(std::int32_t number) const;
};

class EnumNode final : public TypeNode {
 public:
  explicit EnumNode(const EnumTable& table)
      : TypeNode(Kind::enumeration, table.name), table_(table) {}
  [[nodiscard]] ElementType number() const override { return ElementType::int32; }
  [[nodiscard]] const EnumTable* enumeration() const override { return &table_; }
  [[nodiscard]] ElementType element_type() const override { return ElementType::int32; }
  void write(Writer& writer, const ElementName& name, const void* value) const override;
  bool read(Decoder& decoder, const Element& element, void* value) const override;
  [[nodiscard]] Value convert(const Value& value, const Place& place) const override;

 private:
  [[nodiscard]] Value make(std::int32_t number) const;
  const EnumTable& table_;
};

/// How long an array may be, and its shape.
struct ArrayBounds {
  std::uint32_t minimum = 0;
  std::uint32_t maximum = any_length;
  bool has_dims = false;
  std::vector<std::uint32_t> shape{};  ///< fixed, else empty
};

class ArrayNode final : public TypeNode {
 public:
  /// Of numbers.
  ArrayNode(const TypeNode& item, ElementType number, ArrayBounds bounds, std::string text);
  /// Of pods or namedarrays.
  ArrayNode(const TypeNode& item, const RecordTable& record, ArrayBounds bounds, std::string text);

  [[nodiscard]] ElementType number() const override { return number_; }
  [[nodiscard]] const TypeNode* item() const override { return &item_; }
  [[nodiscard]] const RecordTable* record() const override { return record_; }
  [[nodiscard]] bool has_dims() const override { return bounds_.has_dims; }
  [[nodiscard]] const ArrayBounds& bounds() const { return bounds_; }
  [[nodiscard]] const ItemType& wire_item() const;
  /// For members that are memories: values are an Array or a MultiArray.
  [[nodiscard]] const rr::Type& wire_type() const;

  [[nodiscard]] ElementType element_type() const override;
  void write(Writer& writer, const ElementName& name, const void* value) const override;
  bool read(Decoder& decoder, const Element& element, void* value) const override;
  [[nodiscard]] Value convert(const Value& value, const Place& place) const override;

 private:
  [[nodiscard]] Value convert_items(const Value& value, const Place& place) const;
  void check(const Value& array, const Place& place) const;

  const TypeNode& item_;
  const ElementType number_;  // void_ for records
  const RecordTable* const record_;
  const ArrayBounds bounds_;
  const ArrayType array_;
  const MultiArrayType multi_array_;
};

/// A struct, which may be null, or one pod or namedarray.
class RecordNode final : public TypeNode {
 public:
  RecordNode(const RecordTable& table, std::string text)
      : TypeNode(Kind::record, std::move(text)), table_(table) {}
  [[nodiscard]] const RecordTable* record() const override { return &table_; }
  [[nodiscard]] ElementType number() const override;  ///< of a namedarray
  [[nodiscard]] ElementType element_type() const override;
  void write(Writer& writer, const ElementName& name, const void* value) const override;
  bool read(Decoder& decoder, const Element& element, void* value) const override;
  [[nodiscard]] Value convert(const Value& value, const Place& place) const override;

 private:
  [[nodiscard]] Value convert_fields(const Value& value, const Place& place) const;
  [[nodiscard]] Value convert_numbers(const Value& value, const Place& place) const;
  const RecordTable& table_;
};

/// {list}, {int32} and {string}, which may be null.
class ContainerNode final : public TypeNode {
 public:
  ContainerNode(Kind kind, const TypeNode& item, std::string text);
  [[nodiscard]] const TypeNode* item() const override { return &item_; }
  [[nodiscard]] ElementType element_type() const override;
  void write(Writer& writer, const ElementName& name, const void* value) const override;
  bool read(Decoder& decoder, const Element& element, void* value) const override;
  [[nodiscard]] Value convert(const Value& value, const Place& place) const override;

 private:
  [[nodiscard]] Value convert_list(const Value& value, const Place& place) const;
  [[nodiscard]] Value convert_int_map(const Value& value, const Place& place) const;
  [[nodiscard]] Value convert_string_map(const Value& value, const Place& place) const;

  const TypeNode& item_;
  const ListType list_;
  const MapType int_map_;
  const MapType string_map_;
};

/// varvalue.
class AnyNode final : public TypeNode {
 public:
  AnyNode() : TypeNode(Kind::any, "varvalue") {}
  [[nodiscard]] ElementType element_type() const override { return ElementType::void_; }
  void write(Writer& writer, const ElementName& name, const void* value) const override;
  bool read(Decoder& decoder, const Element& element, void* value) const override;
  [[nodiscard]] Value convert(const Value& value, const Place& place) const override;

 private:
  bool read_named(Decoder& decoder, const Element& element, void* value) const;
};

/// Types that need no definition. They live for ever.
const NumberNode& number_node(ElementType number);
const TextNode& text_node();
const AnyNode& any_node();
/// `T[]` and `T[*]`.
const ArrayNode& number_array_node(ElementType number, bool has_dims);
/// Of varvalues; `kind` is list, int_map or string_map.
const ContainerNode& any_container_node(Kind kind);

}  // namespace rr::dynamic
