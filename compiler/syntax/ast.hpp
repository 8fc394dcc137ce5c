// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "compiler/diagnostics/source.hpp"
#include "compiler/syntax/lossless.hpp"

/// The syntax tree: what was written, where, and nothing that has to be looked up. One plain
/// struct per construct of the language; names are unresolved text with their spans.
namespace robdef::ast {

/// A written name, dotted or plain, and its place.
struct Name {
  std::string text;
  Span span;
};

/// Lines of a `##` comment, joined with LF; empty when there is none.
using Documentation = std::string;

enum class ArrayForm {
  none,            ///< scalar
  any_length,      ///< `[]`
  fixed_length,    ///< `[n]`
  maximum_length,  ///< `[n-]`
  any_shape,       ///< `[*]`
  fixed_shape,     ///< `[m,n,...]` or `[n,]`
};

enum class ContainerForm { none, list, int32_map, string_map, generator };

/// A type as written: base, array, container (06, section 5).
struct TypeRef {
  Span span;  ///< the whole type
  Name base;
  ArrayForm array = ArrayForm::none;
  std::vector<std::uint32_t> dimensions;  ///< of the fixed and maximum forms
  Span array_span;
  ContainerForm container = ContainerForm::none;
  Span container_span;
};

struct ModifierArgument {
  std::string text;
  Span span;
  bool is_name = false;  ///< a constant's name rather than a number
};

struct Modifier {
  Name name;
  std::vector<ModifierArgument> arguments;
  Span span;
};

struct Parameter {
  TypeRef type;
  Name name;
};

enum class MemberKind { property, function, event, objref, pipe, callback, wire, memory };

/// A member of an object.
struct Member {
  MemberKind kind{};
  std::optional<TypeRef> type;  ///< absent for events only
  Name name;
  std::vector<Parameter> parameters;  ///< functions, events, callbacks
  std::vector<Modifier> modifiers;
  Documentation documentation;
  Span span;  ///< the logical line
};

/// A field of a struct, pod or namedarray.
struct Field {
  TypeRef type;
  Name name;
  std::vector<Modifier> modifiers;
  Documentation documentation;
  Span span;
};

struct NumberLiteral {
  std::string text;  ///< as written: sign, decimal, hexadecimal or floating
  Span span;
};
struct StringLiteral {
  std::string value;  ///< UTF-8, escapes resolved
  Span span;
};
struct ArrayLiteral {
  std::vector<NumberLiteral> items;
  Span span;
};
struct StructLiteralField {
  Name field;
  Name constant;
};
struct StructLiteral {
  std::vector<StructLiteralField> fields;
  Span span;
};
using ConstantValue = std::variant<NumberLiteral, StringLiteral, ArrayLiteral, StructLiteral>;

struct Constant {
  TypeRef type;  ///< `struct` or another word for a struct constant (Q14)
  Name name;
  ConstantValue value;
  Documentation documentation;
  Span span;
};

struct EnumValue {
  Name name;
  std::optional<NumberLiteral> value;  ///< absent: the previous plus one
  Documentation documentation;
};

struct Enum {
  Name name;
  std::vector<EnumValue> values;
  Documentation documentation;
  Span span;  ///< the header line
};

struct Exception {
  Name name;
  Documentation documentation;
  Span span;
};

/// `option`: kept as text; `option version` and `option constant` are read into the file too.
struct Option {
  std::string text;
  Span span;
};

enum class RecordKind { struct_, pod, namedarray };

/// A struct, pod or namedarray.
struct Record {
  RecordKind kind{};
  Name name;
  std::vector<Constant> constants;
  std::vector<Field> fields;
  std::vector<Option> options;
  Documentation documentation;
  Span span;  ///< the header line
};

struct Implements {
  Name name;
  Span span;
};

struct Object {
  Name name;
  std::vector<Implements> implements;
  std::vector<Constant> constants;
  std::vector<Member> members;
  std::vector<Option> options;
  Documentation documentation;
  Span span;  ///< the header line
};

struct Import {
  Name name;
  Span span;
  bool is_reported = false;  ///< something was found and is reported as unfit; nothing is loaded
};

/// `using a.b.C [as D]`
struct Using {
  Name qualified;
  std::optional<Name> alias;
  Span span;
};

/// Two to four numbers; missing ones are 0. Compared left to right.
struct Version {
  std::array<std::uint32_t, 4> numbers{};
  auto operator<=>(const Version&) const = default;
};

/// How a file says which version of the language it needs.
enum class VersionSpelling { none, stdver, option };

using Declaration = std::variant<Constant, Exception, Enum, Record, Object>;

/// One service definition. What could not be parsed is missing here and reported.
struct File {
  SourceId source{};
  std::optional<Name> service;
  Documentation documentation;
  VersionSpelling version_spelling = VersionSpelling::none;
  Version version;
  Span version_span;
  std::vector<Import> imports;
  std::vector<Using> usings;
  std::vector<Option> options;
  std::vector<Declaration> declarations;  ///< in the order written
  LosslessText written;                   ///< every byte, what could not be parsed included
};

/// A file of a program, and whether the user asked for it or an import did.
struct ProgramFile {
  File file;
  bool is_import = false;
};

/// Everything that was loaded, in load order: sources first, then imports as they were met.
struct Program {
  std::vector<ProgramFile> files;
};

}  // namespace robdef::ast
