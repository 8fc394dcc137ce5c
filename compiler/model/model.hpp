// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <variant>
#include <vector>

#include "compiler/syntax/ast.hpp"

/// Resolved definitions: every name is a pointer to what it stands for, every constant has its
/// value, every record its size. The model knows nothing of any target language. Once made it does
/// not change; backends and the dynamic client read it.
namespace robdef::model {

struct Definition;
struct Record;
struct Enum;
struct Object;

/// Element types by their number on the wire (03, section 2); also the base of a type.
enum class Primitive : std::uint16_t {
  void_ = 0,
  double_ = 1,
  single = 2,
  int8 = 3,
  uint8 = 4,
  int16 = 5,
  uint16 = 6,
  int32 = 7,
  uint32 = 8,
  int64 = 9,
  uint64 = 10,
  string = 11,
  cdouble = 12,
  csingle = 13,
  bool_ = 14,
};

/// The word of the language: `double`, `int32`, ...
std::string_view name_of(Primitive primitive);
/// Nothing for a word that is no primitive.
std::optional<Primitive> primitive_of(std::string_view word);
/// Bytes of one item on the wire: 8 for double, 1 for string and bool, 0 for void.
std::size_t size_of(Primitive primitive);
/// Codes 1-10 and 12-14: what may stand in arrays, pods, namedarrays and memories.
bool is_numeric(Primitive primitive);

using ast::ArrayForm;
using ast::ContainerForm;
using ast::MemberKind;
using ast::RecordKind;

/// `{list}`, `{int32}`, ...; empty for none.
std::string_view text_of(ContainerForm container);
/// As it would be written, without needless zeros at the end: `0.10`, `0.9.2`.
std::string text_of(const ast::Version& version);
/// The keyword: `struct`, `pod` or `namedarray`.
std::string_view name_of(RecordKind kind);
/// The keyword: `property`, `function`, ...
std::string_view name_of(MemberKind kind);

struct VarValue {};   ///< `varvalue`
struct VarObject {};  ///< `varobject`, objref only
struct Unknown {};    ///< a name that was reported; later passes accept it in silence

using Base = std::variant<Primitive, const Record*, const Enum*, const Object*, VarValue, VarObject,
                          Unknown>;

/// A resolved type: base, array, container.
struct Type {
  Base base = Primitive::void_;
  ArrayForm array = ArrayForm::none;
  std::vector<std::uint32_t> dimensions;  ///< fixed and maximum forms; `[0]` has become any_length
  ContainerForm container = ContainerForm::none;
  Span span;

  /// Product of the dimensions of fixed_length, maximum_length and fixed_shape; 1 for a scalar, 0
  /// where there is no limit. Products beyond 64 bits become the largest number.
  [[nodiscard]] std::uint64_t element_count() const;
  [[nodiscard]] bool is_void() const;
  /// The type as it would be written with qualified names: `conformance.types.Stats{list}`.
  [[nodiscard]] std::string text() const;
  /// Array and container as written behind the base: `[3-]{list}`.
  [[nodiscard]] std::string suffix() const;
  /// Same base, array form, dimensions and container; where a base is Unknown, nothing is compared.
  [[nodiscard]] bool is_same_as(const Type& other) const;
};

/// A constant's value. Integers are kept exactly (negative values of unsigned types wrap, Q13).
struct StructValueField {
  std::string field;
  const struct Constant* constant = nullptr;  ///< of the same scope
  Span span;                                  ///< of the field name
};
using Number = std::variant<std::int64_t, std::uint64_t, double>;
using ConstantValue =
    std::variant<Number, std::vector<Number>, std::string, std::vector<StructValueField>>;

struct Constant {
  std::string name;
  /// Numbers and strings; for a struct constant the base is Unknown and value holds its fields.
  Type type;
  bool is_struct = false;
  ConstantValue value;
  ast::ConstantValue written;  ///< the literal: evaluate reads it, print repeats its numbers
  bool is_option = false;      ///< in the old spelling `option constant`
  std::string documentation;
  Span span;                ///< of the name
  std::string code_name{};  ///< rename.hpp
};

struct Exception {
  std::string name;
  const Definition* definition = nullptr;
  std::string documentation;
  Span span;
  std::string code_name{};  ///< rename.hpp
};

struct EnumValue {
  std::string name;
  std::int32_t value = 0;
  bool is_hexadecimal = false;                ///< inherited by values without a number
  std::optional<ast::NumberLiteral> written;  ///< absent: the previous plus one
  std::string documentation;
  Span span;
  std::string code_name{};  ///< rename.hpp
};

struct Enum {
  std::string name;
  const Definition* definition = nullptr;
  std::vector<EnumValue> values;
  std::string documentation;
  Span span;
  std::string code_name{};  ///< rename.hpp
};

/// An unknown modifier is kept: it compares in implements (V27) and shows in `describe`.
struct Modifier {
  std::string name;
  std::vector<std::string> arguments;
  std::vector<Span> argument_spans;
  Span span;

  /// Same name and arguments, wherever they stand.
  [[nodiscard]] bool is_same_as(const Modifier& other) const;
};

struct Field {
  std::string name;
  Type type;
  std::vector<Modifier> modifiers;
  std::string documentation;
  Span span;
  std::string code_name{};  ///< rename.hpp
};

/// A struct, pod or namedarray.
struct Record {
  RecordKind kind{};
  std::string name;
  const Definition* definition = nullptr;
  std::vector<Constant> constants;
  std::vector<Field> fields;
  std::vector<std::string> options;  ///< as in Definition
  std::string documentation;
  Span span;

  // Layout; zero and void for structs.
  Primitive number = Primitive::void_;  ///< namedarray: the one type of all its numbers
  std::uint64_t number_count = 0;       ///< namedarray: numbers in one item
  /// pod: upper bound in bytes of one item serialized as a message element of format 2; the unit
  /// of the memory transfer limit (07, section 13).
  std::uint64_t packed_size = 0;
  /// struct: may contain itself, directly or through other structs and containers.
  bool is_recursive = false;
  std::string code_name{};  ///< rename.hpp

  /// `<service>.<name>`, as it stands in ElementTypeName.
  [[nodiscard]] std::string qualified_name() const;
};

/// What the modifiers of a member mean, contradictions resolved (06, section 6): readonly wins
/// over writeonly, nolock over nolockread.
struct Access {
  bool is_readonly = false;
  bool is_writeonly = false;
  bool is_unreliable = false;
  bool is_nolock = false;
  bool is_nolockread = false;
  bool is_perclient = false;
  bool is_urgent = false;
};

struct Parameter {
  std::string name;
  Type type;
  Span span;
  std::string code_name{};  ///< rename.hpp
};

/// How a function iterates (06, section 6).
enum class GeneratorForm { none, returns, takes, both };

enum class IndexForm { none, int32, string };

/// A member of an object. Which parts mean something depends on the kind.
struct Member {
  MemberKind kind{};
  std::string name;
  /// property, pipe, wire, memory: the value; function, callback: the return type, without
  /// `{generator}`; event: void; objref: the object or varobject.
  Type type;
  /// In order; without a final generator parameter.
  std::vector<Parameter> parameters;
  GeneratorForm generator = GeneratorForm::none;
  /// generator takes and both: the final parameter, its type without `{generator}`.
  std::optional<Parameter> generator_parameter;
  IndexForm index = IndexForm::none;  ///< objref
  std::vector<Modifier> modifiers;
  Access access;
  std::string documentation;
  Span span;
  std::string code_name{};  ///< rename.hpp
};

struct Object {
  std::string name;
  const Definition* definition = nullptr;
  std::vector<const Object*> implements;  ///< in order, each once
  std::vector<Span> implements_spans;     ///< of the names, one for each of `implements`
  std::vector<Constant> constants;
  std::vector<Member> members;
  std::vector<std::string> options;  ///< as in Definition
  std::string documentation;
  Span span;
  std::string code_name{};  ///< rename.hpp

  [[nodiscard]] std::string qualified_name() const;
};

/// A name of `using`, for whatever kind of declaration.
struct Alias {
  std::string name;
  std::string qualified_name;
  Span span;  ///< of the alias: the name after `as`, or the last part of the qualified name
};

/// A declaration in the order of the file.
using Declaration =
    std::variant<const Constant*, const Exception*, const Enum*, const Record*, const Object*>;

/// One service definition.
struct Definition {
  std::string name;  ///< `com.robotraconteur.image`
  SourceId source{};
  bool is_import = false;  ///< loaded for an import only: nothing is generated for it
  /// As read, with byte order mark and line ends; what a service sends.
  std::string text;
  std::string documentation;
  ast::VersionSpelling version_spelling = ast::VersionSpelling::none;
  ast::Version version;
  Span version_span;
  std::vector<const Definition*> imports;  ///< direct, in order, each once
  std::vector<Alias> aliases;
  std::vector<Constant> constants;
  std::vector<Exception> exceptions;
  std::vector<Enum> enums;
  std::vector<Record> records;
  std::vector<Object> objects;
  std::vector<Declaration> declarations;
  /// Texts of the `option` lines but those that became a version or a constant.
  std::vector<std::string> options;
  Span span;  ///< of the service name
};

/// All definitions of a run. Definitions do not move once they are in, so the pointers between
/// them hold as long as the model.
class Model {
 public:
  [[nodiscard]] const std::vector<std::unique_ptr<Definition>>& definitions() const {
    return definitions_;
  }
  /// nullptr when there is none of that name.
  [[nodiscard]] const Definition* find(std::string_view name) const;
  /// A new, empty definition at the end. Of several with one name, find() sees the first.
  Definition& add(std::string name);

 private:
  std::vector<std::unique_ptr<Definition>> definitions_;
  std::unordered_map<std::string_view, const Definition*> by_name_;
};

}  // namespace robdef::model
