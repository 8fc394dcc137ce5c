// SPDX-License-Identifier: Apache-2.0
#include "compiler/backends/arduino/members.hpp"

#include "compiler/backends/arduino/backend.hpp"
#include "compiler/backends/arduino/names.hpp"
#include "compiler/backends/implements.hpp"
#include "compiler/backends/words.hpp"
#include "compiler/output/prose.hpp"

namespace robdef::arduino {

using model::MemberKind;

std::string group_name(const Group& group) {
  std::string name;
  for (const std::string& step : group.path) name += name.empty() ? camel(step) : pascal(step);
  return name.empty() ? "root" : name;
}

std::string device_name(const model::Object& object) {
  return pascal(code_name(object)) + "Device";
}

std::vector<MemberView> MemberMaker::make(std::size_t group) {
  std::vector<MemberView> views;
  MemberNames names{Scope(report_), Scope(report_)};
  const model::Object& object = *groups_[group].object;
  if (object.members.size() > 255) {
    report_.add(Code::R0922, object.span, "an object of a board has 255 members at most")
        .help("move some of them to an object of an objref");
  }
  for (const model::Member& member : object.members) {
    MemberView view;
    describe(view, member);
    view.number = std::to_string(views.size());
    view.doc = prose(without_limits(member.documentation), "/// ", 98);
    if (!board_abilities.serve(member)) {
      const bool is_memory = member.kind == MemberKind::memory;
      report_
          .add(Code::R0920, member.span,
               std::string(is_memory ? "a memory" : "a generator") + " cannot be served by a board")
          .help(is_memory ? "use a function that gives a part of it, of a bounded length"
                          : "use a pipe, or a function that gives one value at each call");
    } else {
      make_one(member, group, view, names);
    }
    views.push_back(std::move(view));
  }
  return views;
}

void MemberMaker::make_one(const model::Member& member, std::size_t group, MemberView& view,
                           MemberNames& names) {
  const std::string path = full_name(*groups_[group].object, member);
  const bool is_new = !names.own.has(identifier(camel(code_name(member))));
  const std::string name = names.own.add(camel(code_name(member)), member.name, member.span, path);
  const std::string big = pascal(code_name(member));
  view.getter = "get" + big;
  view.setter = "set" + big;
  view.field = camel(code_name(member)) + "_";
  view.can_get = !member.access.is_writeonly;
  view.can_set = !member.access.is_readonly;
  // One of two whose own names are one has been reported.
  const auto take = [&](const std::string& hook) {
    if (is_new) (void)names.hooks.add(hook, member.name, member.span, path);
  };
  const bool is_value = member.kind == MemberKind::property || member.kind == MemberKind::wire;
  if (is_value && view.can_get) take(view.getter);
  if (is_value && view.can_set) take(view.setter);
  if (member.kind == MemberKind::objref || member.kind == MemberKind::function) take(name);
  if (member.kind == MemberKind::callback) take("answered" + big);
  if (member.kind == MemberKind::pipe && view.can_set) take("receive" + big);
  if (member.kind == MemberKind::objref) {
    view.hook = name;
    make_objref(member, group, view);
    list_hooks(view);
    return;
  }
  const Limits limits(member.documentation, member.span, report_);
  make_value(member, view, limits);
  const std::uint64_t parameters = make_parameters(member, group, view, limits);
  limits.report_unused(report_);
  switch (member.kind) {
    case MemberKind::property:
      break;
    case MemberKind::function:
      view.hook = name;
      sizes_.take_request(parameters);
      break;
    case MemberKind::event:
      view.sender = "fire" + big;
      sizes_.take_queued(parameters);
      break;
    case MemberKind::callback:
      view.sender = "ask" + big;
      view.hook = "answered" + big;
      sizes_.take_queued(parameters);
      break;
    case MemberKind::pipe:
      view.sender = "send" + big;
      view.setter = "receive" + big;
      take_slots(group, view);
      break;
    case MemberKind::wire:
      view.sender = camel(code_name(member)) + "Changed";
      take_slots(group, view);
      break;
    case MemberKind::objref:
    case MemberKind::memory:
      break;
  }
  list_hooks(view);
}

void MemberMaker::make_value(const model::Member& member, MemberView& view, const Limits& limits) {
  const bool is_result = member.kind == MemberKind::function || member.kind == MemberKind::callback;
  const BoardType type = types_.spell(member.type, {limits, is_result ? "return" : ""});
  types_.check_size(type.size, member.span, "values");
  view.value_type = type.text;
  view.value_passed = type.text.empty() ? "" : type.passed();
  view.has_result = !type.text.empty();
  sizes_.has_double = sizes_.has_double || type.has_double;
  if (member.kind == MemberKind::callback) {
    sizes_.take_request(type.size + 1);
  } else if (member.kind == MemberKind::function) {
    sizes_.take_reply(type.size);
  } else if (member.kind != MemberKind::event) {
    if (view.can_set) sizes_.take_request(type.size);
    if (view.can_get) sizes_.take_reply(type.size);
    if (member.kind == MemberKind::pipe && view.can_get) sizes_.take_queued(type.size);
    if (member.kind == MemberKind::wire && view.can_get) {
      sizes_.out = std::max(sizes_.out, type.size + 2);
    }
  }
}

std::uint64_t MemberMaker::make_parameters(const model::Member& member, std::size_t group,
                                           MemberView& view, const Limits& limits) {
  const std::string path = full_name(*groups_[group].object, member) + ".";
  std::uint64_t size = 0;
  Scope scope(report_);
  std::vector<std::string> declared;
  std::vector<std::string> arguments;
  for (const model::Parameter& parameter : member.parameters) {
    const BoardType type = types_.spell(parameter.type, {limits, parameter.name});
    size += type.size;
    sizes_.has_double = sizes_.has_double || type.has_double;
    const std::string written = as_variable(camel(code_name(parameter)));
    // Names of the generated functions' own variables.
    const bool is_taken = written == "request" || written == "reply" || written == "device" ||
                          written == "index" || written == "result" || written == "status";
    const std::string name = scope.add(is_taken ? written + "_" : written, parameter.name,
                                       parameter.span, path + parameter.name);
    view.parameters.push_back({type.text, name});
    if (!type.text.empty()) declared.push_back(type.passed() + " " + name);
    arguments.push_back(name);
  }
  types_.check_size(size, member.span, "parameters");
  if (member.kind == MemberKind::function && view.has_result) {
    declared.push_back(view.value_type + "& result");
    arguments.emplace_back("result");
  }
  view.has_parameters = !view.parameters.empty();
  view.declared = join(declared, ", ");
  view.arguments = join(arguments, ", ");
  return size;
}

void MemberMaker::make_objref(const model::Member& member, std::size_t group, MemberView& view) {
  for (const Group& child : groups_) {
    if (child.via != &member || child.parent != group) continue;
    view.child_first_plus = plus(child.first);
    view.child_count = std::to_string(child.fan);
    view.child_index = groups_[group].count == 1 ? "which"
                       : child.fan == 1          ? "index + which"
                                                 : "index * " + view.child_count + " + which";
    view.child_class = device_name(*child.object);
    view.child_find = "find" + pascal(group_name(child));
    view.is_indexed = member.index == model::IndexForm::int32;
  }
}

void MemberMaker::take_slots(std::size_t group, MemberView& view) {
  view.slot_plus = plus(sizes_.slots);
  view.slot_minus = minus(sizes_.slots);
  view.slot_from = sizes_.slots == 0 ? "" : "slot >= " + std::to_string(sizes_.slots) + " && ";
  sizes_.slots += groups_[group].count;
  view.slot_end = std::to_string(sizes_.slots);
}

void MemberMaker::list_hooks(MemberView& view) const {
  const std::string status = "rr::Status ";
  if (view.is_property || view.is_wire) {
    if (view.can_get) {
      view.hook_lines.push_back(status + view.getter + "(" + view.value_type + "& value);");
    }
    if (view.can_set) {
      view.hook_lines.push_back(status + view.setter + "(" + view.value_passed + " value);");
    }
  } else if (view.is_pipe && view.can_set) {
    view.hook_lines.push_back(status + view.setter + "(" + view.value_passed + " packet);");
  } else if (view.is_function) {
    view.hook_lines.push_back(status + view.hook + "(" + view.declared + ");");
  } else if (view.is_callback) {
    view.hook_lines.push_back("void " + view.hook + "(rr::Status status" +
                              (view.has_result ? ", " + view.value_passed + " result" : "") + ");");
  } else if (view.is_objref) {
    view.hook_lines.push_back(view.child_class + "* " + view.hook +
                              (view.is_indexed ? "(uint8_t index);" : "();"));
  }
}

}  // namespace robdef::arduino
