// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "compiler/backends/member_facts.hpp"
#include "compiler/diagnostics/report.hpp"
#include "compiler/model/model.hpp"

/// What templates can print of a definition in TypeScript. Texts are finished; what has several
/// lines begins each but the first with its blanks. `robdef view --lang typescript` prints it all
/// as JSON.
namespace robdef::typescript {

/// A constant of a definition, record or object.
struct ConstantView {
  std::string wire_name;         ///< as in the definition
  std::string name;              ///< in TypeScript
  std::string key;               ///< in the object that holds those of a record or object
  std::vector<std::string> doc;  ///< lines of a comment
  std::string value;             ///< `3.14`
  std::string definition;        ///< `PI = 3.14`
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
  bool has_values = false;
};

struct ExceptionView {
  std::string wire_name;  ///< qualified: `example.Fault`
  std::string short_name;
  std::string name;
  std::vector<std::string> doc;
};

struct FieldView {
  std::string wire_name;
  std::vector<std::string> doc;
  std::string type;         ///< `Float64Array`
  std::string robdef_type;  ///< as in the definition, with qualified names
};

/// A struct, pod or namedarray.
struct RecordView : RecordFacts {
  std::string name;
  std::vector<std::string> doc;
  std::string number_row;  ///< namedarray: what holds its numbers, `Float64Array`
  std::string constants_name;
  std::vector<ConstantView> constants;
  bool has_constants = false;
  std::vector<FieldView> fields;
};

struct ParameterView : ParameterFacts {
  std::string type;  ///< what comes
  std::string sent;  ///< what is taken
};

/// A member of an object. What does not apply to its kind is empty or false.
struct MemberView : MemberFacts {
  std::string name;              ///< `moveTo`
  std::string get_name;          ///< property, objref: `getSpeed`
  std::string set_name;          ///< property: `setSpeed`
  std::vector<std::string> doc;  ///< in the interfaces
  bool is_request = false;       ///< property, function, objref: services have methods for it

  std::string type;  ///< the value or result as it comes
  std::string sent;  ///< and what is taken for it
  std::vector<ParameterView> parameters;
  std::string call_signature;    ///< client: `pan: number, tilt: number, options?: rr.CallOptions`
  std::string served_signature;  ///< service: `pan: number, tilt: number, caller: rr.Caller`
  std::string arguments;         ///< `pan, tilt`
  std::string options;           ///< a name for the options behind the parameters
  std::string result;            ///< function: what the client's method gives
  std::string served_result;     ///< function, objref: what the service's method gives
  std::string call;              ///< function: `rr_call`, `rr_generate` or `rr_open`
  std::string come_types;        ///< event, callback: `pan: number, tilt: number`, as they come
  std::string sent_types;        ///< and as they are sent

  std::string interface;      ///< objref: what it gives
  std::string stub;           ///< empty for varobject
  std::string skeleton;       ///< empty for varobject
  std::string index;          ///< objref: `index: number`, or empty
  std::string index_more;     ///< the same with `, ` after it
  std::string handle;         ///< event, pipe, wire, callback, memory: the stub's type
  std::string handle_served;  ///< the skeleton's
  std::string handle_call;    ///< `rr_pipe`
  std::string served_call;    ///< the same for the skeleton
};

struct ObjectView {
  std::string wire_name;         ///< qualified: `example.PanTilt`
  std::string short_name;        ///< `PanTilt`
  std::vector<std::string> doc;  ///< of the interface
  std::string name;              ///< `PanTilt`
  std::string extends;           ///< ` extends Sensor, base.Named`
  std::string service_extends;   ///< `SensorService, base.NamedService, `
  std::string implements;        ///< of the stub: ` implements PanTilt`
  std::string alias;             ///< where the interface would have no member: what it is instead
  std::string stub;
  std::string service;
  std::string skeleton;
  std::string constants_name;
  std::vector<ConstantView> constants;
  bool has_constants = false;
  std::vector<MemberView> members;
  bool has_requests = false;  ///< services have methods for members
};

/// A declaration in the order of the definition: one of these is there.
struct DeclarationView {
  std::optional<ExceptionView> exception;
  std::optional<EnumView> enumeration;
  std::optional<RecordView> record;
  std::optional<ObjectView> object;
};

struct ImportView {
  std::string wire_name;  ///< `example.geometry`
  std::string alias;      ///< `geometry`
};

/// One service definition.
struct DefinitionView {
  std::string wire_name;  ///< `experimental.mount`
  std::vector<std::string> doc;
  std::vector<ImportView> imports;
  std::string import_modules;  ///< `geometry.rr_module, image.rr_module`
  std::vector<ConstantView> constants;
  bool has_exceptions = false;
  std::vector<DeclarationView> declarations;
  std::string promise;            ///< `Promise`
  std::vector<std::string> text;  ///< the definition's text, a literal a line
};

/// Everything that is generated for.
struct ModelView {
  std::vector<DefinitionView> definitions;
};

/// Builds the view. Reports R0901 to R0904.
ModelView make_view(const model::Model& model, Report& report);

}  // namespace robdef::typescript
