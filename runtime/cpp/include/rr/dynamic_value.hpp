// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <complex>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "rr/array.hpp"
#include "rr/complex.hpp"
#include "rr/type.hpp"
#include "rr/visibility.hpp"

/// Values whose types are known at run time only (03), and those types. docs/howto/dynamic.md shows
/// how they are used.
namespace RR_VISIBLE rr {
namespace dynamic {

class Value;
class Tables;
class TypeNode;
struct Content;

/// What a value is, or what a type takes.
enum class Kind : std::uint8_t {
  null,         ///< of values: no struct, no container, an empty varvalue; of types: void
  number,       ///< one number, bool or complex number
  text,         ///< string
  enumeration,  ///< one value of an enum: a number that may have a name
  array,        ///< numbers, pods or namedarrays, with or without dimensions
  record,      ///< struct, or one pod or namedarray: fields by name, in the order of the definition
  list,        ///< items of one type, or of any in a varvalue
  int_map,     ///< items by int32 keys
  string_map,  ///< items by string keys
  any,         ///< of types only: varvalue
};

struct Field;

/// A type as definitions spell it: `double[3]`, `com.robotraconteur.geometry.Vector3{list}`. A
/// handle that is copied freely and keeps alive what it needs.
class ValueType {
 public:
  /// No type, as of a function that returns nothing.
  ValueType() = default;
  /// A type that needs no definition: `string{list}`, `uint8[]`. Throws rr::Error
  /// (invalid_argument). Those of definitions: Definitions::type().
  static ValueType parse(std::string_view text);

  /// What a value of this type is; null for no type.
  [[nodiscard]] Kind kind() const;
  /// Qualified, without spaces; `void` for no type.
  [[nodiscard]] const std::string& text() const;
  /// The number's, that of an array's or namedarray's numbers; int32 for an enum; void_ for all
  /// others.
  [[nodiscard]] ElementType number() const;
  /// The type of an item of a list, map or array.
  [[nodiscard]] ValueType item() const;
  /// Qualified, of a record, enum, or an array's record; empty for all others.
  [[nodiscard]] const std::string& name() const;
  /// Of a record.
  [[nodiscard]] std::vector<Field> fields() const;
  /// Struct, pod or namedarray, of a record.
  [[nodiscard]] RecordKind record_kind() const;
  /// Of an enum, in the order of the definition.
  [[nodiscard]] std::vector<std::pair<std::string, std::int32_t>> enum_values() const;
  /// As what its values travel, each a rr::dynamic::Value of this type.
  [[nodiscard]] const rr::Type& wire_type() const;
  /// Whether an array has dimensions: `T[*]`, `T[2,3]`.
  [[nodiscard]] bool has_dims() const;

  /// The value as one of this type: numbers that fit exactly, texts for enums, lists for arrays,
  /// maps for records. Throws rr::Error (data_type_mismatch), which names the place in the value:
  /// `member pose, field q[2]: expected double, got string`.
  [[nodiscard]] Value convert(const Value& value, std::string_view subject = {}) const;
  /// Reads a value of this type from its JSON form (docs/howto/dynamic.md). Throws rr::Error
  /// (invalid_argument for what is no JSON, else as convert).
  [[nodiscard]] Value from_json(std::string_view json, std::string_view subject = {}) const;
  /// Writes a value of this type, so that from_json gives the same value again.
  [[nodiscard]] std::string to_json(const Value& value) const;

  /// Whether both are spelled the same, as text() gives it.
  friend bool operator==(const ValueType& a, const ValueType& b) { return a.text() == b.text(); }

  /// For the runtime: a type of definitions that were read; these are kept.
  ValueType(std::shared_ptr<const Tables> tables, const TypeNode* node)
      : tables_(std::move(tables)), node_(node) {}
  /// For the runtime: what the type is; null for no type.
  [[nodiscard]] const TypeNode* node() const { return node_; }
  /// For the runtime: the definitions that it is of; null for a type that needs none.
  [[nodiscard]] const std::shared_ptr<const Tables>& tables() const { return tables_; }

 private:
  std::shared_ptr<const Tables> tables_;
  const TypeNode* node_ = nullptr;
};

/// A field of a record.
struct Field {
  std::string name;           ///< as in the definition
  ValueType type;             ///< what it takes
  std::string documentation;  ///< the comments before it, without their marks
};

/// The items of a list; the arguments of a call.
using List = std::vector<Value>;
/// Items by int32 keys.
using IntMap = std::map<std::int32_t, Value>;
/// Items by string keys.
using StringMap = std::map<std::string, Value>;
/// Fields of a record by name, in the order of the definition.
using Fields = std::vector<std::pair<std::string, Value>>;

/// Any C++ number, complex ones and bool included.
template <class T>
concept AnyNumber = !std::is_enum_v<T> && (std::integral<T> || std::floating_point<T> || Number<T>);

/// Any value of the protocol. Cheap to copy: copies share what does not change, so that they may be
/// used by several threads at once.
///
/// A received value is of the declared type. One that a program makes need not be: what it is given
/// to converts it (ValueType::convert). Large because each kind of value has functions of its own.
class Value {
 public:
  /// Null.
  Value() = default;
  /// A number, bool or complex number. Types that the protocol has not are kept as the next that
  /// holds them: `long long` as int64, `long double` as double.
  template <AnyNumber T>
  Value(T number) : kind_(Kind::number) {  // NOLINT: takes anything
    using N = typename Stored<T>::type;
    set_number(number_of<N>, static_cast<N>(number));
  }
  /// A string.
  Value(const char* text) : Value(std::string(text)) {}  // NOLINT
  /// A string.
  Value(std::string_view text) : Value(std::string(text)) {}  // NOLINT
  /// A string.
  Value(std::string text);  // NOLINT
  /// An array of numbers, whose items are shared.
  template <Number T>
  Value(Array<T> items) : Value(number_of<T>, &items, nullptr) {}  // NOLINT
  /// An array of numbers, which are copied.
  template <Number T>
  Value(const std::vector<T>& items) : Value(Array<T>(items)) {}  // NOLINT
  /// Throws rr::Error (invalid_argument) when there are not as many items as dims say.
  template <Number T>
  Value(MultiArray<T> array)  // NOLINT
      : Value(number_of<T>, &array.items, &array.dims) {}
  /// A list.
  Value(List items);  // NOLINT
  /// A map with int32 keys.
  Value(IntMap items);  // NOLINT
  /// A map with string keys.
  Value(StringMap items);  // NOLINT
  /// What is meant for a struct, pod or namedarray.
  static Value record(Fields fields);

  /// What it is.
  [[nodiscard]] Kind kind() const { return kind_; }
  /// Whether it is null.
  [[nodiscard]] bool is_null() const { return kind_ == Kind::null; }
  /// What it is: `double`, `int32[*]`, `com.robotraconteur.geometry.Vector3[]`; `null`, `list`,
  /// `map`, `fields` for what has no exact type.
  [[nodiscard]] std::string type_text() const;
  /// The same to work with; lists and maps as they are in a varvalue. None for null and `fields`.
  [[nodiscard]] ValueType type() const;
  /// The type of a number, an enum's value (int32), or an array's numbers; else void_.
  [[nodiscard]] ElementType number_type() const;

  // All of the following throw rr::Error: data_type_mismatch when the value is of another kind or
  // does not fit, out_of_range, key_not_found.

  /// A number, bool, complex number, enum value, or the one item of an array, as a T that holds it
  /// exactly (a float may round).
  template <AnyNumber T>
  [[nodiscard]] T as() const {
    typename Stored<T>::type number{};
    get_number(number_of<typename Stored<T>::type>, &number);
    return static_cast<T>(number);
  }
  /// A string; the name of an enum's value, or its number where it has none.
  [[nodiscard]] std::string text() const;
  /// Items of an array, list or map, fields of a record.
  [[nodiscard]] std::size_t size() const;
  /// An item of an array or list.
  [[nodiscard]] Value at(std::size_t index) const;
  /// A field of a record, or an item of a string map.
  [[nodiscard]] Value at(std::string_view name) const;
  /// An item of an int32 map.
  [[nodiscard]] Value at_key(std::int32_t key) const;
  /// Whether a record has this field, or a string map this key.
  [[nodiscard]] bool has(std::string_view name) const;
  /// As at(name).
  Value operator[](std::string_view name) const { return at(name); }
  /// The items of an array of exactly this type of numbers, or of a namedarray's numbers.
  template <Number T>
  [[nodiscard]] Array<T> array() const {
    Array<T> items;
    get_array(number_of<T>, &items);
    return items;
  }
  /// Of an array with dims; of one without, its length.
  [[nodiscard]] std::vector<std::uint32_t> dims() const;
  /// Whether it is an array with dimensions.
  [[nodiscard]] bool has_dims() const;
  /// The items of a list.
  [[nodiscard]] const List& list() const;
  /// The items of a map with int32 keys.
  [[nodiscard]] const IntMap& int_map() const;
  /// The items of a map with string keys.
  [[nodiscard]] const StringMap& string_map() const;
  /// The fields of a record.
  [[nodiscard]] Fields fields() const;
  /// Each item of an array, list or record in its order.
  [[nodiscard]] List items() const;

  /// JSON without a type (docs/howto/dynamic.md): what is written can be read back by a type only.
  [[nodiscard]] std::string to_json() const;
  /// Numbers, strings, lists and maps as JSON has them. Throws rr::Error (invalid_argument).
  static Value from_json(std::string_view json);

  /// Whether both are of the same kind, and have the same types and the same content; a NaN is
  /// equal to itself.
  friend bool operator==(const Value& a, const Value& b) { return a.is_same_as(b); }

  /// For the runtime: a value of its parts. `bits` is the number, `content` what does not fit into
  /// it.
  Value(Kind kind, ElementType number, const void* bits, std::shared_ptr<const Content> content);
  /// For the runtime: the number, as it lies in memory.
  [[nodiscard]] const void* bits() const { return bits_.data(); }
  /// For the runtime: texts, items and fields; null for none.
  [[nodiscard]] const std::shared_ptr<const Content>& content() const { return content_; }

 private:
  // Plain C++ types that no number of the protocol is, as `long long`, and those that are.
  template <class T>
  struct Stored {
    using type = T;
  };
  template <class T>
  requires(std::integral<T> && !Number<T>) struct Stored<T> {
    using type =
        std::conditional_t<std::is_signed_v<T>,
                           std::conditional_t<sizeof(T) == 8, std::int64_t, std::int32_t>,
                           std::conditional_t<sizeof(T) == 8, std::uint64_t, std::uint32_t>>;
  };
  template <class T>
  requires(std::floating_point<T> && !Number<T>) struct Stored<T> {
    using type = double;
  };

  // `items` is an Array, `dims` a vector, or null.
  Value(ElementType number, const void* items, const std::vector<std::uint32_t>* dims);
  template <class N>
  void set_number(ElementType type, N number) {
    static_assert(sizeof(N) <= sizeof(bits_));
    number_ = type;
    std::memcpy(bits_.data(), &number, sizeof number);
  }
  [[nodiscard]] bool is_same_as(const Value& other) const;
  void get_number(ElementType type, void* number) const;
  void get_array(ElementType type, void* array) const;

  Kind kind_ = Kind::null;
  ElementType number_ = ElementType::void_;
  alignas(8) std::array<std::byte, 16> bits_{};
  std::shared_ptr<const Content> content_;
};

}  // namespace dynamic
}  // namespace rr
