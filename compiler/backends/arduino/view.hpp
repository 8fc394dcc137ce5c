// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "compiler/backends/member_facts.hpp"
#include "compiler/diagnostics/report.hpp"
#include "compiler/model/model.hpp"

/// What the templates print. All texts are C++ as it stands in the sketch.
namespace robdef::arduino {

struct ParameterView {
  std::string type;  ///< of a variable
  std::string name;
};

struct MemberView : MemberKindFacts {
  std::string number;  ///< its place in the object
  // What kind it is.

  bool can_get = false;  ///< a client reads: property, wire; a pipe that sends
  bool can_set = false;  ///< a client writes
  bool has_result = false;
  bool is_indexed = false;
  bool has_parameters = false;
  std::string value_type;    ///< property, wire, pipe; result of functions and callbacks
  std::string value_passed;  ///< the same as a parameter
  std::vector<ParameterView> parameters;
  std::string declared;   ///< parameters as a hook or sender declares them: `double pan, Mode mode`
  std::string arguments;  ///< what a function's hook is called with: `pan, mode, result`

  // Names of hooks, the sketch's functions, and of what sends.
  std::string getter;  ///< property, wire
  std::string setter;  ///< property, wire; pipe: for a packet
  std::string hook;    ///< function; objref; callback: for the answer
  std::string sender;  ///< event, pipe, callback: sends one; wire: says it has changed
  std::string field;   ///< where the drafted sketch keeps the value of a property or wire

  std::string child_first_plus;         ///< objref: number of the first object: `3 + `, or nothing
  std::string child_index;              ///< which of its group it is: `index * 2 + which`
  std::string child_count;              ///< for each object of this group
  std::string child_class;              ///< template parameter of the objects
  std::string child_find;               ///< function of the service that finds one
  std::string slot_plus;                ///< wire and pipe: number of the first: `3 + `, or nothing
  std::string slot_minus;               ///< the same, subtracted: ` - 3`, or nothing
  std::string slot_from;                ///< whether a slot is not below it: `slot >= 3 && `
  std::string slot_end;                 ///< behind the last
  std::vector<std::string> doc;         ///< the definition's words, as comment lines
  std::vector<std::string> hook_lines;  ///< the declarations of its hooks
};

struct GroupView {
  std::string name;          ///< `lamp`; `root` for the root
  std::string sender_class;  ///< of what sends: `LampSender`
  std::string handler;       ///< `handleLamp`
  std::string find;          ///< `findLamp`
  std::string device;        ///< template parameter: `LampDevice`
  std::string first_plus;    ///< number of the first object: `3 + `, or nothing
  std::string first_minus;   ///< the same, subtracted: ` - 3`, or nothing
  std::string end;           ///< behind the last
  std::string parent_find;
  std::string parent_index;  ///< of the parent of the object `index`: `index / 2`
  std::string own_index;     ///< for its parent: `index % 2`
  std::string hook;          ///< function of the parent's device that gives one
  bool is_root = false;
  bool is_indexed = false;
  bool is_several = false;
  bool uses_index = false;  ///< finding one needs its index
  std::vector<MemberView> members;
};

/// A class that the sketch has.
struct DeviceView {
  std::string parameter;  ///< `LampDevice`
  std::string name;       ///< what it is called in the draft: `Lamp`
  std::string wire_name;  ///< of the object
  std::vector<std::string> doc;
  std::vector<MemberView> members;
};

struct RecordView {
  std::string name;
  std::vector<std::string> doc;
  bool has_fields = false;
  std::vector<ParameterView> fields;
};
struct EnumView {
  std::string name;
  std::vector<std::string> doc;
  std::vector<std::string> values;  ///< `idle = 0,`
};

/// What one definition declares.
struct SpaceView {
  std::vector<std::string> opening;
  std::vector<std::string> closing;
  std::vector<std::string> doc;
  std::vector<std::string> constants;  ///< whole lines
  std::vector<EnumView> enums;
  std::vector<RecordView> records;
};

struct TextView {
  std::string name;
  std::vector<std::string> literals;
};

/// A sketch: one definition with objects.
struct ServiceView {
  std::string path;        ///< `example_light`
  std::string wire_name;   ///< of the definition
  std::string class_name;  ///< `LightService`
  std::string qualified;   ///< `example::light::LightService`
  std::vector<SpaceView> spaces;
  SpaceView own;                        ///< of the definition itself, behind those it imports
  std::vector<std::string> exceptions;  ///< whole lines
  std::vector<GroupView> groups;
  bool sends_wires = false;
  std::vector<DeviceView> devices;
  std::string root_device;          ///< template parameter of the root: `LightDevice`
  std::string template_parameters;  ///< `class LightDevice, class LampDevice`
  std::string template_arguments;   ///< `LightDevice, LampDevice`
  std::string draft_arguments;      ///< `Light, Lamp`
  std::vector<TextView> texts;
  std::string text_count;
  std::string hash;  ///< eight bytes
  std::string request_size;
  std::string reply_size;
  std::string out_size;
  std::string queue_size;
  std::string slots;
  std::string slot_bytes;
  std::string estimate;  ///< for the user, not for templates
};

struct ModelView {
  std::vector<ServiceView> services;
};

/// Reports R09xx.
ModelView make_view(const model::Model& model, Report& report);

}  // namespace robdef::arduino
