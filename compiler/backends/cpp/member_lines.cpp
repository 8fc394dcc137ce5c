// SPDX-License-Identifier: Apache-2.0
// Members that are calls: properties, functions, generators, callbacks, objrefs.
#include "compiler/backends/cpp/member_lines.hpp"

#include <algorithm>
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

/// The terms of a call: its parameter is the last one of what blocks, and in front of the token of
/// what does not.
std::string options_name(const MemberView& view, const Names& names) {
  std::set<std::string> taken = taken_by(view);
  taken.insert(token_name(view, names));
  return names.local("options", taken);
}
std::string options_parameter(const std::string& options) {
  return "const ::rr::CallOptions& " + options;
}
std::string defaulted(const std::string& parameter) { return parameter + " = {}"; }

/// What the asynchronous form of a member is made of.
struct AsyncForm {
  std::string name;   ///< `async_get_pan`
  Texts parameters;   ///< without the terms and the token
  Texts arguments;    ///< their names
  std::string call;   ///< `return rr_async_get<double>(`
  Texts passed;       ///< what it takes behind member, terms and token
  std::string after;  ///< ` const`
};

/// With terms, and without.
void lay_out_async(MemberView& view, const Names& names, const AsyncForm& form,
                   std::string& with_options, std::string& plain) {
  const std::string token = token_name(view, names);
  const std::string options = options_name(view, names);
  const auto signature = [&](const Texts& more) {
    return Signature{.result = "auto",
                     .name = form.name,
                     .parameters = with(form.parameters, more),
                     .after = form.after};
  };
  const std::string handed = forwarded(view, token);
  with_options =
      definition(signature({options_parameter(options), token_parameter(view, token)}),
                 List{form.call, with({view.entry, options, handed}, form.passed), ");"}, in_class);
  plain = definition(signature({token_parameter(view, token)}),
                     List{"return " + form.name + "(",
                          with(form.arguments, {"::rr::CallOptions()", handed}), ");"},
                     in_class);
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

/// How a member is called from where its parameters are: one of them may have its name.
std::string called(const MemberView& view) {
  const bool is_hidden =
      std::any_of(view.parameters.begin(), view.parameters.end(),
                  [&](const ParameterView& parameter) { return parameter.name == view.name; });
  return (is_hidden ? "this->" : "") + view.name;
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
  List call{.before = called(view) + "(", .items = names_of(view.parameters), .after = ");"};
  if (!view.has_result) return long_definition(signature, call, answer + "();", in_class);
  call.before.insert(0, answer + "(");
  call.after = "));";
  return definition(signature, call, in_class);
}

/// In rr_dispatch: the call of a generator function and, around it, that of `answer`, behind which
/// is broken when the inner one cannot be broken at its parenthesis.
std::string answer_with(const MemberView& view) {
  const std::string outer = "return rr_request.answer(";
  List call{.before = outer + called(view) + "(", .items = moved(view.parameters), .after = "));"};
  std::string result = list(call, in_case);
  if (result.substr(0, result.find('\n')).back() != '(') return result;
  call.before = called(view) + "(";
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
  const std::string stored = stored_name(view);
  const std::string options = options_name(view, names);
  const std::string terms = defaulted(options_parameter(options));
  Signature get = getter(view);
  get.parameters.push_back(terms);
  view.stub_get = definition(
      get, List{"return rr_get<" + view.type + ">(", {view.entry, options}, ");"}, in_class);
  Signature set = setter(view);
  set.parameters.push_back(terms);
  view.stub_set =
      definition(set, List{"rr_set(", {view.entry, options, "&" + view.value}, ");"}, in_class);
  lay_out_async(view, names,
                {.name = "async_" + view.getter,
                 .parameters = {},
                 .arguments = {},
                 .call = "return rr_async_get<" + view.type + ">(",
                 .passed = {},
                 .after = ""},
                view.async_get, view.plain_async_get);
  lay_out_async(view, names,
                {.name = "async_" + view.setter,
                 .parameters = {view.passed + " " + view.value},
                 .arguments = {view.value},
                 .call = "return rr_async_set<" + view.type + ">(",
                 .passed = {view.value},
                 .after = ""},
                view.async_set, view.plain_async_set);
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
  const std::string options = options_name(view, names);
  const Texts parameters = passed(view.parameters);
  const Texts arguments = names_of(view.parameters);
  const std::string async_name = "async_" + view.name;
  const std::string returns = view.has_result ? "return " : "";
  view.stub_call = definition(
      {.result = view.type,
       .name = view.name,
       .parameters = with(parameters, {defaulted(options_parameter(options))})},
      List{returns + "rr_call<" + view.type + ">(", with({view.entry, options}, arguments), ");"},
      in_class);
  lay_out_async(view, names,
                {.name = async_name,
                 .parameters = parameters,
                 .arguments = arguments,
                 .call = "return rr_async_call<" + view.type + ">(",
                 .passed = arguments,
                 .after = ""},
                view.async_call, view.plain_async_call);
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
  const std::string options = options_name(view, names);
  const Texts parameters = passed(view.parameters);
  const Texts arguments = names_of(view.parameters);
  const std::string taken = view.generator_parameter ? view.generator_parameter->type : "void";
  const std::string of =
      "<" + view.type + (view.generator_parameter ? ", " + taken : std::string()) + ">";
  const std::string both = "<" + view.type + ", " + taken + ">";
  view.handle = "::rr::Generator" + of;
  view.served = "::rr::Sequence" + of;
  view.stub_call = definition(
      {.result = view.handle,
       .name = view.name,
       .parameters = with(parameters, {defaulted(options_parameter(options))})},
      List{"return rr_generate" + both + "(", with({view.entry, options}, arguments), ");"},
      in_class);
  lay_out_async(view, names,
                {.name = "async_" + view.name,
                 .parameters = parameters,
                 .arguments = arguments,
                 .call = "return rr_async_generate" + both + "(",
                 .passed = arguments,
                 .after = ""},
                view.async_call, view.plain_async_call);
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
  taken.insert(token_name(view, names));
  const std::string options = options_name(view, names);
  taken.insert(options);
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
  view.skeleton_call =
      definition({.result = view.type,
                  .name = view.name,
                  .parameters = with(parameters, {defaulted(options_parameter(options))}),
                  .after = " const"},
                 List{returns + "rr_call_back<" + view.type + ">(",
                      with({view.entry, options}, arguments), ");"},
                 in_class);
  lay_out_async(view, names,
                {.name = "async_" + view.name,
                 .parameters = parameters,
                 .arguments = arguments,
                 .call = "return rr_async_call_back<" + view.type + ">(",
                 .passed = arguments,
                 .after = " const"},
                view.skeleton_async, view.plain_async_call);
}

void lay_out_objref(MemberView& view, const Names& names, const std::string& stub_class) {
  const std::string options = options_name(view, names);
  std::set<std::string> taken{token_name(view, names), options};
  const std::string index = names.local("index", taken);
  const std::string index_type = view.has_int32_index ? "::std::int32_t " : "const ::std::string& ";
  Texts parameters;
  Texts arguments;
  if (view.has_index) {
    parameters.push_back(index_type + index);
    arguments.push_back(index);
  }
  const std::string pointer = "::std::shared_ptr<" + view.stub + ">";
  const std::string find = view.is_varobject ? "rr_find(" : "rr_find_as<" + view.stub + ">(";
  const std::string terms = options_parameter(options);
  view.stub_find = declaration(
      {.result = pointer, .name = view.getter, .parameters = with(parameters, {defaulted(terms)})},
      in_class);
  view.stub_find_definition =
      definition({.result = pointer,
                  .name = stub_class + "::" + view.getter,
                  .parameters = with(parameters, {terms})},
                 List{"return " + find, with({view.entry, options}, arguments), ");"}, 0);
  lay_out_async(view, names,
                {.name = "async_" + view.getter,
                 .parameters = parameters,
                 .arguments = arguments,
                 .call = "return rr_async_find<" + view.stub + ">(",
                 .passed = arguments,
                 .after = ""},
                view.async_find, view.plain_async_find);
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
