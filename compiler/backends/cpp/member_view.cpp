// SPDX-License-Identifier: Apache-2.0
// The view of an object's members. Everything that depends on the kind of a member is here.
#include <algorithm>
#include <map>
#include <utility>
#include <variant>

#include "compiler/backends/cpp/constants.hpp"
#include "compiler/backends/cpp/layout.hpp"
#include "compiler/backends/cpp/view_parts.hpp"
#include "compiler/backends/words.hpp"

namespace robdef::cpp {
namespace {

using model::Member;
using model::MemberKind;
using model::Object;
using model::Type;

constexpr std::size_t in_class = 2;

bool can_serve(const Member& member) {
  switch (member.kind) {
    case MemberKind::property:
    case MemberKind::event:
    case MemberKind::objref:
      return true;
    case MemberKind::function:
      return member.generator == model::GeneratorForm::none;
    case MemberKind::pipe:
    case MemberKind::callback:
    case MemberKind::wire:
    case MemberKind::memory:
      return false;
  }
  return false;
}

/// The implemented object from whose classes a member comes. Null when there is none, and when
/// there are two that do not have it from a common one: then it is made anew.
const Object* origin(const Object& object, const std::string& name) {
  const Object* found = nullptr;
  for (const Object* base : object.implements) {
    const bool has_it =
        std::ranges::find(base->members, name, &Member::name) != base->members.end();
    if (!has_it) continue;
    const Object* inner = origin(*base, name);
    const Object* root = inner == nullptr ? base : inner;
    if (found != nullptr && found != root) return nullptr;
    found = root;
  }
  return found;
}

/// `::rr::readonly | ::rr::nolock`; empty for none.
std::string access_text(const model::Access& access) {
  std::vector<std::string> flags;
  const auto add = [&](bool is_set, const char* name) {
    if (is_set) flags.push_back(std::string("::rr::") + name);
  };
  add(access.is_readonly, "readonly");
  add(access.is_writeonly, "writeonly");
  add(access.is_unreliable, "unreliable");
  add(access.is_nolock, "nolock");
  add(access.is_nolockread, "nolockread");
  add(access.is_perclient, "perclient");
  add(access.is_urgent, "urgent");
  return join(flags, " | ");
}

std::string quoted(const std::string& text) { return "\"" + text + "\""; }

std::string statement(const std::string& before, const std::vector<std::string>& items,
                      std::size_t indent) {
  return list({.before = before, .items = items, .after = ");"}, indent);
}

class MemberMaker {
 public:
  MemberMaker(const Object& object, const Context& context)
      : object_(object),
        context_(context),
        hidden_(names_inside(object)),
        member_table_(table_name("members", object.name)) {}

  void make(ObjectView& object) {
    std::vector<MemberView>& views = object.members;
    std::size_t served = 0;
    for (const Member& member : object_.members) {
      MemberView view = common(member);
      if (view.is_served) {
        view.number = std::to_string(served++);
        view.entry = member_table_ + "[" + view.number + "]";
      } else {
        report_unserved(member);
      }
      make_value(view, member);
      if (view.is_served) make_served(view, member);
      views.push_back(std::move(view));
    }
    object.member_rows = table_rows(rows_, 4);
  }

 private:
  MemberView common(const Member& member) {
    MemberView view;
    view.wire_name = member.name;
    view.name = member_name(object_, member.name);
    view.doc = doc_lines(member.documentation, in_class);
    view.kind = model::name_of(member.kind);
    view.is_property = member.kind == MemberKind::property;
    view.is_function = member.kind == MemberKind::function;
    view.is_event = member.kind == MemberKind::event;
    view.is_objref = member.kind == MemberKind::objref;
    view.is_pipe = member.kind == MemberKind::pipe;
    view.is_callback = member.kind == MemberKind::callback;
    view.is_wire = member.kind == MemberKind::wire;
    view.is_memory = member.kind == MemberKind::memory;
    view.is_served = can_serve(member);
    view.is_inherited = origin(object_, member.name) != nullptr;
    view.is_readonly = member.access.is_readonly;
    view.is_writeonly = member.access.is_writeonly;
    view.is_unreliable = member.access.is_unreliable;
    view.is_nolock = member.access.is_nolock;
    view.is_nolockread = member.access.is_nolockread;
    view.is_perclient = member.access.is_perclient;
    view.is_urgent = member.access.is_urgent;
    view.can_get = view.is_property && !view.is_writeonly;
    view.can_set = view.is_property && !view.is_readonly;
    return view;
  }

  void report_unserved(const Member& member) {
    const bool is_generator = member.kind == MemberKind::function;
    context_.report.add(Code::R0904, member.span,
                        "the C++ runtime does not serve " +
                            (is_generator ? std::string("generator function")
                                          : std::string(model::name_of(member.kind))) +
                            "s yet; `" + member.name + "` is left out");
  }

  /// Types, parameters and names.
  void make_value(MemberView& view, const Member& member) {
    std::set<std::string> taken;
    for (const model::Parameter& parameter : member.parameters) {
      view.parameters.push_back(make_parameter(parameter, taken));
    }
    view.has_parameters = !view.parameters.empty();
    if (member.generator_parameter) {
      view.generator_parameter = make_parameter(*member.generator_parameter, taken);
    }
    view.is_generator = member.generator != model::GeneratorForm::none;
    view.yields = view.is_generator && !member.type.is_void();
    std::vector<std::string> names;
    for (const ParameterView& parameter : view.parameters) names.push_back(parameter.name);
    view.arguments = join(names, ", ");
    view.token = context_.names.local("Token", taken);
    view.robdef_type = member.type.text();
    view.getter = "get_" + member.name;
    view.setter = "set_" + member.name;
    if (member.kind == MemberKind::objref) {
      make_reference(view, member);
    } else if (member.kind != MemberKind::event) {
      const CppType type = spell(member.type);
      view.type = type.text;
      view.passed = type.passed();
      view.descriptor = type.descriptor;
      view.has_result = !member.type.is_void();
      view.value = context_.names.local("value", taken);
      if (view.has_result) view.local = variable(type, view.value, 8);
      if (view.is_property) make_stored(view, type);
    }
  }

  ParameterView make_parameter(const model::Parameter& parameter, std::set<std::string>& taken) {
    const CppType type = spell(parameter.type);
    ParameterView view;
    view.wire_name = parameter.name;
    view.name = context_.names.local(parameter.name, taken);
    view.type = type.text;
    view.passed = type.passed();
    view.local = variable(type, view.name, 6);
    view.descriptor = type.descriptor;
    view.robdef_type = parameter.type.text();
    return view;
  }

  void make_reference(MemberView& view, const Member& member) {
    view.has_int32_index = member.index == model::IndexForm::int32;
    view.has_string_index = member.index == model::IndexForm::string;
    view.has_index = view.has_int32_index || view.has_string_index;
    if (view.has_int32_index) context_.types.include("<cstdint>");
    if (view.has_string_index) context_.types.include("<string>");
    context_.types.include("<memory>");
    if (const auto* object = std::get_if<const Object*>(&member.type.base)) {
      const Object& target = **object;
      view.object_type = target.qualified_name();
      view.stub = context_.names.object_class(target, stub_name(target), hidden_);
      view.skeleton = context_.names.object_class(target, skeleton_name(target), hidden_);
      view.qualified_stub = qualified(*target.definition, stub_name(target));
      view.qualified_skeleton = qualified(*target.definition, skeleton_name(target));
    } else {
      view.is_varobject = true;
      view.stub = view.qualified_stub = "::rr::Stub";
      view.skeleton = view.qualified_skeleton = "::rr::Skeleton";
    }
  }

  void make_stored(MemberView& view, const CppType& type) {
    const std::string initial = type.made.empty() ? "" : "{" + type.made + "}";
    view.stored =
        variable({.text = "::rr::Stored<" + type.text + ">", .descriptor = {}, .initial = initial},
                 stored_name(view), in_class);
  }

  static std::string stored_name(const MemberView& view) { return "rr_value_" + view.wire_name; }

  CppType spell(const Type& type) { return context_.types.spell(type, {.hidden = &hidden_}); }

  void make_served(MemberView& view, const Member& member) {
    make_tables(view, member);
    switch (member.kind) {
      case MemberKind::property:
        make_property(view);
        return;
      case MemberKind::function:
        make_function(view);
        return;
      case MemberKind::event:
        make_event(view);
        return;
      case MemberKind::objref:
        make_objref(view);
        return;
      case MemberKind::pipe:
      case MemberKind::callback:
      case MemberKind::wire:
      case MemberKind::memory:
        return;
    }
  }

  void make_tables(MemberView& view, const Member& member) {
    std::string head = "::rr::" + view.kind;
    if (!view.descriptor.empty()) head += "<" + view.descriptor + ">";
    std::vector<std::string> items{quoted(member.name)};
    if (view.is_objref) {
      items.push_back(quoted(view.object_type));
      if (view.has_index) {
        items.emplace_back(view.has_int32_index ? "::rr::IndexForm::int32"
                                                : "::rr::IndexForm::string");
      }
    }
    const std::string access = access_text(member.access);
    if (view.has_parameters) {
      items.push_back(table_name("parameters", object_.name) + "::" + view.name);
    } else if (!access.empty() && (view.is_function || view.is_event)) {
      items.emplace_back("{}");
    }
    if (!access.empty() && !view.is_objref) items.push_back(access);
    rows_.push_back(list({.before = head + "(", .items = items, .after = "),"}, 4));
    if (view.has_parameters) make_parameter_table(view);
  }

  static void make_parameter_table(MemberView& view) {
    List table{.before = "static constexpr ::rr::Parameter " + view.name + "[] = {",
               .items = {},
               .after = "};"};
    for (const ParameterView& parameter : view.parameters) {
      table.items.push_back(list({.before = "::rr::parameter<" + parameter.descriptor + ">(",
                                  .items = {quoted(parameter.wire_name)},
                                  .after = ")"},
                                 in_class + 4));
    }
    view.parameter_table = braced_list(table, in_class);
  }

  static Signature getter(const MemberView& view, const std::string& after = "",
                          const std::string& before = "") {
    return {.before = before,
            .result = view.type,
            .name = view.getter,
            .parameters = {},
            .after = after};
  }
  static Signature setter(const MemberView& view, const std::string& after = "",
                          const std::string& before = "") {
    return {.before = before,
            .result = "void",
            .name = view.setter,
            .parameters = {view.passed + " " + view.value},
            .after = after};
  }

  static std::string token_parameter(const MemberView& view, const std::string& token) {
    return view.token + "&& " + token;
  }
  static std::string forwarded(const MemberView& view, const std::string& token) {
    return "::std::forward<" + view.token + ">(" + token + ")";
  }
  std::string token_name(const MemberView& view) const {
    std::set<std::string> taken{view.value};
    for (const ParameterView& parameter : view.parameters) taken.insert(parameter.name);
    return context_.names.local("token", taken);
  }

  void make_property(MemberView& view) const {
    const std::string token = token_name(view);
    const std::string stored = stored_name(view);
    view.stub_get = definition(
        getter(view), List{"return rr_get<" + view.type + ">(", {view.entry}, ");"}, in_class);
    view.stub_set =
        definition(setter(view), List{"rr_set(", {view.entry, "&" + view.value}, ");"}, in_class);
    view.async_get = definition(
        {.result = "auto",
         .name = "async_" + view.getter,
         .parameters = {token_parameter(view, token)}},
        List{"return rr_async_get<" + view.type + ">(", {view.entry, forwarded(view, token)}, ");"},
        in_class);
    view.async_set =
        definition({.result = "auto",
                    .name = "async_" + view.setter,
                    .parameters = {view.passed + " " + view.value, token_parameter(view, token)}},
                   List{"return rr_async_set<" + view.type + ">(",
                        {view.entry, forwarded(view, token), view.value},
                        ");"},
                   in_class);
    view.skeleton_get = declaration(getter(view, " = 0", "virtual "), in_class);
    view.skeleton_set = declaration(setter(view, " = 0", "virtual "), in_class);
    const std::string override_get = view.can_get ? " override" : "";
    const std::string override_set = view.can_set ? " override" : "";
    view.default_get =
        definition(getter(view, override_get), "return " + stored + ".get();", in_class);
    view.default_set =
        definition(setter(view, override_set), stored + ".set(" + view.value + ");", in_class);
  }

  static std::vector<std::string> passed_parameters(const MemberView& view) {
    std::vector<std::string> result;
    for (const ParameterView& parameter : view.parameters) {
      result.push_back(parameter.passed + " " + parameter.name);
    }
    return result;
  }
  static std::vector<std::string> names_of(const std::vector<ParameterView>& parameters) {
    std::vector<std::string> result;
    for (const ParameterView& parameter : parameters) result.push_back(parameter.name);
    return result;
  }
  template <class... More>
  static std::vector<std::string> with(std::vector<std::string> items, More... more) {
    (items.push_back(std::move(more)), ...);
    return items;
  }
  static std::vector<std::string> after(std::vector<std::string> items,
                                        const std::vector<std::string>& more) {
    items.insert(items.end(), more.begin(), more.end());
    return items;
  }

  void make_function(MemberView& view) const {
    const std::string token = token_name(view);
    const std::vector<std::string> parameters = passed_parameters(view);
    const std::vector<std::string> names = names_of(view.parameters);
    const std::string async_name = "async_" + view.name;
    const std::string returns = view.has_result ? "return " : "";
    view.stub_call = definition(
        {.result = view.type, .name = view.name, .parameters = parameters},
        List{returns + "rr_call<" + view.type + ">(", after({view.entry}, names), ");"}, in_class);
    view.async_call = definition({.result = "auto",
                                  .name = async_name,
                                  .parameters = with(parameters, token_parameter(view, token))},
                                 List{"return rr_async_call<" + view.type + ">(",
                                      after({view.entry, forwarded(view, token)}, names), ");"},
                                 in_class);
    view.skeleton_call = declaration({.before = "virtual ",
                                      .result = view.type,
                                      .name = view.name,
                                      .parameters = parameters,
                                      .after = " = 0"},
                                     in_class);
    view.skeleton_async = skeleton_async(view, parameters);
    if (view.has_parameters) {
      view.dispatch_read = statement("rr_request.read(", names, 6);
    }
    view.dispatch_call =
        statement("return " + async_name + "(", with(names, std::string("rr_request")), 6);
    view.default_call =
        definition({.before = "",
                    .result = view.type,
                    .name = view.name,
                    .parameters = unnamed(view.parameters),
                    .after = " override"},
                   "::rr::throw_not_implemented(" + quoted(view.wire_name) + ");", in_class);
  }

  static std::vector<std::string> unnamed(const std::vector<ParameterView>& parameters) {
    std::vector<std::string> result;
    for (const ParameterView& parameter : parameters) result.push_back(parameter.passed);
    return result;
  }

  /// The form that may answer later; by default it answers with what the plain one returns.
  [[nodiscard]] std::string skeleton_async(const MemberView& view,
                                           const std::vector<std::string>& parameters) const {
    std::set<std::string> taken;
    for (const ParameterView& parameter : view.parameters) taken.insert(parameter.name);
    const std::string answer = context_.names.local("answer", taken);
    const Signature signature{
        .before = "virtual ",
        .result = "void",
        .name = "async_" + view.name,
        .parameters = with(parameters, "::rr::Answer<" + view.type + "> " + answer)};
    List call{.before = view.name + "(", .items = names_of(view.parameters), .after = ");"};
    if (!view.has_result) return long_definition(signature, call, answer + "();", in_class);
    call.before.insert(0, answer + "(");
    call.after = "));";
    return definition(signature, call, in_class);
  }

  static void make_event(MemberView& view) {
    std::vector<std::string> types;
    for (const ParameterView& parameter : view.parameters) types.push_back(parameter.type);
    view.type = list({.before = "::rr::Event<", .items = types, .after = ">"}, in_class);
    view.stub_event = definition({.result = view.type, .name = view.name},
                                 "return {*this, " + view.entry + "};", in_class);
    view.skeleton_fire = definition(
        {.result = "void",
         .name = view.name,
         .parameters = passed_parameters(view),
         .after = " const"},
        List{"rr_fire_event(", after({view.entry}, names_of(view.parameters)), ");"}, in_class);
  }

  void make_objref(MemberView& view) const {
    const std::string token = token_name(view);
    std::set<std::string> taken{token};
    const std::string index = context_.names.local("index", taken);
    const std::string index_type =
        view.has_int32_index ? "::std::int32_t " : "const ::std::string& ";
    std::vector<std::string> parameters;
    std::vector<std::string> arguments{view.entry};
    if (view.has_index) {
      parameters.push_back(index_type + index);
      arguments.push_back(index);
    }
    const std::string pointer = "::std::shared_ptr<" + view.stub + ">";
    const std::string find = view.is_varobject ? "rr_find(" : "rr_find_as<" + view.stub + ">(";
    view.stub_find =
        declaration({.result = pointer, .name = view.getter, .parameters = parameters}, in_class);
    view.stub_find_definition = definition({.result = pointer,
                                            .name = stub_name(object_) + "::" + view.getter,
                                            .parameters = parameters},
                                           List{"return " + find, arguments, ");"}, 0);
    arguments.insert(arguments.begin() + 1, forwarded(view, token));
    view.async_find =
        definition({.result = "auto",
                    .name = "async_" + view.getter,
                    .parameters = with(parameters, token_parameter(view, token))},
                   List{"return rr_async_find<" + view.stub + ">(", arguments, ");"}, in_class);
    make_skeleton_objref(view, parameters);
  }

  static void make_skeleton_objref(MemberView& view, const std::vector<std::string>& parameters) {
    const std::string pointer = "::std::shared_ptr<" + view.skeleton + ">";
    view.skeleton_find = declaration({.before = "virtual ",
                                      .result = pointer,
                                      .name = view.getter,
                                      .parameters = parameters,
                                      .after = " = 0"},
                                     in_class);
    std::string index;
    if (view.has_int32_index) index = "rr_index.number";
    if (view.has_string_index) index = "::std::string(rr_index.text)";
    view.dispatch_find = "return " + view.getter + "(" + index + ");";
    std::vector<std::string> unnamed;
    if (view.has_int32_index) unnamed.emplace_back("::std::int32_t");
    if (view.has_string_index) unnamed.emplace_back("const ::std::string&");
    view.default_find =
        definition({.before = "",
                    .result = pointer,
                    .name = view.getter,
                    .parameters = unnamed,
                    .after = " override"},
                   "::rr::throw_no_object(" + quoted(view.wire_name) + ");", in_class);
  }

  const Object& object_;
  const Context& context_;
  std::set<std::string> hidden_;
  std::string member_table_;
  std::vector<std::string> rows_;  // of that table
};

}  // namespace

void make_members(ObjectView& view, const Object& object, const Context& context) {
  MemberMaker(object, context).make(view);
}

}  // namespace robdef::cpp
