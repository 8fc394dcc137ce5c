// SPDX-License-Identifier: Apache-2.0
// The view of the members of an object: what they are and how it is called.
#include <algorithm>
#include <set>
#include <utility>
#include <variant>

#include "compiler/backends/csharp/backend.hpp"
#include "compiler/backends/csharp/constants.hpp"
#include "compiler/backends/csharp/view_parts.hpp"
#include "compiler/backends/implements.hpp"
#include "compiler/backends/member_facts.hpp"
#include "compiler/backends/words.hpp"

namespace robdef::csharp {
namespace {

using model::Member;
using model::MemberKind;
using model::Object;

std::string angled(const std::vector<std::string>& items) {
  return items.empty() ? "" : "<" + join(items, ", ") + ">";
}

class MemberMaker {
 public:
  MemberMaker(const Object& object, const Context& context)
      : object_(object),
        context_(context),
        taken_(csharp_language, context.report),
        served_(csharp_language, context.report) {}

  void make(ObjectView& object) {
    for (std::size_t i = 0; i < object.constants.size(); ++i) {
      const model::Constant& constant = object_.constants[i];
      taken_.add(object.constants[i].name, constant.span, "constant",
                 object_.qualified_name() + "." + constant.name);
    }
    std::set<std::string> places;
    std::size_t served = 0;
    for (const Member& member : object_.members) {
      MemberView view = common(member);
      make_value(view, member);
      if (view.is_served) {
        view.number = std::to_string(served++);
        view.place = pascal(code_name(member));
        while (!places.insert(view.place).second) view.place += '_';
        make_served(view, member);
        add_names(view, member);
      } else {
        report_unserved(member, "C#", context_.report);
      }
      object.has_members = object.has_members || view.is_served;
      object.members.push_back(std::move(view));
    }
  }

 private:
  MemberView common(const Member& member) {
    MemberView view;
    describe(view, object_, member, runtime_abilities);
    view.name = is_called_by_itself(member)
                    ? member_name(code_name(member), "", member.span, context_.report)
                    : pascal(code_name(member));
    view.doc = summary(member.documentation, in_class);
    view.is_hiding = !view.is_inherited && is_implemented(member.name);
    view.access = access_text(member.access);
    if (view.is_urgent) view.urgent = ", " + runtime("MemberAccess") + ".Urgent";
    return view;
  }

  /// Properties and objrefs appear as Get and Set only.
  static bool is_called_by_itself(const Member& member) {
    return member.kind != MemberKind::property && member.kind != MemberKind::objref;
  }

  bool is_implemented(const std::string& name) const {
    return std::ranges::any_of(object_.implements, [&](const Object* base) {
      return std::ranges::find(base->members, name, &Member::name) != base->members.end();
    });
  }

  std::string runtime(std::string_view name) { return context_.names.library(runtime_space, name); }

  std::string access_text(const model::Access& access) {
    std::vector<std::string> flags = access_words(
        access,
        {"ReadOnly", "WriteOnly", "Unreliable", "NoLock", "NoLockRead", "PerClient", "Urgent"});
    if (flags.empty()) flags.emplace_back("None");
    const std::string before = runtime("MemberAccess") + ".";
    for (std::string& flag : flags) flag.insert(0, before);
    return join(flags, " | ");
  }

  void make_value(MemberView& view, const Member& member) {
    std::set<std::string> taken;
    std::vector<std::string> parameters;
    std::vector<std::string> arguments;
    for (const model::Parameter& parameter : member.parameters) {
      view.parameters.push_back(make_parameter(parameter, taken));
      parameters.push_back(view.parameters.back().type + " " + view.parameters.back().name);
      arguments.push_back(view.parameters.back().name);
    }
    view.writes.assign(view.parameters.rbegin(), view.parameters.rend());
    view.signature = join(parameters, ", ");
    view.signature_before = view.signature + (view.has_parameters ? ", " : "");
    view.arguments = join(arguments, ", ");
    view.arguments_before = view.arguments + (view.has_parameters ? ", " : "");
    if (member.generator_parameter) {
      view.generator_parameter = make_parameter(*member.generator_parameter, taken);
    }
    if (member.kind == MemberKind::objref) {
      make_reference(view, member);
    } else if (member.kind != MemberKind::event) {
      const CsType type = context_.types.spell(member.type);
      view.type = type.text;
      view.codec = type.codec;
      view.first = type.initial.empty() ? "default" : type.initial.substr(3);
      if (view.first.ends_with(';')) view.first.pop_back();
    }
    view.cancel = Names::local("cancel", taken);
    view.served_cancel = Names::local("cancellationToken", taken);
    view.client = Names::local("client", taken);
  }

  ParameterView make_parameter(const model::Parameter& parameter, std::set<std::string>& taken) {
    const CsType type = context_.types.spell(parameter.type);
    ParameterView view;
    describe(view, parameter, Names::local(code_name(parameter), taken));
    view.type = type.text;
    view.codec = type.codec;
    return view;
  }

  void make_reference(MemberView& view, const Member& member) {
    if (view.has_int32_index) view.index_type = "int index";
    if (view.has_string_index) view.index_type = "string index";
    view.index_parameter = view.index_type + (view.has_index ? ", " : "");
    view.index_argument = view.has_index ? "index" : runtime("ObjectIndex") + ".None";
    if (view.has_int32_index) view.index_read = "rrRequest.IndexNumber";
    if (view.has_string_index) view.index_read = "rrRequest.IndexText";
    if (const auto* object = std::get_if<const Object*>(&member.type.base)) {
      const model::Definition& owner = *(*object)->definition;
      view.interface = context_.names.type(owner, interface_name(**object));
      view.stub = context_.names.type(owner, stub_name(**object));
    } else {
      view.interface = view.stub = runtime("Stub");
    }
  }

  void make_served(MemberView& view, const Member& member) {
    switch (member.kind) {
      case MemberKind::property:
      case MemberKind::objref:
        break;
      case MemberKind::function:
        make_function(view);
        break;
      case MemberKind::event:
        view.handler = system("Action") + angled(types_of(view));
        break;
      case MemberKind::pipe:
        view.handle = runtime("Pipe") + "<" + view.type + ">";
        view.handle_served = runtime("PipeServer") + "<" + view.type + ">";
        break;
      case MemberKind::callback:
        make_callback(view);
        break;
      case MemberKind::wire:
        view.handle = runtime("Wire") + "<" + view.type + ">";
        view.handle_served = runtime("WireServer") + "<" + view.type + ">";
        break;
      case MemberKind::memory:
        make_memory(view, member);
        break;
    }
    view.row = row(view, member);
  }

  static std::vector<std::string> types_of(const MemberView& view) {
    std::vector<std::string> types;
    for (const ParameterView& parameter : view.parameters) types.push_back(parameter.type);
    return types;
  }

  std::string system(std::string_view name) { return context_.names.library("System", name); }
  std::string task(std::string_view form, const std::string& result) {
    const std::string name = context_.names.library("System.Threading.Tasks", form);
    return result == "void" ? name : name + "<" + result + ">";
  }

  void make_function(MemberView& view) {
    view.result = view.type;
    view.verb = "Run";
    view.codecs = view.has_result ? view.codec + ", " : "";
    view.answer = view.has_result ? ", " + view.codec : "";
    view.served = task("ValueTask", view.type);
    view.served_before = view.signature_before;
    if (view.is_generator) make_generator(view);
    view.task = task("Task", view.result);
    view.invocation = view.has_parameters
                          ? "RrCall" + view.name + "(" + view.arguments + ")"
                          : "RrFunction(\"" + view.wire_name + "\"u8" + view.urgent + ")";
  }

  void make_generator(MemberView& view) {
    const std::string sequence =
        context_.names.library("System.Collections.Generic", "IAsyncEnumerable");
    if (view.is_source) {
      view.result = runtime("Generator") + "<" + view.type + ">";
      view.verb = "Open";
      view.served = sequence + "<" + view.type + ">";
      return;
    }
    const ParameterView& taken = *view.generator_parameter;
    view.served_before =
        view.signature_before + sequence + "<" + taken.type + "> " + taken.name + ", ";
    if (view.is_sink) {
      view.result = runtime("GeneratorSink") + "<" + taken.type + ">";
      view.verb = "OpenSink";
      view.codecs = taken.codec + ", ";
      view.answer = ", " + taken.codec;
      view.served = task("ValueTask", "void");
      return;
    }
    view.result = runtime("GeneratorFilter") + "<" + taken.type + ", " + view.type + ">";
    view.verb = "OpenFilter";
    view.codecs = taken.codec + ", " + view.codec + ", ";
    view.answer = ", " + taken.codec + ", " + view.codec;
    view.served = sequence + "<" + view.type + ">";
  }

  void make_callback(MemberView& view) {
    view.task = task("Task", view.type);
    view.result = view.type;
    view.codecs = view.has_result ? view.codec + ", " : "";
    view.answer = view.has_result ? ", " + view.codec : "";
    std::vector<std::string> types = types_of(view);
    types.push_back(view.task);
    view.handler = system("Func") + angled(types);
  }

  void make_memory(MemberView& view, const Member& member) {
    const CsType item = context_.types.item(member.type);
    view.item = item.text;
    view.item_codec = item.codec;
    const std::string kind = view.is_multi ? "MultiDimMemory" : "ArrayMemory";
    view.handle = runtime(kind) + "<" + item.text + ">";
    view.handle_served = runtime(kind + "Source") + "<" + item.text + ">";
  }

  /// Its row in the table of the object's members.
  std::string row(const MemberView& view, const Member& member) {
    std::string kind = view.kind;
    kind.front() = static_cast<char>(kind.front() - 'a' + 'A');
    if (view.is_objref) kind = "ObjRef";
    std::vector<std::string> more;
    const bool is_call = view.is_function || view.is_callback;
    if (is_call && view.has_result) more.emplace_back("ReturnsValue = true");
    if (view.is_source) more.push_back("Generator = " + runtime("GeneratorForm") + ".Returns");
    if (view.is_sink) more.push_back("Generator = " + runtime("GeneratorForm") + ".Takes");
    if (view.is_filter) more.push_back("Generator = " + runtime("GeneratorForm") + ".Both");
    if (view.has_int32_index) more.push_back("Index = " + runtime("IndexForm") + ".Int32");
    if (view.has_string_index) more.push_back("Index = " + runtime("IndexForm") + ".String");
    if (!view.object_type.empty()) more.push_back("ObjectType = \"" + view.object_type + "\"");
    if (view.is_memory) {
      more.push_back("Memory = " + runtime("MemoryType") + ".Of(" + view.item_codec + ", " +
                     (view.is_multi ? "true" : "false") + ")");
    }
    if (!view.handle_served.empty() && !view.is_memory) {
      more.push_back("Check = " + runtime("ValueCheck") + ".Of(" + view.codec + ")");
    }
    const std::string head = "new(\"" + member.name + "\", " + runtime("MemberKind") + "." + kind +
                             ", " + view.access + ")";
    return head + (more.empty() ? "" : " { " + join(more, ", ") + " }") + ",";
  }

  /// All that the classes have for a member: what stubs and interfaces do, and what skeletons do.
  void add_names(const MemberView& view, const Member& member) {
    // A member is reported once, however many of its names meet others.
    bool is_new = true;
    const std::string path = full_name(object_, member);
    const auto add = [&](const std::string& name) {
      is_new = is_new && taken_.add(name, member.span, view.kind, path);
    };
    const auto serve = [&](const std::string& name) {
      is_new = is_new && served_.add(name, member.span, view.kind, path);
    };
    if (view.is_property || view.is_objref) {
      if (view.is_objref || view.can_get) {
        add("Get" + view.name);
        add("Get" + view.name + "Async");
        serve("Get" + view.name + "Async");
      }
      if (view.can_set) {
        add("Set" + view.name);
        add("Set" + view.name + "Async");
        serve("Set" + view.name + "Async");
      }
      return;
    }
    add((view.is_callback ? "Set" : "") + view.name);
    if (view.is_function) add(view.name + "Async");
    if (view.is_function || view.is_callback) serve(view.name + "Async");
    if (!view.is_function) serve((view.is_event ? "Fire" : "") + view.name);
  }

  const Object& object_;
  const Context& context_;
  NameSet taken_;   // in the interface and the stub
  NameSet served_;  // in the skeleton
};

}  // namespace

void make_members(ObjectView& view, const Object& object, const Context& context) {
  MemberMaker(object, context).make(view);
}

}  // namespace robdef::csharp
