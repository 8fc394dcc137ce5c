// SPDX-License-Identifier: Apache-2.0
// The view of an object around its members.
#include <algorithm>

#include "compiler/backends/csharp/view_parts.hpp"
#include "compiler/backends/words.hpp"

namespace robdef::csharp {
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

}  // namespace

ObjectView make_object(const Object& object, const Context& context) {
  ObjectView view;
  view.wire_name = object.qualified_name();
  view.short_name = object.name;
  view.interface = interface_name(object);
  view.stub = stub_name(object);
  view.skeleton = skeleton_name(object);
  view.default_class = default_name(object);
  view.has_default = has_default(object);
  std::vector<std::string> bases;
  for (const Object* base : object.implements) {
    bases.push_back(context.names.type(*base->definition, interface_name(*base)));
  }
  if (!bases.empty()) view.bases = " : " + join(bases, ", ");
  view.constants = make_constants(object.constants, "", context, in_class);
  make_members(view, object, context);
  view.has_requests = std::ranges::any_of(view.members, [](const MemberView& member) {
    return member.is_served && (member.is_property || member.is_function || member.is_objref);
  });
  view.has_memories = std::ranges::any_of(
      view.members, [](const MemberView& member) { return member.is_served && member.is_memory; });
  view.doc = summary(interface_doc(view, object), 0);
  return view;
}

}  // namespace robdef::csharp
