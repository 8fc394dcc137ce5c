// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <new>
#include <span>
#include <string_view>
#include <type_traits>

#include "rr/array_type.hpp"
#include "rr/type_of.hpp"
#include "rr/visibility.hpp"

/// Structs, pods and namedarrays of a definition.
namespace RR_VISIBLE rr {

/// How values are made and ended whose C++ type is known at run time only.
struct ValueOperations {
  std::size_t size;                ///< bytes
  void (*construct)(void* place);  ///< as T(), where there is room for it
  void (*destroy)(void* value);    ///< as ~T()
};
/// For generated code: how a T is made and ended.
template <class T>
inline constexpr ValueOperations value_operations{
    sizeof(T),
    [](void* place) { ::new (place) T(); },
    [](void* value) { static_cast<T*>(value)->~T(); },
};

/// One field of a struct or pod: name, place, type. Made with field<T>().
struct Field {
  std::string_view name;  ///< as in the definition
  std::uint32_t offset;   ///< in the C++ type, in bytes
  Shortcut shortcut;      ///< how it is read and written without a virtual call
  const Type* type;       ///< how it travels
  ScalarPrefix prefix;    ///< empty unless the type is a number, a string, or an array of numbers
};

/// Describes a field: `rr::field<double>("pan", offsetof(Angles, pan))`. `T` is what type_of is
/// asked for: the field's C++ type, or FixedLength and the like where that does not say all.
template <class T>
consteval Field field(std::string_view name, std::size_t offset) {
  return {.name = name,
          .offset = static_cast<std::uint32_t>(offset),
          .shortcut = shortcut_of<T>,
          .type = &type_of<T>,
          .prefix = ScalarPrefix(name, packed_type_of<T>)};
}

/// What a record is: a struct (`struct_`), a `pod`, or a `namedarray`.
enum class RecordKind : std::uint8_t { struct_, pod, namedarray };

/// What the runtime does with a record's C++ type, and how its arrays are described. The latter are
/// null for structs, which are in no arrays.
struct RecordOperations {
  const ValueOperations* value;              ///< how one is made
  const Type* array;                         ///< how an Array of them travels
  const ValueOperations* array_value;        ///< how that is made
  const Type* multi_array;                   ///< how a MultiArray of them travels
  const ValueOperations* multi_array_value;  ///< how that is made
  /// How `value` travels where a varvalue holds a struct; null when the record itself knows.
  const Type* held_type = nullptr;
};
/// For generated code: the RecordOperations of a T.
template <class T>
constexpr RecordOperations make_record_operations() {
  // A struct without strings, arrays and the like looks like a pod here; that does no harm.
  if constexpr (std::is_trivially_copyable_v<T>) {
    return {&value_operations<T>,
            &type_of<Array<T>>,
            &value_operations<Array<T>>,
            &type_of<MultiArray<T>>,
            &value_operations<MultiArray<T>>,
            nullptr};
  } else {
    return {&value_operations<T>, nullptr, nullptr, nullptr, nullptr, nullptr};
  }
}
/// For generated code: what the runtime does with a T.
template <class T>
inline constexpr RecordOperations record_operations = make_record_operations<T>();

/// A struct, pod or namedarray of a definition. Generated code declares one constant each in the
/// header, names it as the type's description, and defines it in the source:
///
///   namespace experimental::mount {
///   extern const ::rr::RecordType rr_Angles;
///   }
///   template <>
///   inline constexpr const ::rr::Type& rr::type_of<::experimental::mount::Angles> =
///       ::experimental::mount::rr_Angles;
///
///   // offsetof is asked for structs that hold maps, which have no standard layout.
///   #pragma GCC diagnostic ignored "-Winvalid-offsetof"
///   constexpr ::rr::Field angles_fields[] = {
///       ::rr::field<double>("pan", offsetof(Angles, pan)),
///       ::rr::field<std::optional<std::map<std::string, double>>>("m", offsetof(Angles, m)),
///   };
///   constinit const ::rr::RecordType rr_Angles{::rr::RecordKind::struct_,
///                                              "experimental.mount.Angles", angles_fields,
///                                              ::rr::record_operations<Angles>};
///
/// The type needs a default constructor. A pod stores everything in place (never
/// Array or MultiArray) and is trivially copyable. A namedarray has no fields here; its numbers are
/// the object itself:
///
///   constinit const ::rr::RecordType rr_Vector3{"experimental.mount.Vector3",
///                                               ::rr::ElementType::double_, 3,
///                                               ::rr::record_operations<Vector3>};
class RecordType final : public Type {
 public:
  /// A struct or pod.
  constexpr RecordType(RecordKind kind, std::string_view name, std::span<const Field> fields,
                       const RecordOperations& operations)
      : name_(name), fields_(fields), operations_(&operations), kind_(kind) {}
  /// A namedarray of `number_count` numbers.
  constexpr RecordType(std::string_view name, ElementType number_type, std::uint32_t number_count,
                       const RecordOperations& operations)
      : name_(name),
        operations_(&operations),
        number_count_(number_count),
        number_type_(number_type),
        kind_(RecordKind::namedarray) {}

  /// `<service>.<name>`.
  [[nodiscard]] std::string_view name() const { return name_; }
  /// What it is.
  [[nodiscard]] RecordKind kind() const { return kind_; }
  /// In the order of the definition; none of a namedarray.
  [[nodiscard]] std::span<const Field> fields() const { return fields_; }
  /// What the runtime does with its C++ type.
  [[nodiscard]] const RecordOperations& operations() const { return *operations_; }
  /// Of a namedarray: the type of its numbers, and how many there are.
  [[nodiscard]] ElementType number_type() const { return number_type_; }
  /// Of a namedarray: how many numbers it has.
  [[nodiscard]] std::uint32_t number_count() const { return number_count_; }

  [[nodiscard]] ElementType element_type() const override;
  void write(Writer& writer, const ElementName& name, const void* value) const override;
  bool read(Decoder& decoder, const Element& element, void* value) const override;

  /// The fields alone, as the nested elements of a struct or of a pod's item.
  void write_fields(Writer& writer, const void* value) const;
  /// Reads the fields from nested elements. False when the decoder has failed.
  bool read_fields(Decoder& decoder, const Element& element, void* value) const;

 private:
  bool read_struct(Decoder& decoder, const Element& element, void* value) const;

  std::string_view name_;
  std::span<const Field> fields_;
  const RecordOperations* operations_;
  std::uint32_t number_count_ = 0;
  ElementType number_type_ = ElementType::void_;
  RecordKind kind_;
};

/// The numbers of a namedarray, in their order on the wire: the same memory as its fields.
/// `rr::numbers<double>(vector3)` is a span of three.
template <Number N, class T>
auto numbers(T& namedarray) {
  using Item = std::conditional_t<std::is_const_v<T>, const N, N>;
  static_assert(std::is_trivially_copyable_v<T> && sizeof(T) % sizeof(N) == 0);
  return std::span<Item, sizeof(T) / sizeof(N)>(reinterpret_cast<Item*>(&namedarray),
                                                sizeof(T) / sizeof(N));
}

}  // namespace rr
