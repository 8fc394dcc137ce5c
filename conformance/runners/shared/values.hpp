// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <rr/complex.hpp>
#include <rr/definition.hpp>
#include <rr/error.hpp>
#include <rr/varvalue.hpp>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "conformance/harness/json.hpp"
#include "conformance/harness/numbers.hpp"

/// Typed values from and to the JSON notation of the captures. Generated adapters add the types of
/// a definition: a specialization of Notation for each struct, pod and namedarray.
namespace rr::conformance {

class Adapters;

template <class T>
struct Notation;

template <class T>
void from_json(const Adapters& adapters, const Json& json, T& value) {
  Notation<T>::read(adapters, json, value);
}
template <class T>
Json to_json(const Adapters& adapters, const T& value) {
  return Notation<T>::write(adapters, value);
}

/// Reads a new value.
template <class T>
T made_from_json(const Adapters& adapters, const Json& json) {
  T value{};
  from_json(adapters, json, value);
  return value;
}

template <Number T>
struct Notation<T> {
  static void read(const Adapters&, const Json& json, T& value) {
    if constexpr (std::is_same_v<T, bool>) {
      value = json.get<bool>();
    } else if constexpr (std::is_same_v<T, double>) {
      value = double_of_json(json);
    } else if constexpr (std::is_same_v<T, float>) {
      value = single_of_json(json);
    } else if constexpr (std::is_same_v<T, std::complex<double>>) {
      value = {double_of_json(json.at(0)), double_of_json(json.at(1))};
    } else if constexpr (std::is_same_v<T, std::complex<float>>) {
      value = {single_of_json(json.at(0)), single_of_json(json.at(1))};
    } else {
      value = integer_of_json<T>(json);
    }
  }
  static Json write(const Adapters&, const T& value) {
    return json_of_numbers(number_of<T>, std::as_bytes(std::span(&value, 1))).at(0);
  }
};

template <class T>
requires std::is_enum_v<T>
struct Notation<T> {
  static void read(const Adapters&, const Json& json, T& value) {
    value = static_cast<T>(integer_of_json<std::int32_t>(json));
  }
  static Json write(const Adapters&, const T& value) { return static_cast<std::int32_t>(value); }
};

template <>
struct Notation<std::string> {
  static void read(const Adapters&, const Json& json, std::string& value) { json.get_to(value); }
  static Json write(const Adapters&, const std::string& value) { return value; }
};

/// What may be null: std::optional, Recursive.
template <class Nullable, class T>
struct NullableNotation {
  static void read(const Adapters& adapters, const Json& json, Nullable& value) {
    value = Nullable();
    if (!json.is_null()) value = made_from_json<T>(adapters, json);
  }
  static Json write(const Adapters& adapters, const Nullable& value) {
    return value ? to_json(adapters, *value) : Json();
  }
};
template <class T>
struct Notation<std::optional<T>> : NullableNotation<std::optional<T>, T> {};
template <class T>
struct Notation<Recursive<T>> : NullableNotation<Recursive<T>, T> {};

template <class Items>
Json list_to_json(const Adapters& adapters, const Items& items) {
  Json list = Json::array();
  for (const auto& item : items) list.push_back(to_json(adapters, item));
  return list;
}
template <class T>
std::vector<T> list_from_json(const Adapters& adapters, const Json& json) {
  if (!json.is_array()) throw std::runtime_error("not a list: " + json.dump().substr(0, 60));
  std::vector<T> items;
  for (const Json& item : json) items.push_back(made_from_json<T>(adapters, item));
  return items;
}

template <class T>
struct Notation<std::vector<T>> {
  static void read(const Adapters& adapters, const Json& json, std::vector<T>& value) {
    value = list_from_json<T>(adapters, json);
  }
  static Json write(const Adapters& adapters, const std::vector<T>& value) {
    Json list = Json::array();
    for (std::size_t i = 0; i < value.size(); ++i) {
      list.push_back(to_json<T>(adapters, value[i]));
    }
    return list;
  }
};

template <class K, class T>
struct Notation<std::map<K, T>> {
  static void read(const Adapters& adapters, const Json& json, std::map<K, T>& value) {
    value.clear();
    for (const Json& item : json) {
      value.try_emplace(made_from_json<K>(adapters, item.at(0)),
                        made_from_json<T>(adapters, item.at(1)));
    }
  }
  static Json write(const Adapters& adapters, const std::map<K, T>& value) {
    Json list = Json::array();
    for (const auto& [key, item] : value) {
      list.push_back({to_json(adapters, key), to_json(adapters, item)});
    }
    return list;
  }
};

/// A value of the right kind that the C++ type cannot hold; the runtime would refuse to send it.
[[noreturn]] inline void refuse_value(const std::string& why) {
  throw Error(ErrorCode::data_type_error, why);
}

template <class T>
struct Notation<Array<T>> {
  static void read(const Adapters& adapters, const Json& json, Array<T>& value) {
    Array<T> items(json.size());
    const std::span<T> places = items.mutate();
    if (!json.is_array()) throw std::runtime_error("not a list: " + json.dump().substr(0, 60));
    for (std::size_t i = 0; i < places.size(); ++i) from_json(adapters, json[i], places[i]);
    value = std::move(items);
  }
  static Json write(const Adapters& adapters, const Array<T>& value) {
    return list_to_json(adapters, value);
  }
};

template <class T, std::size_t Length>
struct Notation<std::array<T, Length>> {
  static void read(const Adapters& adapters, const Json& json, std::array<T, Length>& value) {
    if (json.size() != Length) refuse_value("not " + std::to_string(Length) + " items");
    for (std::size_t i = 0; i < Length; ++i) from_json(adapters, json.at(i), value[i]);
  }
  static Json write(const Adapters& adapters, const std::array<T, Length>& value) {
    return list_to_json(adapters, value);
  }
};

template <class T, std::size_t Maximum>
struct Notation<BoundedArray<T, Maximum>> {
  static void read(const Adapters& adapters, const Json& json, BoundedArray<T, Maximum>& value) {
    if (json.size() > Maximum) refuse_value("more than " + std::to_string(Maximum) + " items");
    value.resize(json.size());
    for (std::size_t i = 0; i < value.size(); ++i) from_json(adapters, json.at(i), value[i]);
  }
  static Json write(const Adapters& adapters, const BoundedArray<T, Maximum>& value) {
    return list_to_json(adapters, value);
  }
};

template <class T>
struct Notation<MultiArray<T>> {
  static void read(const Adapters& adapters, const Json& json, MultiArray<T>& value) {
    from_json(adapters, json.at("dims"), value.dims);
    from_json(adapters, json.at("array"), value.items);
  }
  static Json write(const Adapters& adapters, const MultiArray<T>& value) {
    return {{"dims", value.dims}, {"array", to_json(adapters, value.items)}};
  }
};

template <class T, std::size_t... Dims>
struct Notation<FixedMultiArray<T, Dims...>> {
  using Shaped = FixedMultiArray<T, Dims...>;
  static void read(const Adapters& adapters, const Json& json, Shaped& value) {
    if (json.at("dims") != Json(Shaped::dims)) refuse_value("another shape");
    from_json(adapters, json.at("array"), value.items);
  }
  static Json write(const Adapters& adapters, const Shaped& value) {
    return {{"dims", Shaped::dims}, {"array", to_json(adapters, value.items)}};
  }
};

/// One namedarray is the flat list of its numbers.
template <class Number, class T>
void numbers_from_json(const Adapters& adapters, const Json& json, T& value) {
  const auto places = numbers<Number>(value);
  if (json.size() != places.size()) refuse_value("another count of numbers");
  for (std::size_t i = 0; i < places.size(); ++i) from_json(adapters, json.at(i), places[i]);
}
template <class Number, class T>
Json numbers_to_json(const Adapters& adapters, const T& value) {
  return list_to_json(adapters, numbers<Number>(value));
}

/// {type, value}, or null.
template <>
struct Notation<VarValue> {
  static void read(const Adapters& adapters, const Json& json, VarValue& value);
  static Json write(const Adapters& adapters, const VarValue& value);
};

}  // namespace rr::conformance
