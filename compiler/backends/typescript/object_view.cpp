// SPDX-License-Identifier: Apache-2.0
// The view of an object around its members.
#include <algorithm>

#include "compiler/backends/typescript/view_parts.hpp"
#include "compiler/backends/words.hpp"

namespace robdef::typescript {
namespace {

using model::Object;

std::string interface_doc(const ObjectView& view, const Object& object) {
  std::vector<std::string> left_out;
  for (const MemberView& member : view.members) {
    if (!member.is_served) left_out.push_back(member.kind + " " + member.wire_name);
  }
  std::string text = object.documentation;
  if (!left_out.empty()) {
    if (!text.empty()) text += "\n\n";
    text += "Left out, because this runtime does not serve them: " + join(left_out, ", ") + ".";
  }
  return text;
}

/// An interface without members of its own is what it implements.
void make_interface(ObjectView& view, const std::vector<std::string>& bases) {
  const bool has_own = std::ranges::any_of(view.members, [](const MemberView& member) {
    return member.is_served && !member.is_inherited;
  });
  if (!bases.empty()) view.extends = " extends " + join(bases, ", ");
  if (!has_own) view.alias = bases.empty() ? "object" : join(bases, " & ");
  if (view.alias != "object") view.implements = " implements " + view.name;
}

}  // namespace

ObjectView make_object(const Object& object, const Context& context) {
  ObjectView view;
  view.wire_name = object.qualified_name();
  view.short_name = object.name;
  view.name = exported(code_name(object));
  view.stub = stub_name(object);
  view.service = service_name(object);
  view.skeleton = skeleton_name(object);
  view.constants_name = constants_name(code_name(object));
  view.constants = make_constants(object.constants, 2, view.wire_name, context.report);
  view.has_constants = !view.constants.empty();
  make_members(view, object, context);
  std::vector<std::string> bases;
  for (const Object* base : object.implements) {
    bases.push_back(context.names.of(*base->definition, exported(code_name(*base))));
    view.service_extends += context.names.of(*base->definition, service_name(*base)) + ", ";
  }
  make_interface(view, bases);
  view.has_requests = std::ranges::any_of(
      view.members, [](const MemberView& member) { return member.is_served && member.is_request; });
  view.doc = comment(interface_doc(view, object), 0);
  return view;
}

}  // namespace robdef::typescript
