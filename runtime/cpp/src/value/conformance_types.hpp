// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "rr/complex.hpp"
#include "rr/definition.hpp"
#include "rr/varvalue.hpp"

/// The types of the definition that the captures were made with, as generated code has them.
namespace conformance::types {

extern const ::rr::RecordType rr_Vector3;
extern const ::rr::RecordType rr_Transform;
extern const ::rr::RecordType rr_Twist;
extern const ::rr::RecordType rr_Pixel;
extern const ::rr::RecordType rr_Ticks;
extern const ::rr::RecordType rr_Knots;
extern const ::rr::RecordType rr_Sample;
extern const ::rr::RecordType rr_Reading;
extern const ::rr::RecordType rr_Counter;
extern const ::rr::RecordType rr_Stats;
extern const ::rr::RecordType rr_Leaf;
extern const ::rr::RecordType rr_Tree;
extern const ::rr::RecordType rr_Everything;

enum class Mode : std::int32_t { idle = 0, manual = 10, automatic = 11, remote = 32, faulted = -1 };

struct Vector3 {
  double x = 0;
  double y = 0;
  double z = 0;

  std::span<double, 3> rr_numbers() { return ::rr::numbers<double>(*this); }
  bool operator==(const Vector3&) const = default;
};
struct Quaternion {
  double w = 0;
  double x = 0;
  double y = 0;
  double z = 0;

  bool operator==(const Quaternion&) const = default;
};
struct Transform {
  Quaternion rotation;
  Vector3 translation;

  bool operator==(const Transform&) const = default;
};
struct Twist {
  std::array<float, 3> angular{};
  std::array<float, 3> linear{};

  bool operator==(const Twist&) const = default;
};
struct Pixel {
  std::uint8_t red = 0;
  std::uint8_t green = 0;
  std::uint8_t blue = 0;

  bool operator==(const Pixel&) const = default;
};
struct Ticks {
  std::int64_t first = 0;
  std::int64_t second = 0;

  bool operator==(const Ticks&) const = default;
};
struct Knots {
  std::array<Vector3, 2> inner{};
  Vector3 last;

  bool operator==(const Knots&) const = default;
};

struct Sample {
  std::uint32_t seq = 0;
  double stamp = 0;
  std::array<float, 3> accel{};

  bool operator==(const Sample&) const = default;
};
struct Reading {
  std::int8_t kind = 0;
  std::uint8_t valid = 0;
  ::rr::BoundedArray<std::uint16_t, 8> payload;
  ::rr::FixedMultiArray<double, 2, 2> gain;
  Sample head;
  std::array<Sample, 2> pair{};
  ::rr::BoundedArray<Sample, 3> tail;
  Vector3 origin;
  std::array<Vector3, 2> base{};
  ::rr::BoundedArray<Vector3, 2> path;
  ::rr::FixedMultiArray<Pixel, 2, 2> block;

  bool operator==(const Reading&) const = default;
};
struct Counter {
  std::int64_t up = 0;
  std::uint64_t down = 0;
  std::array<std::int16_t, 3> trim{};
  ::rr::FixedMultiArray<std::uint32_t, 2, 2> mask;

  bool operator==(const Counter&) const = default;
};

struct Stats {
  std::int32_t count = 0;
  double mean = 0;
  std::string label;

  bool operator==(const Stats&) const = default;
};
struct Leaf {
  std::string name;
  Mode mode{};
  std::optional<Stats> stats;

  bool operator==(const Leaf&) const = default;
};
struct Tree {
  std::string name;
  std::optional<Leaf> main;
  std::optional<std::vector<std::optional<Leaf>>> leaves;
  std::optional<std::map<std::string, std::optional<Leaf>>> by_name;
  ::rr::Recursive<Tree> child;
  ::rr::VarValue extra;

  bool operator==(const Tree&) const = default;
};
struct Everything {
  double v_double = 0;
  float v_single = 0;
  std::int8_t v_int8 = 0;
  std::uint8_t v_uint8 = 0;
  std::int16_t v_int16 = 0;
  std::uint16_t v_uint16 = 0;
  std::int32_t v_int32 = 0;
  std::uint32_t v_uint32 = 0;
  std::int64_t v_int64 = 0;
  std::uint64_t v_uint64 = 0;
  bool v_bool = false;
  std::complex<double> v_cdouble;
  std::complex<float> v_csingle;
  std::string v_string;
  Mode v_mode{};
  ::rr::Array<double> a_double;
  std::array<std::int16_t, 4> a_fixed{};
  ::rr::BoundedArray<std::uint8_t, 6> a_max;
  ::rr::MultiArray<float> m_single;
  ::rr::FixedMultiArray<std::int32_t, 2, 3> m_fixed;
  std::optional<std::vector<double>> l_double;
  std::optional<std::map<std::int32_t, std::string>> i_string;
  std::optional<std::map<std::string, ::rr::Array<std::int32_t>>> s_array;
  std::optional<std::vector<Mode>> l_mode;
  std::optional<Stats> s_stats;
  std::optional<std::vector<std::optional<Stats>>> l_stats;
  Sample p_sample;
  ::rr::Array<Sample> p_samples;
  ::rr::MultiArray<Sample> p_grid;
  std::optional<std::map<std::int32_t, Sample>> p_map;
  Vector3 n_point;
  ::rr::Array<Vector3> n_points;
  ::rr::MultiArray<Vector3> n_grid;
  std::optional<std::vector<Transform>> n_list;
  ::rr::VarValue any;
  std::optional<::rr::VarList> l_any;
  std::optional<::rr::VarStringMap> s_any;

  bool operator==(const Everything&) const = default;
};

extern const ::rr::Definition rr_definition;

}  // namespace conformance::types

template <>
inline constexpr const ::rr::Type& rr::type_of<::conformance::types::Vector3> =
    ::conformance::types::rr_Vector3;
template <>
inline constexpr const ::rr::Type& rr::type_of<::conformance::types::Transform> =
    ::conformance::types::rr_Transform;
template <>
inline constexpr const ::rr::Type& rr::type_of<::conformance::types::Twist> =
    ::conformance::types::rr_Twist;
template <>
inline constexpr const ::rr::Type& rr::type_of<::conformance::types::Pixel> =
    ::conformance::types::rr_Pixel;
template <>
inline constexpr const ::rr::Type& rr::type_of<::conformance::types::Ticks> =
    ::conformance::types::rr_Ticks;
template <>
inline constexpr const ::rr::Type& rr::type_of<::conformance::types::Knots> =
    ::conformance::types::rr_Knots;
template <>
inline constexpr const ::rr::Type& rr::type_of<::conformance::types::Sample> =
    ::conformance::types::rr_Sample;
template <>
inline constexpr const ::rr::Type& rr::type_of<::conformance::types::Reading> =
    ::conformance::types::rr_Reading;
template <>
inline constexpr const ::rr::Type& rr::type_of<::conformance::types::Counter> =
    ::conformance::types::rr_Counter;
template <>
inline constexpr const ::rr::Type& rr::type_of<::conformance::types::Stats> =
    ::conformance::types::rr_Stats;
template <>
inline constexpr const ::rr::Type& rr::type_of<::conformance::types::Leaf> =
    ::conformance::types::rr_Leaf;
template <>
inline constexpr const ::rr::Type& rr::type_of<::conformance::types::Tree> =
    ::conformance::types::rr_Tree;
template <>
inline constexpr const ::rr::Type& rr::type_of<::conformance::types::Everything> =
    ::conformance::types::rr_Everything;
