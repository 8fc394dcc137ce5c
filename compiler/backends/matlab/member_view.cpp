// SPDX-License-Identifier: Apache-2.0
// The view of an object and its members: what they are, how it is called, and which method of the
// C++ stub the client calls for it.
#include <algorithm>
#include <set>
#include <utility>
#include <variant>

#include "compiler/backends/cpp/names.hpp"
#include "compiler/backends/implements.hpp"
#include "compiler/backends/matlab/backend.hpp"
#include "compiler/backends/matlab/names.hpp"
#include "compiler/backends/matlab/view_parts.hpp"
#include "compiler/backends/member_facts.hpp"
#include "compiler/backends/words.hpp"
#include "compiler/model/print.hpp"

namespace robdef::matlab {
namespace {

using model::Member;
using model::Object;

/// Whether a value of the type may hold a varvalue, which only the runtime knows how to convert.
bool has_varvalue(const model::Type& type, std::set<const model::Record*>& seen) {
  if (std::holds_alternative<model::VarValue>(type.base)) return true;
  const auto* record = std::get_if<const model::Record*>(&type.base);
  if (record == nullptr || !seen.insert(*record).second) return false;
  return std::ranges::any_of(
      (*record)->fields, [&](const model::Field& field) { return has_varvalue(field.type, seen); });
}

bool has_varvalue(const Member& member) {
  std::set<const model::Record*> seen;
  return has_varvalue(member.type, seen) ||
         std::ranges::any_of(member.parameters, [&](const model::Parameter& parameter) {
           return has_varvalue(parameter.type, seen);
         });
}

std::string stub_alias(const Object& object) { return "rr_stub_" + object.name; }

class MemberMaker {
 public:
  MemberMaker(const Object& object, Report& report) : object_(object), report_(report) {}

  MemberView make(const Member& member) {
    MemberView view;
    describe(view, object_, member, runtime_abilities);
    view.name = member_name(code_name(member), type_name(code_name(object_)));
    if (view.is_objref) view.name = "get_" + code_name(member);
    view.declaration = model::written(member, *object_.definition);
    // A generator function has one whatever its steps give.
    view.has_result = view.has_result || view.is_generator;
    view.is_stream = view.is_pipe || view.is_wire || view.is_memory || view.is_callback;
    make_names(view, member);
    make_parameters(view, member);
    make_help(view, member);
    if (view.is_served) {
      view.number = std::to_string(served_++);
      view.binding = binding(view, member);
    } else {
      report_unserved(member, language, report_);
    }
    return view;
  }

 private:
  static void make_names(MemberView& view, const Member& member) {
    const std::string& name = code_name(member);
    view.get_name = "get_" + name;
    view.set_name = "set_" + name;
    const bool is_got = view.is_property || view.is_objref;
    const std::string verb = is_got ? "get_" : "";
    if (is_got || view.is_function) {
      view.async_name = "async_" + verb + name;
      view.async_wire_name = "async_" + verb + member.name;
    }
    if (view.is_property) view.async_set_name = "async_set_" + name;
    const auto* target = std::get_if<const Object*>(&member.type.base);
    // Nothing is generated for imports: their objects are dynamic ones.
    if (view.is_objref && target != nullptr && !(*target)->definition->is_import) {
      view.object_class = qualified(*(*target)->definition, type_name(code_name(**target)));
    }
  }

  static void make_parameters(MemberView& view, const Member& member) {
    // What the body of a method is called by.
    std::set<std::string> taken{"obj", "result", "handler", "varargin"};
    std::vector<std::string> names;
    for (const model::Parameter& parameter : member.parameters) {
      describe(view.parameters.emplace_back(), parameter, local(code_name(parameter), taken));
      names.push_back(view.parameters.back().name);
    }
    if (view.has_index) names.emplace_back("index");
    view.arguments = join(names, ", ");
    view.argument_cell = "{" + view.arguments + "}";
    view.arguments_behind = (names.empty() ? "" : ", ") + view.arguments;
  }

  static void make_help(MemberView& view, const Member& member) {
    const std::string& name = view.name;
    Help text = help(name, member.documentation, view.declaration);
    view.title = std::move(text.title);
    view.help = std::move(text.lines);
    if (!member.documentation.empty()) view.help.push_back("%   " + view.declaration);
    view.property_doc = comment(member.documentation);
    view.property_doc.push_back("% " + view.declaration);
  }

  /// Properties and functions are called by their types; what lives longer than a call, or has
  /// varvalues, is used by its name.
  [[nodiscard]] std::string binding(const MemberView& view, const Member& member) const {
    const std::string stub = stub_alias(object_);
    const auto method = [&](const std::string& name) { return "&" + stub + "::" + name; };
    const std::string name = "(\"" + member.name + "\"),";
    const bool is_call = (view.is_property || view.is_function) && !view.is_generator;
    if (!is_call || has_varvalue(member)) return "::rr::matlab::named_member" + name;
    if (view.is_property) {
      return "::rr::matlab::typed_property<" + stub + ", " +
             (view.can_get ? method("get_" + code_name(member)) : "nullptr") + ", " +
             (view.can_set ? method("set_" + code_name(member)) : "nullptr") + ">" + name;
    }
    return "::rr::matlab::typed_function<" + stub + ", " +
           method(cpp::member_name(object_, member)) + ">" + name;
  }

  const Object& object_;
  Report& report_;
  std::size_t served_ = 0;
};

/// What the help of the class ends with: members that are no properties or methods of it.
void add_remarks(ObjectView& view) {
  std::vector<std::string> events;
  std::vector<std::string> left_out;
  for (const MemberView& member : view.members) {
    if (!member.is_served) left_out.push_back(member.kind + " " + member.wire_name);
    if (member.is_event && member.is_served) events.push_back(member.declaration);
  }
  if (!events.empty()) {
    view.help.emplace_back("%");
    view.help.emplace_back(
        "%   listener = addlistener(object, NAME, FUNCTION) calls a function for");
    for (const std::string& event : events) view.help.push_back("%       " + event);
  }
  if (!left_out.empty()) {
    view.help.emplace_back("%");
    view.help.push_back(
        "%   Left out, because the runtime does not serve them: " + join(left_out, ", ") + ".");
  }
}

}  // namespace

void make_members(ObjectView& view, const Object& object, Report& report) {
  MemberMaker maker(object, report);
  for (const Member& member : object.members) view.members.push_back(maker.make(member));
}

ObjectView make_object(const Object& object, Report& report) {
  ObjectView view;
  view.wire_name = object.qualified_name();
  view.short_name = object.name;
  view.name = type_name(code_name(object));
  view.qualified = qualified(*object.definition, view.name);
  view.stub = cpp::qualified(*object.definition, cpp::stub_name(object));
  view.stub_alias = stub_alias(object);
  view.table = "rr_table_" + object.name;
  Help text = help(view.name, object.documentation, "A " + object.name + " on another node.");
  view.title = std::move(text.title);
  view.help = std::move(text.lines);
  view.constants = make_constants(object.constants, view.name);
  view.has_constants = !view.constants.empty();
  make_members(view, object, report);
  for (const MemberView& member : view.members) {
    if (!member.is_served) continue;
    view.has_members = true;
    if (member.is_function || member.is_objref) {
      view.has_methods = true;
    } else if (!member.is_event) {
      view.has_properties = true;
    }
  }
  add_remarks(view);
  return view;
}

}  // namespace robdef::matlab
