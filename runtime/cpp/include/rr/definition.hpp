// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <type_traits>

#include "rr/error.hpp"
#include "rr/holding.hpp"
#include "rr/type.hpp"
#include "rr/visibility.hpp"

/// What generated code says about its definition: constant tables, one of each per definition,
/// object and member. The runtime drives calls from them.
namespace RR_VISIBLE rr {

class Stub;
struct Definition;

enum class MemberKind : std::uint8_t {
  property,
  function,
  event,
  objref,
  pipe,
  callback,
  wire,
  memory,
};

/// What the modifiers of a member mean, contradictions resolved (06, section 6).
enum Access : std::uint8_t {
  plain = 0,
  readonly = 1,
  writeonly = 2,
  unreliable = 4,
  nolock = 8,
  nolockread = 16,
  perclient = 32,
  urgent = 64,
};

enum class IndexForm : std::uint8_t { none, int32, string };
enum class GeneratorForm : std::uint8_t { none, returns, takes, both };

struct Parameter {
  std::string_view name;
  const Type* type;
};

/// Describes a parameter: `rr::parameter<double>("pan")`. `T` as for field<T>().
template <class T>
consteval Parameter parameter(std::string_view name) {
  return {name, &type_of<T>};
}

/// The C++ type of the values that a description such as FixedLength stands for.
template <class T>
struct DescribedValue {
  using type = T;
};
template <class T, std::uint32_t Length>
struct DescribedValue<FixedLength<T, Length>> {
  using type = Array<T>;
};
template <class T, std::uint32_t Length>
struct DescribedValue<MaximumLength<T, Length>> {
  using type = Array<T>;
};
template <class T, std::uint32_t... Dims>
struct DescribedValue<FixedShape<T, Dims...>> {
  using type = MultiArray<T>;
};
template <class T>
using ValueOf = typename DescribedValue<T>::type;

/// One member of an object. Made with the functions below.
struct Member {
  MemberKind kind;
  std::uint8_t access = plain;
  IndexForm index = IndexForm::none;              ///< objref
  GeneratorForm generator = GeneratorForm::none;  ///< function
  std::string_view name;
  /// property, pipe, wire, memory: the value; function, callback: the return value; null for void.
  const Type* type = nullptr;
  std::span<const Parameter> parameters{};  ///< function, event, callback; without a generator's
  const Type* generator_parameter = nullptr;
  /// objref: qualified type, empty for varobject.
  std::string_view object_type{};
  /// pipe, wire: how values that arrive are kept; never null there.
  const Holding* holding = nullptr;
};

template <class T>
consteval Member property(std::string_view name, std::uint8_t access = plain) {
  return {.kind = MemberKind::property, .access = access, .name = name, .type = &type_of<T>};
}
/// `R` is void for a function without a result.
template <class R>
consteval Member function(std::string_view name, std::span<const Parameter> parameters = {},
                          std::uint8_t access = plain) {
  Member member{
      .kind = MemberKind::function, .access = access, .name = name, .parameters = parameters};
  if constexpr (!std::is_void_v<R>) member.type = &type_of<R>;
  return member;
}
/// A function whose call gives a generator: `R` is what each step gives, `P` what it takes, either
/// may be void.
template <class R, class P>
consteval Member generator(std::string_view name, std::span<const Parameter> parameters = {},
                           std::uint8_t access = plain) {
  Member member = function<R>(name, parameters, access);
  member.generator = std::is_void_v<P>   ? GeneratorForm::returns
                     : std::is_void_v<R> ? GeneratorForm::takes
                                         : GeneratorForm::both;
  if constexpr (!std::is_void_v<P>) member.generator_parameter = &type_of<P>;
  return member;
}
template <class T>
consteval Member pipe(std::string_view name, std::uint8_t access = plain) {
  return {.kind = MemberKind::pipe,
          .access = access,
          .name = name,
          .type = &type_of<T>,
          .holding = &holding_of<ValueOf<T>>};
}
template <class R>
consteval Member callback(std::string_view name, std::span<const Parameter> parameters = {},
                          std::uint8_t access = plain) {
  Member member = function<R>(name, parameters, access);
  member.kind = MemberKind::callback;
  return member;
}
template <class T>
consteval Member wire(std::string_view name, std::uint8_t access = plain) {
  return {.kind = MemberKind::wire,
          .access = access,
          .name = name,
          .type = &type_of<T>,
          .holding = &holding_of<ValueOf<T>>};
}
/// `T` is an Array or a MultiArray.
template <class T>
consteval Member memory(std::string_view name, std::uint8_t access = plain) {
  return {.kind = MemberKind::memory, .access = access, .name = name, .type = &type_of<T>};
}
consteval Member event(std::string_view name, std::span<const Parameter> parameters = {},
                       std::uint8_t access = plain) {
  return {.kind = MemberKind::event, .access = access, .name = name, .parameters = parameters};
}
consteval Member objref(std::string_view name, std::string_view object_type,
                        IndexForm index = IndexForm::none) {
  return {.kind = MemberKind::objref, .index = index, .name = name, .object_type = object_type};
}

/// An object of a definition.
struct ObjectType {
  std::string_view name;  ///< qualified
  const Definition& definition;
  /// The implements lines as stored: imported ones qualified, own ones plain.
  std::span<const std::string_view> implements;
  std::span<const Member> members;
  /// Makes the stub class of this object, not yet attached to a session.
  std::shared_ptr<Stub> (*make_stub)();
};

/// An `exception` of a definition.
struct ExceptionType {
  std::string_view name;  ///< qualified
  /// Throws the C++ class of this exception with the contents of `error`.
  void (*raise)(const Error& error);
};

/// Version of the language that a definition declares; all zero when it declares none.
using DefinitionVersion = std::array<std::uint16_t, 4>;

/// One service definition.
struct Definition {
  std::string_view name;
  /// The exact text of the file: what a service sends to its clients.
  std::string_view text;
  DefinitionVersion version{};
  std::span<const Definition* const> imports;
  std::span<const RecordType* const> records;
  std::span<const ExceptionType> exceptions;
  std::span<const ObjectType* const> objects;
};

}  // namespace rr
