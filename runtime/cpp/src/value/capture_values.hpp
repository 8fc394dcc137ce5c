// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <complex>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <type_traits>

#include "runtime/cpp/src/value/conformance_types.hpp"

/// Values from the notation of the captures (README of conformance/captures), for tests.
namespace conformance::types {

using nlohmann::json;

template <class V>
void visit_fields(Vector3& value, V&& visit) {
  visit("x", value.x);
  visit("y", value.y);
  visit("z", value.z);
}
template <class V>
void visit_fields(Transform& value, V&& visit) {
  visit("rotation", value.rotation);
  visit("translation", value.translation);
}
template <class V>
void visit_fields(Twist& value, V&& visit) {
  visit("angular", value.angular);
  visit("linear", value.linear);
}
template <class V>
void visit_fields(Pixel& value, V&& visit) {
  visit("red", value.red);
  visit("green", value.green);
  visit("blue", value.blue);
}
template <class V>
void visit_fields(Ticks& value, V&& visit) {
  visit("first", value.first);
  visit("second", value.second);
}
template <class V>
void visit_fields(Knots& value, V&& visit) {
  visit("inner", value.inner);
  visit("last", value.last);
}
template <class V>
void visit_fields(Sample& value, V&& visit) {
  visit("seq", value.seq);
  visit("stamp", value.stamp);
  visit("accel", value.accel);
}
template <class V>
void visit_fields(Reading& value, V&& visit) {
  visit("kind", value.kind);
  visit("valid", value.valid);
  visit("payload", value.payload);
  visit("gain", value.gain);
  visit("head", value.head);
  visit("pair", value.pair);
  visit("tail", value.tail);
  visit("origin", value.origin);
  visit("base", value.base);
  visit("path", value.path);
  visit("block", value.block);
}
template <class V>
void visit_fields(Counter& value, V&& visit) {
  visit("up", value.up);
  visit("down", value.down);
  visit("trim", value.trim);
  visit("mask", value.mask);
}
template <class V>
void visit_fields(Stats& value, V&& visit) {
  visit("count", value.count);
  visit("mean", value.mean);
  visit("label", value.label);
}
template <class V>
void visit_fields(Leaf& value, V&& visit) {
  visit("name", value.name);
  visit("mode", value.mode);
  visit("stats", value.stats);
}
template <class V>
void visit_fields(Tree& value, V&& visit) {
  visit("name", value.name);
  visit("main", value.main);
  visit("leaves", value.leaves);
  visit("by_name", value.by_name);
  visit("child", value.child);
  visit("extra", value.extra);
}
template <class V>
void visit_fields(Everything& value, V&& visit) {
  visit("v_double", value.v_double);
  visit("v_single", value.v_single);
  visit("v_int8", value.v_int8);
  visit("v_uint8", value.v_uint8);
  visit("v_int16", value.v_int16);
  visit("v_uint16", value.v_uint16);
  visit("v_int32", value.v_int32);
  visit("v_uint32", value.v_uint32);
  visit("v_int64", value.v_int64);
  visit("v_uint64", value.v_uint64);
  visit("v_bool", value.v_bool);
  visit("v_cdouble", value.v_cdouble);
  visit("v_csingle", value.v_csingle);
  visit("v_string", value.v_string);
  visit("v_mode", value.v_mode);
  visit("a_double", value.a_double);
  visit("a_fixed", value.a_fixed);
  visit("a_max", value.a_max);
  visit("m_single", value.m_single);
  visit("m_fixed", value.m_fixed);
  visit("l_double", value.l_double);
  visit("i_string", value.i_string);
  visit("s_array", value.s_array);
  visit("l_mode", value.l_mode);
  visit("s_stats", value.s_stats);
  visit("l_stats", value.l_stats);
  visit("p_sample", value.p_sample);
  visit("p_samples", value.p_samples);
  visit("p_grid", value.p_grid);
  visit("p_map", value.p_map);
  visit("n_point", value.n_point);
  visit("n_points", value.n_points);
  visit("n_grid", value.n_grid);
  visit("n_list", value.n_list);
  visit("any", value.any);
  visit("l_any", value.l_any);
  visit("s_any", value.s_any);
}
template <class V>
void visit_fields(Quaternion& value, V&& visit) {
  visit("w", value.w);
  visit("x", value.x);
  visit("y", value.y);
  visit("z", value.z);
}

// Numbers.

template <class T>
T number_from(const json& from) {
  if (from.is_string()) {
    const std::string text = from;
    if constexpr (std::is_floating_point_v<T>) {
      if (text == "NaN") return std::numeric_limits<T>::quiet_NaN();
      if (text == "Infinity") return std::numeric_limits<T>::infinity();
      if (text == "-Infinity") return -std::numeric_limits<T>::infinity();
      using Bits = std::conditional_t<sizeof(T) == 8, std::uint64_t, std::uint32_t>;
      if (text.starts_with("NaN:")) {
        return std::bit_cast<T>(static_cast<Bits>(std::stoull(text.substr(4), nullptr, 16)));
      }
      throw std::runtime_error("no number: " + text);
    } else if constexpr (std::is_unsigned_v<T>) {
      return static_cast<T>(std::stoull(text));
    } else {
      return static_cast<T>(std::stoll(text));
    }
  }
  if constexpr (std::is_same_v<T, float>) return std::strtof(from.dump().c_str(), nullptr);
  return from.get<T>();
}

template <class T>
requires std::is_arithmetic_v<T>
void from_capture(const json& from, T& to) { to = number_from<T>(from); }
template <class T>
requires std::is_enum_v<T>
void from_capture(const json& from, T& to) { to = static_cast<T>(from.get<std::int32_t>()); }
template <class T>
void from_capture(const json& from, std::complex<T>& to) {
  to = {number_from<T>(from.at(0)), number_from<T>(from.at(1))};
}
inline void from_capture(const json& from, std::string& to) {
  if (from.is_object()) {
    to.assign(from.at("count").get<std::size_t>(), from.at("repeat").get<std::string>().at(0));
  } else {
    to = from;
  }
}
void from_capture(const json& from, ::rr::VarValue& to);

// Namedarrays are lists of their numbers.
template <class T, class Number>
void namedarray_from(const json& from, T& to) {
  const auto numbers = ::rr::numbers<Number>(to);
  for (std::size_t i = 0; i < numbers.size(); ++i) from_capture(from.at(i), numbers[i]);
}
inline void from_capture(const json& from, Vector3& to) {
  namedarray_from<Vector3, double>(from, to);
}
inline void from_capture(const json& from, Transform& to) {
  namedarray_from<Transform, double>(from, to);
}
inline void from_capture(const json& from, Twist& to) { namedarray_from<Twist, float>(from, to); }
inline void from_capture(const json& from, Pixel& to) {
  namedarray_from<Pixel, std::uint8_t>(from, to);
}
inline void from_capture(const json& from, Ticks& to) {
  namedarray_from<Ticks, std::int64_t>(from, to);
}
inline void from_capture(const json& from, Knots& to) { namedarray_from<Knots, double>(from, to); }

// Declared before the templates that call them.
void from_capture(const json& from, Sample& to);
void from_capture(const json& from, Reading& to);
void from_capture(const json& from, Counter& to);
void from_capture(const json& from, Stats& to);
void from_capture(const json& from, Leaf& to);
void from_capture(const json& from, Tree& to);
void from_capture(const json& from, Everything& to);
template <class T>
void from_capture(const json& from, std::vector<T>& to);
template <class T>
void from_capture(const json& from, std::map<std::int32_t, T>& to);
template <class T>
void from_capture(const json& from, std::map<std::string, T>& to);

template <class T>
void from_capture(const json& from, ::rr::Array<T>& to) {
  if (from.is_object()) {
    to = ::rr::Array<T>(from.at("count").get<std::size_t>());
    for (T& item : to.mutate()) from_capture(from.at("repeat"), item);
    return;
  }
  to = ::rr::Array<T>(from.size());
  const auto items = to.mutate();
  for (std::size_t i = 0; i < items.size(); ++i) from_capture(from.at(i), items[i]);
}
template <class T, std::size_t N>
void from_capture(const json& from, std::array<T, N>& to) {
  if (from.size() != N) throw std::runtime_error("wrong length");
  for (std::size_t i = 0; i < N; ++i) from_capture(from.at(i), to[i]);
}
template <class T, std::size_t N>
void from_capture(const json& from, ::rr::BoundedArray<T, N>& to) {
  to.resize(from.size());
  for (std::size_t i = 0; i < to.size(); ++i) from_capture(from.at(i), to[i]);
}
template <class T>
void from_capture(const json& from, ::rr::MultiArray<T>& to) {
  to.dims = from.at("dims").get<std::vector<std::uint32_t>>();
  from_capture(from.at("array"), to.items);
}
template <class T, std::size_t... Dims>
void from_capture(const json& from, ::rr::FixedMultiArray<T, Dims...>& to) {
  from_capture(from.at("array"), to.items);
}
template <class T>
void from_capture(const json& from, std::optional<T>& to) {
  to.reset();
  if (!from.is_null()) from_capture(from, to.emplace());
}
template <class T>
void from_capture(const json& from, ::rr::Recursive<T>& to) {
  to.reset();
  if (!from.is_null()) from_capture(from, to.emplace());
}
template <class T>
void from_capture(const json& from, std::vector<T>& to) {
  to.clear();
  for (const json& item : from) {
    T value{};
    from_capture(item, value);
    to.push_back(std::move(value));
  }
}
template <class T>
void from_capture(const json& from, std::map<std::int32_t, T>& to) {
  for (const json& item : from) from_capture(item.at(1), to[item.at(0).get<std::int32_t>()]);
}
template <class T>
void from_capture(const json& from, std::map<std::string, T>& to) {
  for (const json& item : from) from_capture(item.at(1), to[item.at(0).get<std::string>()]);
}

}  // namespace conformance::types
