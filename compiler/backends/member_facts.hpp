// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/model/model.hpp"
#include "compiler/output/view_type.hpp"

/// What the views of all languages say alike. A language's view of a member derives from these and
/// adds its own words.
namespace robdef {

struct Abilities;

/// What a member is, and what it is called on the wire.
struct MemberKindFacts {
  using Facts = MemberKindFacts;

  std::string wire_name;
  std::string kind;  ///< `property`, `function`, ...
  bool is_property = false;
  bool is_function = false;
  bool is_event = false;
  bool is_objref = false;
  bool is_pipe = false;
  bool is_callback = false;
  bool is_wire = false;
  bool is_memory = false;

  template <class View>
  static ViewType fields() {
    return {ROBDEF_VIEW_FIELDS(View, wire_name, kind, is_property, is_function, is_event, is_objref,
                               is_pipe, is_callback, is_wire, is_memory)};
  }
};

/// A member of an object, with its modifiers. What does not apply to its kind is empty or false.
struct MemberFacts : MemberKindFacts, model::Access {
  using Facts = MemberFacts;

  bool is_served = false;     ///< false: the runtime cannot do it, and nothing is generated
  bool is_inherited = false;  ///< an object that this one implements has it
  std::string number;         ///< its place in the object's table: of those that are served

  bool can_get = false;  ///< property: not writeonly
  bool can_set = false;  ///< property: not readonly

  std::string robdef_type;  ///< as in the definition, with qualified names
  bool has_result = false;  ///< function, callback: not void; what has values: true
  bool has_parameters = false;
  bool is_multi = false;  ///< memory: of several dimensions

  bool is_generator = false;
  bool is_source = false;  ///< generator: gives values only
  bool is_sink = false;    ///< generator: takes values only
  bool is_filter = false;  ///< generator: both

  std::string object_type;  ///< objref: qualified, `example.PanTilt`; empty for varobject
  bool is_varobject = false;
  bool has_index = false;  ///< objref
  bool has_int32_index = false;
  bool has_string_index = false;

  template <class View>
  static ViewType fields() {
    return fields_behind<MemberKindFacts, View>({ROBDEF_VIEW_FIELDS(
        View, is_served, is_inherited, number, is_readonly, is_writeonly, is_unreliable, is_nolock,
        is_nolockread, is_perclient, is_urgent, can_get, can_set, robdef_type, has_result,
        has_parameters, is_multi, is_generator, is_source, is_sink, is_filter, object_type,
        is_varobject, has_index, has_int32_index, has_string_index)});
  }
};

/// A parameter of a member.
struct ParameterFacts {
  using Facts = ParameterFacts;

  std::string wire_name;
  std::string name;  ///< in the language; of a variable
  std::string robdef_type;

  template <class View>
  static ViewType fields() {
    return {ROBDEF_VIEW_FIELDS(View, wire_name, name, robdef_type)};
  }
};

/// A struct, pod or namedarray.
struct RecordFacts {
  using Facts = RecordFacts;

  std::string wire_name;  ///< qualified: `example.Angles`
  std::string kind;       ///< `struct`, `pod`, `namedarray`
  bool is_struct = false;
  bool is_pod = false;
  bool is_namedarray = false;
  std::string number_count;  ///< namedarray: of its numbers
  bool has_fields = false;

  template <class View>
  static ViewType fields() {
    return {ROBDEF_VIEW_FIELDS(View, wire_name, kind, is_struct, is_pod, is_namedarray,
                               number_count, has_fields)};
  }
};

/// The modifiers of a member that are set, by the language's words for readonly, writeonly,
/// unreliable, nolock, nolockread, perclient and urgent.
std::vector<std::string> access_words(const model::Access& access,
                                      const std::array<std::string_view, 7>& words);

void describe(MemberKindFacts& facts, const model::Member& member);
/// All but the number, which only who lists the members knows.
void describe(MemberFacts& facts, const model::Object& object, const model::Member& member,
              const Abilities& abilities);
/// With the name that the language has for it.
void describe(ParameterFacts& facts, const model::Parameter& parameter, std::string name);
void describe(RecordFacts& facts, const model::Record& record);

}  // namespace robdef
