// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "compiler/backends/member_facts.hpp"
#include "compiler/diagnostics/report.hpp"
#include "compiler/model/model.hpp"

/// What templates can print of a definition in C#. Texts are finished; what has several lines
/// begins each but the first with its blanks. `robdef view --lang csharp` prints it all as JSON.
namespace robdef::csharp {

/// A constant of a definition, record or object.
struct ConstantView {
  std::string wire_name;         ///< as in the definition
  std::string name;              ///< in C#
  std::vector<std::string> doc;  ///< lines with their `///`
  std::string definition;        ///< `public const double Pi = 3.14;`
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
  std::vector<std::string> doc;
  std::vector<EnumValueView> values;
};

struct ExceptionView {
  std::string wire_name;  ///< qualified: `example.Fault`
  std::string name;
  std::vector<std::string> doc;
};

struct FieldView {
  std::string wire_name;
  std::string name;
  std::vector<std::string> doc;
  std::string type;         ///< `List<double[]>?`
  std::string initial;      ///< behind a property: ` = [];`
  std::string codec;        ///< `ValueCodec.Double.Array`
  std::string robdef_type;  ///< as in the definition, with qualified names
  std::string items;        ///< namedarray: the struct that holds a row of items; else empty
  std::string item_type;    ///< of such a row
  std::string item_count;
};

/// A struct, pod or namedarray.
struct RecordView : RecordFacts {
  std::string name;
  std::vector<std::string> doc;
  std::string number_type;   ///< namedarray: of its numbers, `double`
  std::string number_codec;  ///< namedarray
  std::string packed_size;   ///< pod: most bytes of one in message version 2
  std::vector<ConstantView> constants;
  std::vector<FieldView> fields;
  std::vector<FieldView> writes;  ///< the fields from the last to the first
  bool has_rows = false;          ///< namedarray: a field is a row of items
  std::string field_count;
  std::string codec_class;  ///< `RrAnglesCodec`
};

struct ParameterView : ParameterFacts {
  std::string type;
  std::string codec;
};

/// A member of an object. What does not apply to its kind is empty or false.
struct MemberView : MemberFacts {
  std::string name;   ///< `MoveTo`
  std::string place;  ///< its name among the places in the object's table
  std::vector<std::string> doc;
  bool is_hiding = false;  ///< two implemented interfaces have it: declared anew
  std::string row;         ///< of that table
  std::string access;      ///< `MemberAccess.ReadOnly | MemberAccess.NoLock`

  std::string type;  ///< property, pipe, wire: the value; function, callback: the result
  std::string codec;
  std::string initial;  ///< property: what a Default class begins with
  std::string item;     ///< memory: one of its items, `double`
  std::string item_codec;
  std::vector<ParameterView> parameters;
  std::vector<ParameterView> writes;  ///< the parameters from the last to the first
  std::string signature;              ///< `double pan, double tilt`
  std::string signature_before;       ///< the same with `, ` after it, unless it is empty
  std::string arguments;              ///< `pan, tilt`
  std::string arguments_before;       ///< the same with `, ` after it, unless it is empty
  std::string cancel;                 ///< a name for the token behind the parameters
  std::string client;                 ///< a name for the client before the parameters
  std::string urgent;                 ///< `, MemberAccess.Urgent` or empty
  std::string handler;                ///< event, callback: the delegate
  std::string task;                   ///< function, callback: what an asynchronous one gives
  std::string result;                 ///< `double`, `void`, `Generator<double>`
  std::string served;                 ///< function: what the skeleton's member gives
  std::string served_before;          ///< function: what it takes, with `, ` after it likewise
  std::string served_cancel;          ///< a name for the token behind that
  std::string invocation;             ///< function: `RrCallMoveTo(pan, tilt)`
  std::string verb;                   ///< `Run`, `Open`, `OpenSink`, `OpenFilter`
  std::string codecs;  ///< what the verb gets before the token: `ValueCodec.Double, `
  std::string answer;  ///< what the answer gets behind the value: `, ValueCodec.Double`
  std::optional<ParameterView> generator_parameter;  ///< what each step takes

  std::string interface;  ///< objref: what it gives
  std::string stub;
  std::string index_parameter;  ///< `int index, `
  std::string index_argument;   ///< `index`, or `ObjectIndex.None`
  std::string index_type;       ///< `int index`, or empty
  std::string index_read;       ///< `rrRequest.IndexNumber`
  std::string handle;           ///< pipe, wire, memory: the stub's type
  std::string handle_served;    ///< the skeleton's
  std::string first;            ///< property: the value a Default class begins with
};

struct ObjectView {
  std::string wire_name;         ///< qualified: `example.PanTilt`
  std::string short_name;        ///< `PanTilt`
  std::vector<std::string> doc;  ///< of the interface
  std::string interface;         ///< `IPanTilt`
  std::string bases;             ///< ` : ISensor, IMemories`
  std::string stub;
  std::string skeleton;
  std::string default_class;
  bool has_default = false;
  std::vector<ConstantView> constants;
  std::vector<MemberView> members;
  bool has_members = false;   ///< served ones
  bool has_requests = false;  ///< properties, functions or objrefs are served
  bool has_memories = false;
};

/// A declaration in the order of the definition: one of these is there.
struct DeclarationView {
  std::optional<ExceptionView> exception;
  std::optional<EnumView> enumeration;
  std::optional<RecordView> record;
  std::optional<ObjectView> object;
};

/// Types of the libraries, by their names or, where these mean something else here, in full.
struct LibraryView {
  std::string task;
  std::string value_task;
  std::string token;
  std::string async_enumerable;
  std::string stub;
  std::string stub_type;
  std::string object_handle;
  std::string skeleton;
  std::string call;
  std::string request;
  std::string served_type;
  std::string served_member;
  std::string served_memory;
  std::string stored;
  std::string stored_per_client;
  std::string stored_memory;
  std::string not_implemented;
};

struct CodecView {
  std::string name;
  std::string type;
  std::string value;
};

/// One service definition.
struct DefinitionView {
  std::string wire_name;  ///< `experimental.mount`
  std::string space;      ///< `Experimental.Mount`
  std::vector<std::string> doc;
  std::vector<std::string> usings;  ///< `System.Threading`
  LibraryView library;
  std::string value_codec;   ///< `ValueCodec`
  std::string struct_codec;  ///< and so on
  std::string pod_codec;
  std::string namedarray_codec;
  std::string element_writer;
  std::string field_reader;
  std::string error;
  std::string error_code;
  std::string varvalue;
  std::string service_definition;
  std::string exception_type;
  std::string stub_api;
  bool has_objects = false;
  std::vector<std::string> imports;  ///< `global::Example.Geometry.RrDefinition.Value`
  std::vector<ConstantView> constants;
  bool has_constants = false;
  std::vector<DeclarationView> declarations;
  std::vector<CodecView> codecs;
  bool has_codecs = false;
  bool has_fields = false;        ///< of a struct or pod
  std::vector<std::string> text;  ///< the definition's text, a literal a line
};

/// Everything that is generated for.
struct ModelView {
  std::vector<DefinitionView> definitions;
};

/// Builds the view. Reports R0901 to R0904.
ModelView make_view(const model::Model& model, Report& report);

}  // namespace robdef::csharp
