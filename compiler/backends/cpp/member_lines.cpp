// SPDX-License-Identifier: Apache-2.0
// Types and names that the lines of a member need, and its rows in tables.
#include "compiler/backends/cpp/member_lines.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include "compiler/backends/words.hpp"

namespace robdef::cpp {
namespace {

using Texts = std::vector<std::string>;

std::string types_of(const std::vector<ParameterView>& parameters) {
  Texts types;
  for (const ParameterView& parameter : parameters) types.push_back(parameter.type);
  return join(types, ", ");
}

bool is_hidden(const MemberView& view) {
  return std::ranges::find(view.parameters, view.name, &ParameterView::name) !=
         view.parameters.end();
}

void make_memory_types(MemberView& view) {
  const std::string shape = view.is_multi ? "Multi" : "Array";
  view.handle = "::rr::" + shape + "Memory<" + view.item + ">";
  view.served = "::std::shared_ptr<::rr::" + shape + "MemorySource<" + view.item + ">>";
}

/// What the methods of a member give: `handle` that of the stub, `served` that of the skeleton.
void make_types(MemberView& view) {
  if (view.is_pipe) {
    view.handle = "::rr::Pipe<" + view.type + ">";
    view.served = "::rr::PipeServer<" + view.type + ">";
  } else if (view.is_wire) {
    view.handle = "::rr::Wire<" + view.type + ">";
    view.served = "::rr::WireServer<" + view.type + ">";
  } else if (view.is_memory) {
    make_memory_types(view);
  } else if (view.is_event) {
    view.handle = view.type = "::rr::Event<" + types_of(view.parameters) + ">";
  } else if (view.is_callback) {
    view.handle = "::rr::Callback<" + view.type + "(" + types_of(view.parameters) + ")>";
  } else if (view.is_generator) {
    view.taken = view.generator_parameter ? view.generator_parameter->type : "void";
    const std::string of =
        "<" + view.type + (view.generator_parameter ? ", " + view.taken : "") + ">";
    view.handle = "::rr::Generator" + of;
    view.served = "::rr::Sequence" + of;
  }
  view.has_handle =
      view.is_pipe || view.is_wire || view.is_memory || view.is_event || view.is_callback;
}

}  // namespace

void make_forms(MemberView& view, const Names& names) {
  // What stands behind a name so that it is none of those taken, which it joins.
  const auto mark = [&names](std::string_view name, std::set<std::string>& taken) {
    return names.local(name, taken).substr(name.size());
  };
  std::set<std::string> taken;
  for (const ParameterView& parameter : view.parameters) taken.insert(parameter.name);
  std::set<std::string> of_answer = taken;
  view.answer_mark = mark("answer", of_answer);
  if (!view.is_objref && !view.is_event) taken.insert("value" + view.value_mark);
  view.token_mark = mark("token", taken);
  view.options_mark = mark("options", taken);
  std::set<std::string> of_client = taken;
  view.client_mark = mark("client", of_client);
  view.index_mark = mark("index", taken);
  view.is_hidden = is_hidden(view);
  make_types(view);
}

void make_row(MemberView& view, Texts access) {
  if (!view.descriptor.empty()) view.described.push_back(view.descriptor);
  if (view.is_generator) {
    view.described.push_back(view.generator_parameter ? view.generator_parameter->descriptor
                                                      : "void");
  }
  const bool takes_parameters = view.is_function || view.is_event || view.is_callback;
  view.has_no_table = takes_parameters && !view.has_parameters && !access.empty();
  if (!view.is_objref) view.access = std::move(access);
}

}  // namespace robdef::cpp
