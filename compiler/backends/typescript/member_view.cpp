// SPDX-License-Identifier: Apache-2.0
// The view of the members of an object: what they are and how they are called.
#include <set>
#include <utility>
#include <variant>

#include "compiler/backends/implements.hpp"
#include "compiler/backends/member_facts.hpp"
#include "compiler/backends/typescript/backend.hpp"
#include "compiler/backends/typescript/view_parts.hpp"
#include "compiler/backends/words.hpp"

namespace robdef::typescript {
namespace {

using model::Member;
using model::MemberKind;
using model::Object;

/// `rr.Pipe<double>`
std::string runtime(std::string_view name, const std::string& argument) {
  return "rr." + std::string(name) + "<" + argument + ">";
}

std::string may_be_promise(const std::string& type) { return runtime("MaybePromise", type); }

class MemberMaker {
 public:
  MemberMaker(const Object& object, const Context& context)
      : object_(object), context_(context), taken_(typescript_language, context.report) {}

  void make(ObjectView& object) {
    for (const Member& member : object_.members) {
      MemberView view;
      describe(view, object_, member, runtime_abilities);
      if (view.is_served) {
        make_names(view, member);
        make_member(view, member);
      } else {
        report_unserved(member, "TypeScript", context_.report);
      }
      object.members.push_back(std::move(view));
    }
  }

 private:
  void make_names(MemberView& view, const Member& member) {
    view.doc = comment(member.documentation, 2);
    view.is_request = view.is_property || view.is_function || view.is_objref;
    if (view.is_property || view.is_objref) {
      view.name = camel(code_name(member));
      view.get_name = prefixed("get", code_name(member));
      view.set_name = prefixed("set", code_name(member));
      if (view.is_objref || view.can_get) take(view.get_name, member);
      if (view.is_property && view.can_set) take(view.set_name, member);
      return;
    }
    view.name = member_name(code_name(member), member.span, context_.report);
    take(view.name, member);
  }

  void take(const std::string& name, const Member& member) {
    taken_.add(name, member.span, model::name_of(member.kind), full_name(object_, member));
  }

  void make_member(MemberView& view, const Member& member) {
    make_parameters(view, member);
    if (!view.is_objref && !view.is_event) {
      TsType type = context_.types.spell(member.type);
      view.type = std::move(type.text);
      view.sent = std::move(type.sent);
    }
    switch (member.kind) {
      case MemberKind::property:
        break;
      case MemberKind::function:
        make_function(view, member);
        break;
      case MemberKind::event:
        make_handle(view, "event", "EventSource", "[" + view.come_types + "]", "ServedEvent",
                    "[" + view.sent_types + "]");
        break;
      case MemberKind::objref:
        make_reference(view, member);
        break;
      case MemberKind::pipe:
        make_handle(view, "pipe", "Pipe", view.type, "ServedPipe", view.type);
        break;
      case MemberKind::callback:
        make_handle(view, "callback", "Callback",
                    "(" + view.come_types + ") => " + may_be_promise(view.sent), "ServedCallback",
                    "[" + view.sent_types + "], " + view.type);
        break;
      case MemberKind::wire:
        make_handle(view, "wire", "Wire", view.type, "ServedWire", view.type);
        break;
      case MemberKind::memory:
        make_memory(view, member);
        break;
    }
  }

  void make_parameters(MemberView& view, const Member& member) {
    std::set<std::string> taken;
    std::vector<std::string> arguments;
    std::vector<std::string> come;
    std::vector<std::string> sent;
    for (const model::Parameter& parameter : member.parameters) {
      ParameterView one;
      describe(one, parameter, Names::local(code_name(parameter), taken));
      TsType type = context_.types.spell(parameter.type);
      one.type = std::move(type.text);
      one.sent = std::move(type.sent);
      arguments.push_back(one.name);
      come.push_back(one.name + ": " + one.type);
      sent.push_back(one.name + ": " + one.sent);
      view.parameters.push_back(std::move(one));
    }
    view.arguments = join(arguments, ", ");
    view.come_types = join(come, ", ");
    view.sent_types = join(sent, ", ");
    if (!view.is_function) return;
    if (member.generator_parameter) {
      come.push_back(Names::local(code_name(*member.generator_parameter), taken) + ": " +
                     context_.names.global("AsyncIterable") + "<" +
                     context_.types.spell(member.generator_parameter->type).text + ">");
    }
    view.options = Names::local("options", taken);
    sent.push_back(view.options + "?: rr.CallOptions");
    come.push_back(Names::local("caller", taken) + ": rr.Caller");
    view.call_signature = join(sent, ", ");
    view.served_signature = join(come, ", ");
  }

  std::string promise(const std::string& type) const {
    return context_.names.global("Promise") + "<" + type + ">";
  }

  void make_function(MemberView& view, const Member& member) {
    if (!view.is_generator) {
      view.call = "rr_call";
      view.result = promise(view.type);
      view.served_result = may_be_promise(view.sent);
      return;
    }
    view.call = view.is_source ? "rr_generate" : "rr_open";
    if (view.is_source) {
      view.result = runtime("GeneratorCall", view.type);
      view.served_result = may_be_promise(runtime("Values", view.sent));
      return;
    }
    const std::string taken = context_.types.spell(member.generator_parameter->type).sent;
    const std::string given = view.is_sink ? "undefined" : view.type;
    view.result = promise(runtime("RemoteGenerator", given + ", " + taken));
    view.served_result = view.is_sink ? may_be_promise("void") : runtime("Values", view.sent);
  }

  void make_reference(MemberView& view, const Member& member) {
    if (view.has_int32_index) view.index = "index: number";
    if (view.has_string_index) view.index = "index: string";
    if (view.has_index) view.index_more = view.index + ", ";
    const auto* object = std::get_if<const Object*>(&member.type.base);
    if (object == nullptr) {
      view.interface = "rr.RemoteObject";
      view.served_result = may_be_promise("rr.Skeleton | null");
      return;
    }
    const model::Definition& owner = *(*object)->definition;
    const Names& names = context_.names;
    view.interface = names.of(owner, exported(code_name(**object)));
    view.stub = names.of(owner, stub_name(**object));
    view.skeleton = names.of(owner, skeleton_name(**object));
    view.served_result =
        may_be_promise(names.of(owner, service_name(**object)) + " | rr.Skeleton | null");
  }

  static void make_handle(MemberView& view, const std::string& what, std::string_view handle,
                          const std::string& argument, std::string_view served,
                          const std::string& served_argument) {
    view.handle = runtime(handle, argument);
    view.handle_served = runtime(served, served_argument);
    view.handle_call = view.served_call = "rr_" + what;
  }

  void make_memory(MemberView& view, const Member& member) {
    const std::string row = context_.types.row(member.type.base);
    make_handle(view, "memory", view.is_multi ? "MultiDimMemory" : "ArrayMemory", row,
                "ServedMemory", view.is_multi ? runtime("MultiDimArray", row) : row);
    view.handle_call = view.is_multi ? "rr_multi_dim_memory" : "rr_array_memory";
  }

  const Object& object_;
  const Context& context_;
  NameSet taken_;  // in the interface and the stub; services and skeletons have a part of them
};

}  // namespace

void make_members(ObjectView& view, const Object& object, const Context& context) {
  MemberMaker(object, context).make(view);
}

}  // namespace robdef::typescript
