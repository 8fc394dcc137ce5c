// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "rr/type_of.hpp"
#include "rr/visibility.hpp"

/// What may be null, and the containers.
namespace RR_VISIBLE rr {

/// Like std::optional, but on the heap, so that a struct may contain itself. Copies are deep. `T`
/// may be incomplete where a Recursive<T> is declared.
template <class T>
class Recursive {
 public:
  /// The type of the value.
  using value_type = T;

  /// No value.
  Recursive() noexcept = default;
  /// No value.
  Recursive(std::nullopt_t) noexcept {}  // NOLINT
  /// Copies the value.
  Recursive(const T& value) : value_(std::make_unique<T>(value)) {}  // NOLINT
  /// Takes over the value.
  Recursive(T&& value) : value_(std::make_unique<T>(std::move(value))) {}  // NOLINT
  /// Copies the value, if there is one.
  Recursive(const Recursive& other) { *this = other; }
  /// Takes over the value; `other` has none afterwards.
  Recursive(Recursive&& other) noexcept = default;
  /// Copies the value, if there is one. What was here is destroyed.
  Recursive& operator=(const Recursive& other) {
    if (this == &other) return *this;
    std::unique_ptr<T> copy = other.value_ ? std::make_unique<T>(*other.value_) : nullptr;
    value_ = std::move(copy);
    return *this;
  }
  /// Takes over the value; `other` has none afterwards.
  Recursive& operator=(Recursive&& other) noexcept = default;
  ~Recursive() = default;

  /// Whether there is a value.
  [[nodiscard]] bool has_value() const noexcept { return value_ != nullptr; }
  /// Whether there is a value.
  explicit operator bool() const noexcept { return value_ != nullptr; }
  /// The value, which must be there.
  T& operator*() noexcept { return *value_; }
  /// The value, which must be there.
  const T& operator*() const noexcept { return *value_; }
  /// The value, which must be there.
  T* operator->() noexcept { return value_.get(); }
  /// The value, which must be there.
  const T* operator->() const noexcept { return value_.get(); }
  /// Throws std::bad_optional_access.
  T& value() {
    if (!value_) throw std::bad_optional_access();
    return *value_;
  }
  /// Throws std::bad_optional_access.
  const T& value() const {
    if (!value_) throw std::bad_optional_access();
    return *value_;
  }
  /// Makes a value of these arguments in place of what was here.
  template <class... Arguments>
  T& emplace(Arguments&&... arguments) {
    value_ = std::make_unique<T>(std::forward<Arguments>(arguments)...);
    return *value_;
  }
  /// Destroys the value: none is left.
  void reset() noexcept { value_.reset(); }

  /// Whether both have no value, or equal ones.
  friend bool operator==(const Recursive& a, const Recursive& b) {
    if (!a || !b) return a.has_value() == b.has_value();
    return *a == *b;
  }

 private:
  std::unique_ptr<T> value_;
};

/// What the runtime does with a std::optional<T> or Recursive<T>.
struct NullableOperations {
  const void* (*get)(const void* nullable);  ///< null when it has no value
  void* (*engage)(void* nullable);           ///< the value, made when there is none
  void (*reset)(void* nullable);             ///< takes the value away
};
/// For generated code: how N, a std::optional or Recursive, is used.
template <class N>
inline constexpr NullableOperations nullable_operations{
    [](const void* nullable) -> const void* {
      const N& self = *static_cast<const N*>(nullable);
      return self.has_value() ? &*self : nullptr;
    },
    [](void* nullable) -> void* {
      N& self = *static_cast<N*>(nullable);
      return self.has_value() ? &*self : &self.emplace();
    },
    [](void* nullable) { static_cast<N*>(nullable)->reset(); },
};

/// A struct or container that may be null.
class NullableType final : public Type {
 public:
  /// A `value` that may be null, reached by `operations`. Both must outlive this.
  constexpr NullableType(const Type& value, const NullableOperations& operations)
      : value_(&value), operations_(&operations) {}

  [[nodiscard]] ElementType element_type() const override { return value_->element_type(); }
  void write(Writer& writer, const ElementName& name, const void* value) const override;
  bool read(Decoder& decoder, const Element& element, void* value) const override;

 private:
  const Type* value_;
  const NullableOperations* operations_;
};

/// What the runtime does with a std::vector<X>. All null for std::vector<bool>, whose items have no
/// addresses.
struct ListOperations {
  std::size_t item_size;                          ///< bytes
  std::size_t (*size)(const void* list);          ///< number of items
  const void* (*items)(const void* list);         ///< the first item
  void* (*resize)(void* list, std::size_t size);  ///< returns the items
};
/// For generated code: how a std::vector<X> is used.
template <class X>
inline constexpr ListOperations list_operations{
    sizeof(X),
    [](const void* list) { return static_cast<const std::vector<X>*>(list)->size(); },
    [](const void* list) -> const void* {
      return static_cast<const std::vector<X>*>(list)->data();
    },
    [](void* list, std::size_t size) -> void* {
      auto& self = *static_cast<std::vector<X>*>(list);
      self.resize(size);
      return self.data();
    },
};
/// For generated code: ListType has functions of its own for std::vector<bool>.
template <>
inline constexpr ListOperations list_operations<bool>{0, nullptr, nullptr, nullptr};

/// std::vector<X> (03, section 7).
class ListType final : public Type {
 public:
  /// A list of `item`, reached by `operations`. Both must outlive this.
  constexpr ListType(const Type& item, const ListOperations& operations)
      : item_(&item), operations_(&operations) {}

  [[nodiscard]] ElementType element_type() const override { return ElementType::list; }
  void write(Writer& writer, const ElementName& name, const void* value) const override;
  bool read(Decoder& decoder, const Element& element, void* value) const override;

 private:
  void write_bools(Writer& writer, const ElementName& name, const std::vector<bool>& list) const;
  bool read_bools(Decoder& decoder, const Element& element, std::vector<bool>& list) const;

  const Type* item_;
  const ListOperations* operations_;
};

/// What the runtime does with a std::map<K, X>.
struct MapOperations {
  /// Calls `visit` for each item, last key first.
  struct Visitor {
    /// For each item of an int32 map.
    virtual void visit(std::int32_t key, const void* item) = 0;
    /// For each item of a string map.
    virtual void visit(const std::string& key, const void* item) = 0;

   protected:
    ~Visitor() = default;
  };
  std::size_t item_size;                             ///< bytes of an item with its key
  std::size_t (*size)(const void* map);              ///< number of items
  void (*visit)(const void* map, Visitor& visitor);  ///< calls the visitor for each item
  void (*clear)(void* map);                          ///< removes all items
  /// Adds an item with this key and returns it; null when there is one already. One of the two.
  void* (*add_number)(void* map, std::int32_t key);
  /// The same for string maps.
  void* (*add_text)(void* map, std::string_view key);
};
/// For MapOperations: adds an item with this key and returns it; null when there is one already.
template <class Map>
void* add_to_map(void* map, typename Map::key_type&& key) {
  auto& self = *static_cast<Map*>(map);
  const std::size_t size = self.size();
  const auto item = self.try_emplace(self.end(), std::move(key));  // mostly ascending
  return self.size() != size ? &item->second : nullptr;
}
/// For generated code: how a std::map<K, X> is used.
template <class K, class X>
constexpr MapOperations make_map_operations() {
  using Map = std::map<K, X>;
  MapOperations operations{sizeof(typename Map::value_type),
                           [](const void* map) { return static_cast<const Map*>(map)->size(); },
                           [](const void* map, MapOperations::Visitor& visitor) {
                             const Map& self = *static_cast<const Map*>(map);
                             for (auto item = self.end(); item != self.begin();) {
                               --item;
                               visitor.visit(item->first, &item->second);
                             }
                           },
                           [](void* map) { static_cast<Map*>(map)->clear(); },
                           nullptr,
                           nullptr};
  if constexpr (std::is_same_v<K, std::int32_t>) {
    operations.add_number = [](void* map, std::int32_t key) {
      return add_to_map<Map>(map, std::move(key));
    };
  } else {
    operations.add_text = [](void* map, std::string_view key) {
      return add_to_map<Map>(map, std::string(key));
    };
  }
  return operations;
}
/// For generated code: how a std::map<K, X> is used.
template <class K, class X>
inline constexpr MapOperations map_operations = make_map_operations<K, X>();

/// std::map<std::int32_t, X> and std::map<std::string, X> (03, section 7).
class MapType final : public Type {
 public:
  /// A map to `item`, reached by `operations`, which travels as `element_type`: vector for int32
  /// keys, dictionary for string keys. Both must outlive this.
  constexpr MapType(ElementType element_type, const Type& item, const MapOperations& operations)
      : item_(&item), operations_(&operations), element_type_(element_type) {}

  [[nodiscard]] ElementType element_type() const override { return element_type_; }
  void write(Writer& writer, const ElementName& name, const void* value) const override;
  bool read(Decoder& decoder, const Element& element, void* value) const override;

 private:
  const Type* item_;
  const MapOperations* operations_;
  ElementType element_type_;
};

/// For generated code: how a std::optional<T> travels.
template <class T>
inline constexpr NullableType optional_type{type_of<T>, nullable_operations<std::optional<T>>};
/// For generated code: how a Recursive<T> travels.
template <class T>
inline constexpr NullableType recursive_type{type_of<T>, nullable_operations<Recursive<T>>};
/// For generated code: how a std::vector<X> travels.
template <class X>
inline constexpr ListType list_type{type_of<X>, list_operations<X>};
/// For generated code: how a map with int32 keys travels.
template <class X>
inline constexpr MapType int_map_type{ElementType::vector, type_of<X>,
                                      map_operations<std::int32_t, X>};
/// For generated code: how a map with string keys travels.
template <class X>
inline constexpr MapType string_map_type{ElementType::dictionary, type_of<X>,
                                         map_operations<std::string, X>};

/// A struct or container that may be null. Generated code names std::optional of structs and
/// containers; the plain ones are what a varvalue may hold.
template <class T>
inline constexpr const Type& type_of<std::optional<T>> = optional_type<T>;
/// A struct that may be null and may contain itself.
template <class T>
inline constexpr const Type& type_of<Recursive<T>> = recursive_type<T>;
/// `X{list}`, as it is in a varvalue.
template <class X>
inline constexpr const Type& type_of<std::vector<X>> = list_type<X>;
/// `X{int32}`, as it is in a varvalue.
template <class X>
inline constexpr const Type& type_of<std::map<std::int32_t, X>> = int_map_type<X>;
/// `X{string}`, as it is in a varvalue.
template <class X>
inline constexpr const Type& type_of<std::map<std::string, X>> = string_map_type<X>;

}  // namespace rr
