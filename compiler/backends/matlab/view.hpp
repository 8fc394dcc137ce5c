// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "compiler/backends/member_facts.hpp"
#include "compiler/diagnostics/report.hpp"
#include "compiler/model/model.hpp"

/// What templates can print of a definition for MATLAB. Texts are finished; documentation is lines
/// without their marks, since a class's help and a member's differ in blanks only.
/// `robdef view --lang matlab` prints it all as JSON.
namespace robdef::matlab {

/// A constant of a definition, record or object, or a value of an enum.
struct ConstantView {
  std::string wire_name;         ///< as in the definition
  std::string name;              ///< in MATLAB
  std::vector<std::string> doc;  ///< lines with their `%`
  std::string value;             ///< `int32(4)`
};

struct EnumView {
  std::string wire_name;  ///< qualified
  std::string name;
  std::string qualified;          ///< as MATLAB calls it
  std::string title;              ///< the first line of its help
  std::vector<std::string> help;  ///< lines with their `%`
  std::vector<ConstantView> values;
  bool has_values = false;
};

struct ExceptionView {
  std::string wire_name;  ///< qualified
  std::string name;
  std::string title;
  std::vector<std::string> help;
  std::string identifier;  ///< `experimental:mount:Lost`
};

struct FieldView {
  std::string wire_name;
  std::string cpp_name;  ///< in the struct of the C++ backend
  std::string robdef_type;
  std::vector<std::string> help;  ///< a line with its declaration, then its documentation
};

/// A struct, pod or namedarray.
struct RecordView : RecordFacts {
  std::string name;
  std::string qualified;  ///< as MATLAB calls it
  std::string title;
  std::vector<std::string> help;
  std::string cpp;          ///< `::example::Angles`
  std::string number_type;  ///< namedarray: of its numbers in C++, `double`
  std::vector<FieldView> fields;
  std::vector<ConstantView> constants;
  bool has_constants = false;
  std::string constants_class;
};

/// A member of an object. What does not apply to its kind is empty or false.
struct MemberView : MemberFacts {
  std::string name;
  std::string get_name;           ///< `get_speed`
  std::string set_name;           ///< property: `set_speed`
  std::string async_wire_name;    ///< `async_get_speed`, as the runtime knows it
  std::string async_name;         ///< property: `async_get_speed`; function, objref likewise
  std::string async_set_name;     ///< property
  std::string title;              ///< the first line of a method's help: its documentation's
  std::vector<std::string> help;  ///< further lines, the declaration last
  std::vector<std::string> property_doc;  ///< lines with their `%`, the declaration last
  std::string declaration;                ///< `property double speed [readonly]`
  std::vector<ParameterFacts> parameters;
  std::string arguments;         ///< of its method, without the object: `pan, tilt`
  std::string arguments_behind;  ///< the same behind others: `, pan, tilt`
  std::string argument_cell;     ///< and as a cell: `{pan, tilt}`
  bool is_stream = false;        ///< pipe, callback, wire, memory: a property of the class
  std::string object_class;      ///< objref: what is generated for it; empty for what is not known
  std::string binding;           ///< its row in the client's table
};

struct ObjectView {
  std::string wire_name;   ///< qualified: `example.PanTilt`
  std::string short_name;  ///< `PanTilt`
  std::string name;        ///< of the class
  std::string qualified;   ///< as MATLAB calls it
  std::string title;
  std::vector<std::string> help;
  std::string stub;        ///< `::example::PanTiltStub`
  std::string stub_alias;  ///< `rr_stub_PanTilt`
  std::string table;       ///< `rr_table_PanTilt`: of its members in the client
  std::vector<ConstantView> constants;
  bool has_constants = false;
  std::vector<MemberView> members;
  bool has_members = false;     ///< served ones
  bool has_properties = false;  ///< members that are properties of the class
  bool has_methods = false;
};

/// A declaration in the order of the definition: one of these is there.
struct DeclarationView {
  std::optional<ExceptionView> exception;
  std::optional<EnumView> enumeration;
  std::optional<RecordView> record;
  std::optional<ObjectView> object;
};

/// One service definition.
struct DefinitionView {
  std::string wire_name;                    ///< `experimental.mount`
  std::string definition_file;              ///< `experimental.mount.robdef`
  std::string package;                      ///< `experimental.mount`, as MATLAB calls it
  std::string folder;                       ///< `+experimental/+mount`
  std::string path;                         ///< `experimental/mount`: of its C++ files
  std::string space;                        ///< `experimental::mount`
  std::vector<std::string> import_headers;  ///< `experimental/geometry.mex.hpp`
  std::vector<std::string> import_packages;
  std::vector<std::string> text;  ///< the definition's text, a literal a line
  std::vector<ConstantView> constants;
  bool has_constants = false;
  std::vector<DeclarationView> declarations;
  bool has_objects = false;
};

/// Everything that is generated for.
struct ModelView {
  std::string client;  ///< `experimental_mount_client`: the MEX file
  std::vector<DefinitionView> definitions;
};

/// Builds the view. Reports R0901 to R0904.
ModelView make_view(const model::Model& model, Report& report);

}  // namespace robdef::matlab
