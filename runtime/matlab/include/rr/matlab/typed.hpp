// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mex.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "rr/array.hpp"
#include "rr/complex.hpp"
#include "rr/matlab/containers.hpp"
#include "rr/matlab/numbers.hpp"
#include "rr/matlab/text.hpp"
#include "rr/type.hpp"

/// Values of the C++ types that are generated for a definition, in the interpreter: the table of
/// docs/howto/matlab.md for types that are known when the MEX file is built. What is made is what
/// the dynamic object makes. What is read are the forms that a program writes when speed counts:
/// the right shape, fields without gaps. For other forms Misfit is thrown, and the dynamic object
/// decides. Varvalues are left to it, too. For the interpreter's thread.
namespace rr::matlab {

/// A field of a struct, pod or namedarray, by name and place.
template <class Record, class Value>
struct FieldPlace {
  const char* name;
  Value Record::*place;
};
template <class Record, class Value>
constexpr FieldPlace<Record, Value> field(const char* name, Value Record::*place) {
  return {name, place};
}

/// The fields of a record: `list`, a tuple of FieldPlace. Specialized in generated headers.
template <class Record>
struct Fields;

template <class T>
concept NamedArray = requires(T& value) {
  value.rr_numbers();
};

/// How a T is made for and read from the interpreter.
template <class T>
struct Typed;

template <class T>
mxArray* make_typed(const T& value) {
  return Typed<T>::make(value);
}
/// Throws Misfit.
template <class T>
void read_typed(const mxArray* given, T& value) {
  Typed<T>::read(given, value);
}

[[noreturn]] inline void refuse_form() { throw Misfit("another form than the usual one"); }
inline void need_form(bool is_usual) {
  if (!is_usual) refuse_form();
}

template <Number T>
struct Typed<T> {
  static mxArray* make(const T& value) { return make_number<T>(value); }
  static void read(const mxArray* given, T& value) { value = read_number<T>(given); }
};

template <class T>
requires std::is_enum_v<T>
struct Typed<T> {
  static mxArray* make(const T& value) {
    return make_number<std::int32_t>(static_cast<std::int32_t>(value));
  }
  static void read(const mxArray* given, T& value) {
    value = static_cast<T>(read_number<std::int32_t>(given));
  }
};

template <>
struct Typed<std::string> {
  static mxArray* make(const std::string& value) { return make_text(value); }
  static void read(const mxArray* given, std::string& value) { value = read_text(given); }
};

// Structs and pods.
template <class T>
requires requires { Fields<T>::list; } &&(!NamedArray<T>)struct Typed<T> {
  static constexpr std::size_t field_count = std::tuple_size_v<decltype(Fields<T>::list)>;

  /// Names of the fields; the last one is null.
  static std::array<const char*, field_count + 1> names() {
    return std::apply(
        [](const auto&... field) {
          return std::array<const char*, field_count + 1>{field.name..., nullptr};
        },
        Fields<T>::list);
  }
  /// The elements of a struct array of these sizes.
  static mxArray* make_array(const Dims& dims) {
    auto names = Typed::names();
    return mxCreateStructArray(static_cast<mwSize>(dims.size()), dims.data(),
                               static_cast<int>(field_count), names.data());
  }
  static void fill(mxArray* records, std::size_t index, const T& value) {
    int number = 0;
    std::apply(
        [&](const auto&... field) {
          (mxSetFieldByNumber(records, static_cast<mwIndex>(index), number++,
                              make_typed(value.*field.place)),
           ...);
        },
        Fields<T>::list);
  }
  static mxArray* make(const T& value) {
    mxArray* const record = make_array({1, 1});
    fill(record, 0, value);
    return record;
  }

  static void check_fields(const mxArray* given) {
    need_form(mxIsStruct(given) &&
              static_cast<std::size_t>(mxGetNumberOfFields(given)) == field_count);
  }
  static void read_item(const mxArray* given, std::size_t index, T& value) {
    std::apply(
        [&](const auto&... field) {
          (read_typed(read_field(given, field.name, index), value.*field.place), ...);
        },
        Fields<T>::list);
  }
  static void read(const mxArray* given, T& value) {
    check_fields(given);
    need_form(count_of(given) == 1);
    read_item(given, 0, value);
  }
};

template <NamedArray T>
struct Typed<T> {
  using Numbers = decltype(std::declval<T&>().rr_numbers());
  using Item = typename Numbers::value_type;
  static constexpr std::size_t count = sizeof(T) / sizeof(Item);

  static mxArray* make(const T& value) { return make_column<Item>(value.rr_numbers()); }
  static void read(const mxArray* given, T& value) {
    need_form(is_numeric(given) && is_vector(given) && count_of(given) == count);
    read_numbers<Item>(given, value.rr_numbers().data());
  }
};

/// What may be null.
template <class Nullable>
struct TypedNullable {
  using Value = typename Nullable::value_type;
  static mxArray* make(const Nullable& value) {
    return value.has_value() ? make_typed<Value>(*value) : make_null();
  }
  static void read(const mxArray* given, Nullable& value) {
    if (is_null(given)) {
      value.reset();
    } else {
      read_typed<Value>(given, value.emplace());
    }
  }
};
template <class T>
struct Typed<std::optional<T>> : TypedNullable<std::optional<T>> {};
template <class T>
struct Typed<Recursive<T>> : TypedNullable<Recursive<T>> {};

template <class X>
struct Typed<std::vector<X>> {
  static mxArray* make(const std::vector<X>& value) {
    std::vector<mxArray*> items;
    items.reserve(value.size());
    for (const X& item : value) items.push_back(make_typed<X>(item));
    return make_cells(items);
  }
  static void read(const mxArray* given, std::vector<X>& value) {
    const std::vector<const mxArray*> cells = read_cells(given);
    value.clear();
    for (const mxArray* const cell : cells) {
      X item{};
      read_typed<X>(cell, item);
      value.push_back(std::move(item));
    }
  }
};

template <class K, class X>
struct Typed<std::map<K, X>> {
  static constexpr bool has_text_keys = std::is_same_v<K, std::string>;

  static mxArray* make(const std::map<K, X>& value) {
    std::map<K, mxArray*> items;
    for (const auto& [key, item] : value) {
      items.emplace_hint(items.end(), key, make_typed<X>(item));
    }
    return make_map(items);
  }
  static void read(const mxArray* given, std::map<K, X>& value) {
    need_form(is_map(given));
    value.clear();
    for (const auto& [key, item] : read_map(given)) {
      need_form(mxIsChar(key) == has_text_keys);
      if constexpr (has_text_keys) {
        read_typed<X>(item, value[read_text(key)]);
      } else {
        read_typed<X>(item, value[read_number<std::int32_t>(key)]);
      }
    }
  }
};

}  // namespace rr::matlab

#include "rr/matlab/typed_arrays.hpp"  // IWYU pragma: export
