// SPDX-License-Identifier: Apache-2.0
// Members that are calls: properties, functions, generators, callbacks, objrefs.
#include "compiler/backends/cpp/member_lines.hpp"

#include <set>
#include <utility>

#include "compiler/backends/cpp/layout.hpp"
#include "compiler/backends/words.hpp"

namespace robdef::cpp {
namespace {

using Texts = std::vector<std::string>;

constexpr std::size_t in_case = 6;

std::string quoted(const std::string& text) { return "\"" + text + "\""; }

std::string statement(const std::string& before, const Texts& items, std::size_t indent) {
  return list({.before = before, .items = items, .after = ");"}, indent);
}

Texts with(Texts items, const Texts& more) {
  items.insert(items.end(), more.begin(), more.end());
  return items;
}

Texts names_of(const std::vector<ParameterView>& parameters) {
  Texts result;
  for (const ParameterView& parameter : parameters) result.push_back(parameter.name);
  return result;
}
/// As a call takes them: `const ::std::string& name`.
Texts passed(const std::vector<ParameterView>& parameters) {
  Texts result;
  for (const ParameterView& parameter : parameters) {
    result.push_back(parameter.passed + " " + parameter.name);
  }
  return result;
}
/// As a coroutine takes them, which keeps them: `::std::string name`.
Texts given(const std::vector<ParameterView>& parameters) {
  Texts result;
  for (const ParameterView& parameter : parameters) {
    result.push_back(parameter.type + " " + parameter.name);
  }
  return result;
}
Texts moved(const std::vector<ParameterView>& parameters) {
  Texts result;
  for (const ParameterView& parameter : parameters) {
    const bool is_by_value = parameter.passed == parameter.type;
    result.push_back(is_by_value ? parameter.name : "::std::move(" + parameter.name + ")");
  }
  return result;
}
Texts unnamed(const std::vector<ParameterView>& parameters) {
  Texts result;
  for (const ParameterView& parameter : parameters) result.push_back(parameter.passed);
  return result;
}
Texts types_of(const std::vector<ParameterView>& parameters) {
  Texts result;
  for (const ParameterView& parameter : parameters) result.push_back(parameter.type);
  return result;
}

/// The names of parameters and of the value, which a further parameter may not have.
std::set<std::string> taken_by(const MemberView& view) {
  std::set<std::string> taken;
  if (!view.value.empty()) taken.insert(view.value);
  for (const ParameterView& parameter : view.parameters) taken.insert(parameter.name);
  return taken;
}
std::string token_name(const MemberView& view, const Names& names) {
  std::set<std::string> taken = taken_by(view);
  return names.local("token", taken);
}
std::string token_parameter(const MemberView& view, const std::string& token) {
  return view.token + "&& " + token;
}
std::string forwarded(const MemberView& view, const std::string& token) {
  return "::std::forward<" + view.token + ">(" + token + ")";
}

Signature getter(const MemberView& view, const std::string& after = "",
                 const std::string& before = "") {
  return {
      .before = before, .result = view.type, .name = view.getter, .parameters = {}, .after = after};
}
Signature setter(const MemberView& view, const std::string& after = "",
                 const std::string& before = "") {
  return {.before = before,
          .result = "void",
          .name = view.setter,
          .parameters = {view.passed + " " + view.value},
          .after = after};
}

/// The form that may answer later; by default it answers with what the plain one returns.
std::string answering_form(const MemberView& view, const Names& names, const Texts& parameters) {
  std::set<std::string> taken;
  for (const ParameterView& parameter : view.parameters) taken.insert(parameter.name);
  const std::string answer = names.local("answer", taken);
  const Signature signature{
      .before = "virtual ",
      .result = "void",
      .name = "async_" + view.name,
      .parameters = with(parameters, {"::rr::Answer<" + view.type + "> " + answer})};
  List call{.before = view.name + "(", .items = names_of(view.parameters), .after = ");"};
  if (!view.has_result) return long_definition(signature, call, answer + "();", in_class);
  call.before.insert(0, answer + "(");
  call.after = "));";
  return definition(signature, call, in_class);
}

/// In rr_dispatch: the call of a generator function and, around it, that of `answer`, behind which
/// is broken when the inner one cannot be broken at its parenthesis.
std::string answer_with(const MemberView& view) {
  const std::string outer = "return rr_request.answer(";
  List call{.before = outer + view.name + "(", .items = moved(view.parameters), .after = "));"};
  std::string result = list(call, in_case);
  if (result.substr(0, result.find('\n')).back() != '(') return result;
  call.before = view.name + "(";
  return outer + "\n" + std::string(in_case + 4, ' ') + list(call, in_case + 4);
}

std::string failing_override(const MemberView& view, const std::string& result,
                             const Texts& parameters) {
  return definition(
      {.result = result, .name = view.name, .parameters = parameters, .after = " override"},
      "::rr::throw_not_implemented(" + quoted(view.wire_name) + ");", in_class);
}

void lay_out_skeleton_objref(MemberView& view, const Texts& parameters) {
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
  Texts unnamed_index;
  if (view.has_int32_index) unnamed_index.emplace_back("::std::int32_t");
  if (view.has_string_index) unnamed_index.emplace_back("const ::std::string&");
  view.default_find =
      definition({.before = "",
                  .result = pointer,
                  .name = view.getter,
                  .parameters = unnamed_index,
                  .after = " override"},
                 "::rr::throw_no_object(" + quoted(view.wire_name) + ");", in_class);
}

}  // namespace

std::string stored_name(const MemberView& view) {
  return (view.is_memory ? "rr_memory_" : "rr_value_") + view.wire_name;
}

void lay_out_property(MemberView& view, const Names& names) {
  const std::string token = token_name(view, names);
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

void lay_out_function(MemberView& view, const Names& names) {
  const std::string token = token_name(view, names);
  const Texts parameters = passed(view.parameters);
  const Texts arguments = names_of(view.parameters);
  const std::string async_name = "async_" + view.name;
  const std::string returns = view.has_result ? "return " : "";
  view.stub_call = definition(
      {.result = view.type, .name = view.name, .parameters = parameters},
      List{returns + "rr_call<" + view.type + ">(", with({view.entry}, arguments), ");"}, in_class);
  view.async_call = definition({.result = "auto",
                                .name = async_name,
                                .parameters = with(parameters, {token_parameter(view, token)})},
                               List{"return rr_async_call<" + view.type + ">(",
                                    with({view.entry, forwarded(view, token)}, arguments), ");"},
                               in_class);
  view.skeleton_call = declaration({.before = "virtual ",
                                    .result = view.type,
                                    .name = view.name,
                                    .parameters = parameters,
                                    .after = " = 0"},
                                   in_class);
  view.skeleton_async = answering_form(view, names, parameters);
  if (view.has_parameters) view.dispatch_read = statement("rr_request.read(", arguments, in_case);
  view.dispatch_call =
      statement("return " + async_name + "(", with(arguments, {"rr_request"}), in_case);
  view.default_call = failing_override(view, view.type, unnamed(view.parameters));
}

void lay_out_generator(MemberView& view, const Names& names) {
  const std::string token = token_name(view, names);
  const Texts parameters = passed(view.parameters);
  const Texts arguments = names_of(view.parameters);
  const std::string taken = view.generator_parameter ? view.generator_parameter->type : "void";
  const std::string of =
      "<" + view.type + (view.generator_parameter ? ", " + taken : std::string()) + ">";
  const std::string both = "<" + view.type + ", " + taken + ">";
  view.handle = "::rr::Generator" + of;
  view.served = "::rr::Sequence" + of;
  view.stub_call = definition(
      {.result = view.handle, .name = view.name, .parameters = parameters},
      List{"return rr_generate" + both + "(", with({view.entry}, arguments), ");"}, in_class);
  view.async_call = definition({.result = "auto",
                                .name = "async_" + view.name,
                                .parameters = with(parameters, {token_parameter(view, token)})},
                               List{"return rr_async_generate" + both + "(",
                                    with({view.entry, forwarded(view, token)}, arguments), ");"},
                               in_class);
  view.skeleton_call = declaration({.before = "virtual ",
                                    .result = view.served,
                                    .name = view.name,
                                    .parameters = given(view.parameters),
                                    .after = " = 0"},
                                   in_class);
  if (view.has_parameters) view.dispatch_read = statement("rr_request.read(", arguments, in_case);
  view.dispatch_call = answer_with(view);
  view.default_call = failing_override(view, view.served, types_of(view.parameters));
}

void lay_out_callback(MemberView& view, const Names& names) {
  std::set<std::string> taken = taken_by(view);
  const std::string token = names.local("token", taken);
  const std::string client = names.local("client", taken);
  const Texts parameters = with({"::std::uint32_t " + client}, passed(view.parameters));
  const Texts arguments = with({client}, names_of(view.parameters));
  const std::string returns = view.has_result ? "return " : "";
  view.handle = list({.before = "::rr::Callback<" + view.type + "(",
                      .items = types_of(view.parameters),
                      .after = ")>"},
                     in_class);
  view.stub_handle = definition({.result = view.handle, .name = view.name},
                                "return {*this, " + view.entry + "};", in_class);
  view.skeleton_call = definition(
      {.result = view.type, .name = view.name, .parameters = parameters, .after = " const"},
      List{returns + "rr_call_back<" + view.type + ">(", with({view.entry}, arguments), ");"},
      in_class);
  view.skeleton_async =
      definition({.result = "auto",
                  .name = "async_" + view.name,
                  .parameters = with(parameters, {token_parameter(view, token)}),
                  .after = " const"},
                 List{"return rr_async_call_back<" + view.type + ">(",
                      with({view.entry, forwarded(view, token)}, arguments), ");"},
                 in_class);
}

void lay_out_objref(MemberView& view, const Names& names, const std::string& stub_class) {
  const std::string token = token_name(view, names);
  std::set<std::string> taken{token};
  const std::string index = names.local("index", taken);
  const std::string index_type = view.has_int32_index ? "::std::int32_t " : "const ::std::string& ";
  Texts parameters;
  Texts arguments{view.entry};
  if (view.has_index) {
    parameters.push_back(index_type + index);
    arguments.push_back(index);
  }
  const std::string pointer = "::std::shared_ptr<" + view.stub + ">";
  const std::string find = view.is_varobject ? "rr_find(" : "rr_find_as<" + view.stub + ">(";
  view.stub_find =
      declaration({.result = pointer, .name = view.getter, .parameters = parameters}, in_class);
  view.stub_find_definition = definition(
      {.result = pointer, .name = stub_class + "::" + view.getter, .parameters = parameters},
      List{"return " + find, arguments, ");"}, 0);
  arguments.insert(arguments.begin() + 1, forwarded(view, token));
  view.async_find =
      definition({.result = "auto",
                  .name = "async_" + view.getter,
                  .parameters = with(parameters, {token_parameter(view, token)})},
                 List{"return rr_async_find<" + view.stub + ">(", arguments, ");"}, in_class);
  lay_out_skeleton_objref(view, parameters);
}

void lay_out_event(MemberView& view) {
  view.type =
      list({.before = "::rr::Event<", .items = types_of(view.parameters), .after = ">"}, in_class);
  view.handle = view.type;
  view.stub_handle = definition({.result = view.handle, .name = view.name},
                                "return {*this, " + view.entry + "};", in_class);
  view.skeleton_fire = definition(
      {.result = "void",
       .name = view.name,
       .parameters = passed(view.parameters),
       .after = " const"},
      List{"rr_fire_event(", with({view.entry}, names_of(view.parameters)), ");"}, in_class);
}

std::string member_row(const MemberView& view, const std::string& object_tables,
                       const std::string& access) {
  std::string head = "::rr::" + (view.is_generator ? "generator" : view.kind);
  Texts described;
  if (!view.descriptor.empty()) described.push_back(view.descriptor);
  if (view.is_generator) {
    described.push_back(view.generator_parameter ? view.generator_parameter->descriptor : "void");
  }
  if (!described.empty()) head += "<" + join(described, ", ") + ">";
  Texts items{quoted(view.wire_name)};
  if (view.is_objref) {
    items.push_back(quoted(view.object_type));
    if (view.has_index) {
      items.emplace_back(view.has_int32_index ? "::rr::IndexForm::int32"
                                              : "::rr::IndexForm::string");
    }
  }
  const bool takes_parameters = view.is_function || view.is_event || view.is_callback;
  if (view.has_parameters) {
    items.push_back(object_tables + "::" + view.name);
  } else if (!access.empty() && takes_parameters) {
    items.emplace_back("{}");
  }
  if (!access.empty() && !view.is_objref) items.push_back(access);
  return list({.before = head + "(", .items = items, .after = "),"}, 4);
}

std::string parameter_table(const MemberView& view) {
  List table{.before = "static constexpr ::rr::Parameter " + view.name + "[] = {",
             .items = {},
             .after = "};"};
  for (const ParameterView& parameter : view.parameters) {
    table.items.push_back(list({.before = "::rr::parameter<" + parameter.descriptor + ">(",
                                .items = {quoted(parameter.wire_name)},
                                .after = ")"},
                               in_class + 4));
  }
  return braced_list(table, in_class);
}

}  // namespace robdef::cpp
