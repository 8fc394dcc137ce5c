// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "compiler/backends/member_facts.hpp"
#include "compiler/diagnostics/report.hpp"
#include "compiler/model/model.hpp"
#include "compiler/output/view_type.hpp"

/// What templates can print of a definition in C++: names are C++ names, types C++ types, values
/// C++ literals, and documentation is in lines. The code around them stands in templates.
/// `robdef view --lang cpp` prints it all as JSON.
namespace robdef::cpp {

/// The name of a constant and its value, which is a literal or has `items`.
struct ConstantFacts {
  using Facts = ConstantFacts;

  std::string name;   ///< in C++
  std::string type;   ///< `::std::array<double, 3>`; empty for a struct constant
  std::string value;  ///< `0x10`, `"text"`; empty for a struct constant and an array
  std::string size;   ///< of a text with a NUL: its bytes, since the literal ends there
  bool is_array = false;
  std::vector<std::string> items;  ///< array: literals
  bool in_class = false;           ///< of a record or object, or in a struct constant
  std::string margin;              ///< in a struct constant: blanks before it

  template <class View>
  static ViewType fields() {
    return {ROBDEF_VIEW_FIELDS(View, name, type, value, size, is_array, items, in_class, margin)};
  }
};

/// A line of a struct constant: a value, or where a struct begins or ends.
struct ConstantPartView : ConstantFacts {
  bool opens = false;     ///< a struct called `name` begins
  bool closes = false;    ///< the struct that began last ends
  bool is_empty = false;  ///< a struct called `name` without values
};

/// A constant of a definition, record or object.
struct ConstantView : ConstantFacts {
  std::string wire_name;                ///< as in the definition
  std::vector<std::string> doc;         ///< lines with their `///`
  bool is_struct = false;               ///< a struct constant
  std::vector<ConstantPartView> parts;  ///< struct constant: all of it
};

/// What a variable begins with: a literal, an array that is made, or else `{}`.
struct InitialView {
  std::string literal;  ///< `0`, `false`
  std::string length;   ///< of the array: `20000`
  std::string shape;    ///< of an array with several dimensions: `200, 100`
  std::string item;     ///< the type of that one's items: `double`
};

struct VariableView {
  std::string type;
  std::string name;
  InitialView initial;
};

/// A name of `using` for something of another definition.
struct AliasView {
  std::string name;
  std::string target;  ///< `::example::geometry::Point`
};

struct EnumValueView {
  std::string wire_name;
  std::string name;
  std::string value;  ///< `1`, `0x10`
  std::vector<std::string> doc;
};

struct EnumView {
  std::string wire_name;
  std::string name;
  std::string qualified;  ///< `::example::Color`
  std::vector<std::string> doc;
  bool has_values = false;
  std::vector<EnumValueView> values;
};

struct ExceptionView {
  std::string wire_name;  ///< qualified: `example.Fault`
  std::string name;
  std::string qualified;
  std::vector<std::string> doc;
  // Names for the parameters of the constructors: one must not be called like the class.
  std::string message;
  std::string subname;
  std::string parameter;
  std::string error;
};

struct FieldView {
  std::string wire_name;
  std::string name;
  std::vector<std::string> doc;
  std::string type;         ///< `::std::optional<Pose>`
  std::string descriptor;   ///< what rr::type_of is asked for
  std::string robdef_type;  ///< as in the definition, with qualified names
  InitialView initial;
};

/// A struct, pod or namedarray.
struct RecordView : RecordFacts {
  std::string name;
  std::string class_name;  ///< the same, where a field has a `name`
  std::string qualified;
  std::vector<std::string> doc;
  std::string number_type;  ///< namedarray: of its numbers, `double`
  std::vector<ConstantView> constants;
  std::vector<FieldView> fields;
  std::string table;        ///< name of its RecordType
  std::string field_table;  ///< name of the array of its fields
};

struct ParameterView : ParameterFacts {
  std::string type;
  bool is_by_value = false;  ///< passed as it is, and not as a reference to a constant
  InitialView initial;       ///< of a variable for it
  std::string descriptor;
};

/// A member of an object. What does not apply to its kind is empty or false.
struct MemberView : MemberFacts {
  std::string name;
  std::string place;  ///< its name among the places in the table: its own, unless that is reserved
  std::vector<std::string> doc;

  std::string type;  ///< property, pipe, wire, memory: the value; function, callback: the result
  bool is_by_value = false;  ///< the value is passed as it is, and not as a reference to a constant
  std::string descriptor;    ///< what rr::type_of is asked for
  std::optional<VariableView> variable;  ///< property: one that holds its value
  std::string item;                      ///< memory: one of its items, `double`
  std::string handle;  ///< what the stub's method gives: `::rr::Pipe<Frame>`, `::rr::Event<double>`
  std::string served;  ///< what the skeleton's gives: `::rr::PipeServer<Frame>`
  std::vector<ParameterView> parameters;
  bool yields = false;                               ///< generator: each step returns a `type`
  std::optional<ParameterView> generator_parameter;  ///< what each step takes

  std::string stub;  ///< objref: its class, as written here
  std::string skeleton;
  std::string qualified_stub;
  std::string qualified_skeleton;

  std::string code;  ///< property, objref: what `get_` and `set_` stand before

  // What is behind the names of further parameters where a parameter of the member has the name:
  // usually nothing.
  std::string token_mark;  ///< `token`, of a completion token
  std::string type_mark;   ///< `Token`, its type
  std::string options_mark;
  std::string answer_mark;  ///< function: `answer`, of what takes the result
  std::string client_mark;  ///< callback: `client`, of the endpoint that is called
  std::string index_mark;   ///< objref
  std::string value_mark;
  std::vector<std::string> described;  ///< types that its row in the table is given
  std::vector<std::string> access;     ///< modifiers that the row has: `readonly`, `nolock`
  bool has_no_table = false;           ///< no table of parameters, but modifiers after it
  bool is_hidden = false;              ///< function: by a parameter of its name
  std::string taken;                   ///< generator: the type that each step takes, or `void`
  bool has_handle = false;             ///< event, pipe, callback, wire, memory
};

struct BaseView {
  std::string wire_name;  ///< as an implements line stores it: qualified unless of this definition
  std::string stub;
  std::string skeleton;
};

struct ObjectView {
  std::string wire_name;   ///< qualified: `example.PanTilt`
  std::string short_name;  ///< `PanTilt`
  std::string name;        ///< of the struct that holds its constants
  std::vector<std::string> stub_doc;
  std::vector<std::string> skeleton_doc;
  std::vector<std::string> default_doc;
  std::string stub;
  std::string stub_class;  ///< the same, where a member has a `stub`
  std::string skeleton;
  std::string default_class;
  std::string qualified_stub;
  std::string qualified_skeleton;
  std::string qualified_default;
  bool has_default = false;
  std::vector<BaseView> implements;
  bool has_implements = false;
  std::vector<ConstantView> constants;
  bool has_constants = false;
  std::vector<MemberView> members;
  bool has_members = false;     ///< served ones
  bool has_parameters = false;  ///< one of them has parameters
  bool has_calls = false;       ///< properties or functions
  bool has_objrefs = false;
  bool uses_index = false;  ///< one of them has an index
  bool has_memories = false;
  bool has_stored = false;   ///< the Default class stores something
  std::string table;         ///< name of its ObjectType
  std::string member_table;  ///< of the array of its members
  std::string implements_table;
  std::string parameter_tables;  ///< of the struct with its parameters' tables
};

/// A declaration in the order of the generated header: one of these is there.
struct DeclarationView {
  std::optional<ConstantView> constant;
  std::optional<ExceptionView> exception;
  std::optional<EnumView> enumeration;
  std::optional<RecordView> record;
  std::optional<ObjectView> object;
  bool ends_group = false;  ///< an empty line follows
  /// An enum with a value that is called like a constant or alias: it comes before these, since g++
  /// sees the value hide them otherwise.
  bool is_early = false;
};

/// Something of the definition that is declared before it is defined.
struct ForwardView {
  std::string name;
  bool is_struct = false;  ///< otherwise a class
};

struct ImportView {
  std::string wire_name;
  std::string header;     ///< `example/geometry.hpp`
  std::string qualified;  ///< `::example::geometry`
};

/// One service definition.
struct DefinitionView {
  std::string wire_name;  ///< `experimental.mount`
  std::string space;      ///< `experimental::mount`
  std::string qualified;  ///< `::experimental::mount`
  std::string path;       ///< `experimental/mount`
  std::string header;     ///< `experimental/mount.hpp`
  std::vector<std::string> doc;
  std::vector<std::string> includes;         ///< of the header: `<cstdint>`
  std::vector<std::string> import_includes;  ///< `"example/geometry.hpp"`
  std::vector<ImportView> imports;
  bool has_imports = false;
  bool has_early = false;  ///< one of the declarations is early
  std::vector<AliasView> aliases;
  bool has_aliases = false;
  std::vector<ForwardView> forwards;
  bool has_forwards = false;
  std::vector<DeclarationView> declarations;
  bool has_fields = false;  ///< a struct or pod has some
  bool has_records = false;
  bool has_exceptions = false;
  bool has_objects = false;
  std::vector<std::string> text;     ///< the definition's text as C++ literals, to be put in a row
  std::vector<std::string> version;  ///< its numbers
};

/// Everything that is generated for.
struct ModelView {
  std::vector<DefinitionView> definitions;
};

/// Builds the view. Reports R0901 to R0904.
ModelView make_view(const model::Model& model, Report& report);

}  // namespace robdef::cpp
