// SPDX-License-Identifier: Apache-2.0
// The view of an object: its classes and tables.
#include <algorithm>
#include <utility>

#include "compiler/backends/cpp/view_parts.hpp"
#include "compiler/backends/words.hpp"

namespace robdef::cpp {
namespace {

/// The first sentence is ours, the rest the definition's.
std::vector<std::string> class_doc(const std::string& sentence, const std::string& documentation,
                                   const std::string& left_out) {
  std::string text = sentence;
  if (!documentation.empty()) text += "\n\n" + documentation;
  if (!left_out.empty()) text += "\n\n" + left_out;
  return doc_lines(text, 0);
}

std::string left_out_text(const std::vector<MemberView>& members) {
  std::vector<std::string> names;
  for (const MemberView& member : members) {
    if (member.is_served) continue;
    names.push_back(member.kind + " " + member.wire_name);
  }
  if (names.empty()) return "";
  return "Left out, because this runtime does not serve them: " + join(names, ", ") + ".";
}

void make_docs(ObjectView& view, const model::Object& object) {
  const std::string left_out = left_out_text(view.members);
  const std::string& name = object.name;
  view.stub_doc = class_doc("A " + name + " on another node.", object.documentation, left_out);
  view.skeleton_doc =
      class_doc("Serves one " + name + ": derive from it and implement its members.",
                object.documentation, left_out);
  const bool has_properties = std::ranges::any_of(view.members, &MemberView::is_property);
  view.has_stored = has_properties || view.has_memories;
  std::string text = "A " + name;
  if (view.has_stored) {
    text += !has_properties     ? " that stores its memories."
            : view.has_memories ? " that stores the values of its properties and its memories."
                                : " that stores the values of its properties.";
    text += " Functions and objrefs fail until they are overridden.";
  } else {
    text += " whose functions and objrefs fail until they are overridden.";
  }
  view.default_doc = class_doc(text, "", "");
}

void make_bases(ObjectView& view, const model::Object& object, const Context& context) {
  for (const model::Object* base : object.implements) {
    const bool is_own = base->definition == object.definition;
    view.implements.push_back(
        {.wire_name = is_own ? base->name : base->qualified_name(),
         .stub = context.names.object_class(*base, stub_name(*base), {}),
         .skeleton = context.names.object_class(*base, skeleton_name(*base), {})});
  }
  view.has_implements = !view.implements.empty();
}

void make_names(ObjectView& view, const model::Object& object) {
  view.wire_name = object.qualified_name();
  view.short_name = object.name;
  view.name = identifier(code_name(object));
  view.stub = view.stub_class = stub_name(object);
  view.skeleton = skeleton_name(object);
  view.default_class = default_name(object);
  view.qualified_stub = qualified(*object.definition, view.stub);
  view.qualified_skeleton = qualified(*object.definition, view.skeleton);
  view.qualified_default = qualified(*object.definition, view.default_class);
  view.has_default = has_default(object);
  view.table = table_name("object", object.name);
  view.member_table = table_name("members", object.name);
  view.implements_table = table_name("implements", object.name);
  view.parameter_tables = table_name("parameters", object.name);
}

void make_counts(ObjectView& view) {
  const auto has = [&](auto is_wanted) {
    return std::ranges::any_of(view.members, [&](const MemberView& member) {
      return member.is_served && is_wanted(member);
    });
  };
  view.has_members = has([](const MemberView&) { return true; });
  view.has_parameters = has([](const MemberView& member) { return member.has_parameters; });
  view.has_calls =
      has([](const MemberView& member) { return member.is_property || member.is_function; });
  view.has_objrefs = has([](const MemberView& member) { return member.is_objref; });
  view.uses_index = has([](const MemberView& member) { return member.has_index; });
  view.has_memories = has([](const MemberView& member) { return member.is_memory; });
}

}  // namespace

ObjectView make_object(const model::Object& object, const Context& context) {
  ObjectView view;
  make_names(view, object);
  make_bases(view, object, context);
  check_members(object, context.report);
  view.constants = class_constants(object.constants, context);
  view.has_constants = !view.constants.empty();
  make_members(view, object, context);
  make_counts(view);
  make_docs(view, object);
  return view;
}

}  // namespace robdef::cpp
