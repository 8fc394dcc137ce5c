// SPDX-License-Identifier: Apache-2.0
#include "compiler/backends/arduino/view.hpp"

#include <algorithm>
#include <set>

#include "compiler/backends/arduino/members.hpp"
#include "compiler/backends/arduino/names.hpp"
#include "compiler/backends/arduino/spaces.hpp"
#include "compiler/backends/words.hpp"
#include "compiler/output/prose.hpp"

namespace robdef::arduino {
namespace {

/// The definition's imports, each before those that import it, the definition itself last.
void collect(const model::Definition& definition, std::vector<const model::Definition*>& order) {
  if (std::ranges::find(order, &definition) != order.end()) return;
  for (const model::Definition* import : definition.imports) collect(*import, order);
  order.push_back(&definition);
}

GroupView make_group(const std::vector<Group>& groups, std::size_t at, MemberMaker& members) {
  const Group& group = groups[at];
  GroupView view;
  view.name = group_name(group);
  view.sender_class = pascal(view.name) + "Sender";
  view.handler = "handle" + pascal(view.name);
  view.find = "find" + pascal(view.name);
  view.device = device_name(*group.object);
  view.first_plus = plus(group.first);
  view.first_minus = minus(group.first);
  view.end = std::to_string(group.first + group.count);
  view.is_root = at == 0;
  view.is_several = group.count > 1;
  if (group.via != nullptr) {
    view.parent_find = "find" + pascal(group_name(groups[group.parent]));
    const std::string fan = std::to_string(group.fan);
    const bool has_one_parent = group.count == group.fan;
    view.parent_index = has_one_parent ? "0" : group.fan == 1 ? "index" : "index / " + fan;
    view.own_index = has_one_parent ? "index" : group.fan == 1 ? "0" : "index % " + fan;
    view.is_indexed = group.via->index == model::IndexForm::int32;
    view.hook = identifier(camel(code_name(*group.via)));
  }
  view.uses_index = group.via != nullptr && (view.is_indexed || group.count != group.fan);
  view.members = members.make(at);
  return view;
}

void add_devices(const std::vector<Group>& groups, ServiceView& view) {
  std::set<const model::Object*> known;
  std::vector<std::string> parameters;
  std::vector<std::string> arguments;
  std::vector<std::string> drafted;
  for (std::size_t at = 0; at < groups.size(); ++at) {
    const model::Object& object = *groups[at].object;
    if (!known.insert(&object).second) continue;
    const std::string name = device_name(object);
    view.devices.push_back({.parameter = name,
                            .name = pascal(code_name(object)),
                            .wire_name = object.name,
                            .doc = prose(without_limits(object.documentation), "/// ", 100),
                            .members = view.groups[at].members});
    for (MemberView& member : view.devices.back().members) {
      // In the draft the classes have their own names.
      if (!member.is_objref || member.child_class.empty()) continue;
      member.child_class.resize(member.child_class.size() - std::string_view("Device").size());
    }
    parameters.push_back("class " + name);
    arguments.push_back(name);
    drafted.push_back(pascal(code_name(object)));
  }
  // Classes that others give come before them.
  std::ranges::reverse(view.devices);
  view.template_parameters = join(parameters, ", ");
  view.template_arguments = join(arguments, ", ");
  view.draft_arguments = join(drafted, ", ");
}

void add_sizes(const Sizes& sizes, const ServiceTexts& texts, ServiceView& view) {
  constexpr std::uint64_t overhead = 5;
  constexpr std::uint64_t stuffing = 2;
  const std::uint64_t queue =
      std::min<std::uint64_t>(std::max(2 * sizes.queue_most, sizes.queue_sum),
                              std::max<std::uint64_t>(300, sizes.queue_most));
  const auto text_of = [](std::uint64_t number) { return std::to_string(number); };
  view.request_size = text_of(sizes.request + overhead);
  view.reply_size = text_of(sizes.reply + overhead);
  view.out_size = text_of(sizes.out + overhead);
  view.queue_size = text_of(std::max<std::uint64_t>(queue, 1));
  view.slots = text_of(sizes.slots);
  view.slot_bytes = text_of(std::max<std::uint64_t>(sizes.slots, 1));

  std::uint64_t members = 0;
  for (const GroupView& group : view.groups) members += group.members.size();
  // Measured on an ATmega328P with avr-gcc 5.4; the core is that of a sketch with a serial port.
  const std::uint64_t ram = sizes.request + sizes.reply + sizes.out + 3 * overhead + 2 * stuffing +
                            queue + sizes.slots + 4 * view.texts.size() + 79;
  const std::uint64_t flash = 2350 + (sizes.has_double ? 700 : 0) + 90 * members + texts.bytes;
  view.estimate = view.path + ": about " + text_of(flash) + " bytes of flash and " + text_of(ram) +
                  " of RAM, besides the core (about 1600 and 185) and the sketch's own";
}

ServiceView make_service(const model::Definition& definition, const model::Object& root,
                         Report& report) {
  ServiceView view;
  view.path = sketch_name(definition.name);
  view.wire_name = definition.name;
  view.class_name = pascal(code_name(root)) + "Service";
  view.qualified = qualified(definition, view.class_name);
  view.root_device = device_name(root);
  const std::vector<Group> groups = find_groups(root, report);
  BoardTypes types(report);
  MemberMaker members(types, groups, report);
  for (std::size_t at = 0; at < groups.size(); ++at) {
    view.groups.push_back(make_group(groups, at, members));
  }
  std::vector<const model::Definition*> order;
  collect(definition, order);
  for (const model::Definition* one : order) {
    SpaceView space = make_space(*one, types, report);
    if (one == &definition) {
      view.own = std::move(space);
    } else {
      view.spaces.push_back(std::move(space));
    }
  }
  for (const GroupView& group : view.groups) {
    for (const MemberView& member : group.members) {
      view.sends_wires = view.sends_wires || (member.is_wire && member.can_get);
    }
  }
  view.exceptions = exception_lines(definition, report);
  add_devices(groups, view);
  const ServiceTexts texts = service_texts(definition, root);
  view.texts = texts.views;
  view.text_count = std::to_string(texts.views.size());
  view.hash = texts.hash;
  add_sizes(members.sizes(), texts, view);
  return view;
}

}  // namespace

ModelView make_view(const model::Model& model, Report& report) {
  ModelView view;
  for (const auto& definition : model.definitions()) {
    if (definition->is_import || definition->objects.empty()) continue;
    const model::Object* const root = find_root(*definition, report);
    if (root != nullptr) view.services.push_back(make_service(*definition, *root, report));
  }
  return view;
}

}  // namespace robdef::arduino
