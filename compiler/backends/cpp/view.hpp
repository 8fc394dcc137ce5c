// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "compiler/backends/member_facts.hpp"
#include "compiler/diagnostics/report.hpp"
#include "compiler/model/model.hpp"

/// What templates can print of a definition in C++. Texts are finished: names are C++ names, types
/// C++ types, and what may need several lines is broken as the project's clang-format style does.
/// `robdef view --lang cpp` prints it all as JSON.
namespace robdef::cpp {

/// A constant of a definition, record or object.
struct ConstantView {
  std::string wire_name;         ///< as in the definition
  std::string name;              ///< in C++
  std::vector<std::string> doc;  ///< lines with their `///`
  bool is_struct = false;        ///< a struct constant: without type and value
  std::string type;              ///< `::std::array<double, 3>`
  std::string value;             ///< `{1, 2, 3}`
  std::string definition;        ///< all of it
};

/// A name of `using` for something of another definition.
struct AliasView {
  std::string definition;  ///< `using Point = ::example::geometry::Point;`
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
  std::string constructor;  ///< from message, sub-name and parameter
  std::string parameter;    ///< a name for the parameter of the other constructor
  std::string error;        ///< what the constructor from an error calls its parameter
};

struct FieldView {
  std::string wire_name;
  std::string name;
  std::vector<std::string> doc;
  std::string type;         ///< `::std::optional<Pose>`
  std::string descriptor;   ///< what rr::type_of is asked for
  std::string robdef_type;  ///< as in the definition, with qualified names
  std::string declaration;  ///< `double pan = 0;`
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
  std::string table;             ///< name of its RecordType
  std::string field_table;       ///< name of the array of its fields
  std::string table_definition;  ///< of the RecordType
  std::string specialization;    ///< of rr::type_of
};

struct ParameterView : ParameterFacts {
  std::string type;
  std::string passed;        ///< `double`, `const ::std::string&`
  bool is_by_value = false;  ///< passed as it is, and not as a reference to a constant
  std::string local;         ///< a variable for it: `double pan = 0;`
  std::string descriptor;
};

/// A member of an object. What does not apply to its kind is empty or false.
struct MemberView : MemberFacts {
  std::string name;
  std::string place;  ///< its name among the places in the table: its own, unless that is reserved
  std::vector<std::string> doc;

  std::string type;    ///< property, pipe, wire, memory: the value; function, callback: the result
  std::string passed;  ///< the value as a parameter
  bool is_by_value = false;  ///< which is a `type` then, otherwise a reference to one
  std::string value;         ///< a name for a variable that holds it
  std::string descriptor;    ///< what rr::type_of is asked for
  std::string local;         ///< the variable: `double value = 0;`
  std::string item;          ///< memory: one of its items, `double`
  std::string handle;  ///< what the stub's method gives: `::rr::Pipe<Frame>`, `::rr::Event<double>`
  std::string served;  ///< what the skeleton's gives: `::rr::PipeServer<Frame>`
  std::string stored;  ///< property, memory: what a Default class keeps
  std::vector<ParameterView> parameters;
  std::string arguments;                             ///< names of the parameters: `pan, tilt`
  bool yields = false;                               ///< generator: each step returns a `type`
  std::optional<ParameterView> generator_parameter;  ///< what each step takes

  std::string stub;  ///< objref: its class, as written here
  std::string skeleton;
  std::string qualified_stub;
  std::string qualified_skeleton;

  std::string code;    ///< property, objref: what `get_` and `set_` stand before
  std::string getter;  ///< `get_pan`: properties and objrefs
  std::string setter;  ///< `set_pan`

  // What is behind the names of further parameters where a parameter of the member has the name:
  // usually nothing.
  std::string token_mark;  ///< `token`, of a completion token
  std::string type_mark;   ///< `Token`, its type
  std::string options_mark;
  std::string answer_mark;  ///< function: `answer`, of what takes the result
  std::string client_mark;  ///< callback: `client`, of the endpoint that is called
  std::string index_mark;   ///< objref
  std::string value_mark;
  std::string described;      ///< types that its row in the table is given: `double, void`
  std::string access;         ///< what the row says of modifiers: `::rr::readonly | ::rr::nolock`
  bool has_no_table = false;  ///< no table of parameters, but modifiers after it
  std::string called;         ///< function: how it is called where a parameter may have its name
  std::string taken;          ///< generator: the type that each step takes, or `void`
  bool has_handle = false;    ///< event, pipe, callback, wire, memory
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
  std::string stub_head;  ///< `class PanTiltStub : public virtual ::rr::Stub {`
  std::string skeleton_head;
  std::string default_head;
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
  std::string declaration;  ///< `class PanTiltStub;`
};

struct ImportView {
  std::string wire_name;
  std::string header;      ///< `example/geometry.hpp`
  std::string definition;  ///< `::example::geometry::rr_definition`
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
  std::vector<std::string> import_rows;  ///< of the array of imported definitions
  std::vector<std::string> record_rows;  ///< of the array of records
  std::vector<std::string> exception_rows;
  std::vector<std::string> object_rows;
  std::vector<std::string> text;  ///< the definition's text as C++ literals, to be put in a row
  std::string version;            ///< `{0, 10, 0, 0}`
};

/// Everything that is generated for.
struct ModelView {
  std::vector<DefinitionView> definitions;
};

/// Builds the view. Reports R0901 to R0904.
ModelView make_view(const model::Model& model, Report& report);

}  // namespace robdef::cpp
