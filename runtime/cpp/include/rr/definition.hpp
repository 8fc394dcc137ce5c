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

/// Kinds of members.
enum class MemberKind : std::uint8_t {
  property,  ///< a value that clients get and set
  function,  ///< what clients call
  event,     ///< what the service notifies clients of
  objref,    ///< a reference to another object
  pipe,      ///< packets in order, both ways
  callback,  ///< what the service calls at one client
  wire,      ///< a value of which only the newest counts
  memory,    ///< an array that is read and written in parts
};

/// What the modifiers of a member mean, contradictions resolved (06, section 6).
enum Access : std::uint8_t {
  plain = 0,        ///< no modifier
  readonly = 1,     ///< clients get or receive only
  writeonly = 2,    ///< clients set or send only
  unreliable = 4,   ///< pipe, wire: packets may be lost or overtake each other
  nolock = 8,       ///< may be used while another user has locked the object
  nolockread = 16,  ///< the same for reading only
  perclient = 32,   ///< each client has its own value
  urgent = 64,      ///< sent before other messages that wait
};

/// The index of an objref: `none`, a number (`int32`), or a text (`string`).
enum class IndexForm : std::uint8_t { none, int32, string };
/// Whether a function gives a generator: `none`, one that `returns` values, one that `takes` them,
/// or `both`.
enum class GeneratorForm : std::uint8_t { none, returns, takes, both };

/// A parameter of a function, event or callback.
struct Parameter {
  std::string_view name;  ///< as in the definition
  const Type* type;       ///< how it travels
};

/// Describes a parameter: `rr::parameter<double>("pan")`. `T` as for field<T>().
template <class T>
consteval Parameter parameter(std::string_view name) {
  return {name, &type_of<T>};
}

/// The C++ type of the values that a description such as FixedLength stands for.
template <class T>
struct DescribedValue {
  /// The type itself, where it is no description.
  using type = T;
};
/// The C++ type of an array of a length.
template <class T, std::uint32_t Length>
struct DescribedValue<FixedLength<T, Length>> {
  /// An Array.
  using type = Array<T>;
};
/// The C++ type of an array of bounded length.
template <class T, std::uint32_t Length>
struct DescribedValue<MaximumLength<T, Length>> {
  /// An Array.
  using type = Array<T>;
};
/// The C++ type of an array of a shape.
template <class T, std::uint32_t... Dims>
struct DescribedValue<FixedShape<T, Dims...>> {
  /// A MultiArray.
  using type = MultiArray<T>;
};
/// For generated code: the C++ type of values of T, which may be a description such as FixedLength.
template <class T>
using ValueOf = typename DescribedValue<T>::type;

/// One member of an object. Made with the functions below.
struct Member {
  MemberKind kind;                                ///< which of the following count
  std::uint8_t access = plain;                    ///< Access, added up
  IndexForm index = IndexForm::none;              ///< objref
  GeneratorForm generator = GeneratorForm::none;  ///< function
  std::string_view name;                          ///< as in the definition
  /// property, pipe, wire, memory: the value; function, callback: the return value; null for void.
  const Type* type = nullptr;
  std::span<const Parameter> parameters{};    ///< function, event, callback; without a generator's
  const Type* generator_parameter = nullptr;  ///< what a step takes; null for nothing
  /// objref: qualified type, empty for varobject.
  std::string_view object_type{};
  /// pipe, wire: how values that arrive are kept; never null there.
  const Holding* holding = nullptr;
};

/// For generated code: describes a property of type T.
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
/// For generated code: describes a pipe whose packets are of type T.
template <class T>
consteval Member pipe(std::string_view name, std::uint8_t access = plain) {
  return {.kind = MemberKind::pipe,
          .access = access,
          .name = name,
          .type = &type_of<T>,
          .holding = &holding_of<ValueOf<T>>};
}
/// For generated code: describes a callback. `R` is void for one without a result.
template <class R>
consteval Member callback(std::string_view name, std::span<const Parameter> parameters = {},
                          std::uint8_t access = plain) {
  Member member = function<R>(name, parameters, access);
  member.kind = MemberKind::callback;
  return member;
}
/// For generated code: describes a wire whose values are of type T.
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
/// For generated code: describes an event.
consteval Member event(std::string_view name, std::span<const Parameter> parameters = {},
                       std::uint8_t access = plain) {
  return {.kind = MemberKind::event, .access = access, .name = name, .parameters = parameters};
}
/// For generated code: describes an objref to objects of `object_type`, qualified; empty for
/// varobject.
consteval Member objref(std::string_view name, std::string_view object_type,
                        IndexForm index = IndexForm::none) {
  return {.kind = MemberKind::objref, .index = index, .name = name, .object_type = object_type};
}

/// An object of a definition.
struct ObjectType {
  std::string_view name;         ///< qualified
  const Definition& definition;  ///< which declares it
  /// The implements lines as stored: imported ones qualified, own ones plain.
  std::span<const std::string_view> implements;
  std::span<const Member> members;  ///< its members, those of what it implements included
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
  std::string_view name;  ///< its name, as in its first line
  /// The exact text of the file: what a service sends to its clients.
  std::string_view text;
  DefinitionVersion version{};                 ///< of the language; all zero when it declares none
  std::span<const Definition* const> imports;  ///< the definitions that it imports
  std::span<const RecordType* const> records;  ///< its structs, pods and namedarrays
  std::span<const ExceptionType> exceptions;   ///< its exceptions
  std::span<const ObjectType* const> objects;  ///< its objects
};

}  // namespace rr
