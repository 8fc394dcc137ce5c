// SPDX-License-Identifier: Apache-2.0
// The view of an object's members: what they are and how it is called. Their lines are made by
// member_lines.hpp.
#include <algorithm>
#include <map>
#include <utility>
#include <variant>

#include "compiler/backends/cpp/backend.hpp"
#include "compiler/backends/cpp/member_lines.hpp"
#include "compiler/backends/cpp/view_parts.hpp"
#include "compiler/backends/implements.hpp"
#include "compiler/backends/member_facts.hpp"

namespace robdef::cpp {
namespace {

using model::Member;
using model::MemberKind;
using model::Object;
using model::Type;

class MemberMaker {
 public:
  MemberMaker(const Object& object, const Context& context)
      : object_(object), context_(context), hidden_(names_inside(object)) {}

  void make(ObjectView& object) {
    std::vector<MemberView>& views = object.members;
    std::set<std::string> places;
    std::size_t served = 0;
    for (const Member& member : object_.members) {
      MemberView view = common(member);
      if (view.is_served) {
        view.number = std::to_string(served++);
        view.place = context_.names.local(code_name(member), places);
      } else {
        report_unserved(member, "C++", context_.report);
      }
      make_value(view, member);
      if (view.is_served) make_served(view, member);
      views.push_back(std::move(view));
    }
  }

 private:
  MemberView common(const Member& member) {
    MemberView view;
    describe(view, object_, member, runtime_abilities);
    view.name = member_name(object_, member);
    view.doc = doc_lines(member.documentation, class_indent);
    return view;
  }

  /// Types, parameters and names.
  void make_value(MemberView& view, const Member& member) {
    std::set<std::string> taken;
    for (const model::Parameter& parameter : member.parameters) {
      view.parameters.push_back(make_parameter(parameter, taken));
    }
    if (member.generator_parameter) {
      view.generator_parameter = make_parameter(*member.generator_parameter, taken);
    }
    view.yields = view.is_source || view.is_filter;
    constexpr std::string_view token = "Token";
    view.type_mark = context_.names.local(token, taken).substr(token.size());
    view.code = code_name(member);
    if (member.kind == MemberKind::objref) {
      make_reference(view, member);
    } else if (member.kind != MemberKind::event) {
      const CppType type = spell(member.type);
      view.type = type.text;
      view.is_by_value = type.is_by_value;
      view.descriptor = type.descriptor;
      constexpr std::string_view value = "value";
      const std::string name = context_.names.local(value, taken);
      view.value_mark = name.substr(value.size());
      if (view.is_property) {
        view.variable = {.type = type.text, .name = name, .initial = type.initial};
      }
      if (view.is_memory) make_item(view, member);
      include_for(view);
    }
  }

  ParameterView make_parameter(const model::Parameter& parameter, std::set<std::string>& taken) {
    const CppType type = spell(parameter.type);
    ParameterView view;
    describe(view, parameter, context_.names.local(code_name(parameter), taken));
    view.type = type.text;
    view.is_by_value = type.is_by_value;
    view.initial = type.initial;
    view.descriptor = type.descriptor;
    return view;
  }

  void make_reference(MemberView& view, const Member& member) {
    if (view.has_int32_index) context_.types.include("<cstdint>");
    if (view.has_string_index) context_.types.include("<string>");
    context_.types.include("<memory>");
    if (const auto* object = std::get_if<const Object*>(&member.type.base)) {
      const Object& target = **object;
      view.stub = context_.names.object_class(target, stub_name(target), hidden_);
      view.skeleton = context_.names.object_class(target, skeleton_name(target), hidden_);
      view.qualified_stub = qualified(*target.definition, stub_name(target));
      view.qualified_skeleton = qualified(*target.definition, skeleton_name(target));
    } else {
      view.stub = view.qualified_stub = "::rr::Stub";
      view.skeleton = view.qualified_skeleton = "::rr::Skeleton";
    }
  }

  void make_item(MemberView& view, const Member& member) {
    Type item = member.type;
    item.container = model::ContainerForm::none;
    item.array = model::ArrayForm::none;
    view.item = spell(item).text;
  }

  /// The headers that a kind needs beside those of every object.
  void include_for(const MemberView& view) {
    if (!view.is_served) return;
    if (view.is_pipe) context_.types.include("<rr/pipes.hpp>");
    if (view.is_wire) context_.types.include("<rr/wires.hpp>");
    if (view.is_memory) context_.types.include("<rr/memories.hpp>");
    if (view.is_generator) context_.types.include("<rr/generators.hpp>");
    if (view.is_callback) {
      context_.types.include("<cstdint>");
      context_.types.include("<rr/callbacks.hpp>");
    }
  }

  CppType spell(const Type& type) { return context_.types.spell(type, {.hidden = &hidden_}); }

  void make_served(MemberView& view, const Member& member) {
    make_row(view, access_words(member.access, {"readonly", "writeonly", "unreliable", "nolock",
                                                "nolockread", "perclient", "urgent"}));
    make_forms(view, context_.names);
  }

  const Object& object_;
  const Context& context_;
  std::set<std::string> hidden_;
};

}  // namespace

void make_members(ObjectView& view, const Object& object, const Context& context) {
  MemberMaker(object, context).make(view);
}

}  // namespace robdef::cpp
