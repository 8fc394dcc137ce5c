// SPDX-License-Identifier: Apache-2.0
#include "rr/realtime/state_bus.hpp"

#include "rr/error.hpp"

namespace rr::realtime {
namespace {

[[noreturn]] void throw_not_found(std::string_view name) {
  throw Error(ErrorCode::key_not_found, "the bus has no `" + std::string(name) + "`");
}

}  // namespace

void StateBus::add_group(const std::string& name, std::size_t size, Group group) {
  const auto refuse = [&](const std::string& why) {
    throw Error(ErrorCode::invalid_argument, "group `" + name + "` of the bus: " + why);
  };
  if (name.empty() || name.find('.') != std::string::npos) refuse("no name for a group");
  if (group.layout.size() != size) refuse("its layout is of another pod");
  if (!groups_.emplace(name, std::move(group)).second) refuse("the name is taken");
}

const StateBus::Group& StateBus::find_group(std::string_view name) const {
  const auto found = groups_.find(name);
  if (found == groups_.end()) throw_not_found(name);
  return found->second;
}

StateBus::Found StateBus::find(std::string_view signal) const {
  const std::size_t dot = signal.find('.');
  if (dot == std::string_view::npos) throw_not_found(signal);
  const auto group = groups_.find(signal.substr(0, dot));
  if (group == groups_.end()) throw_not_found(signal);
  const Signal* const found = group->second.layout.find(signal.substr(dot + 1));
  if (found == nullptr) throw_not_found(signal);
  return {&group->second, found};
}

std::vector<std::string> StateBus::signal_names() const {
  std::vector<std::string> names;
  for (const auto& [name, group] : groups_) {
    for (const Signal& signal : group.layout.signals()) names.push_back(name + '.' + signal.name);
  }
  return names;
}

std::vector<double> StateBus::get(std::string_view signal) const {
  const Found found = find(signal);
  std::vector<std::byte> pod(found.group->layout.size());
  found.group->read(pod.data());
  std::vector<double> values;
  for (std::uint32_t i = 0; i < found.signal->count; ++i) {
    values.push_back(Layout::get(*found.signal, pod.data(), i));
  }
  return values;
}

std::vector<std::byte> StateBus::snapshot(std::string_view group) const {
  const Group& found = find_group(group);
  std::vector<std::byte> pod(found.layout.size());
  found.read(pod.data());
  std::vector<std::byte> bytes(found.layout.packed_size());
  found.layout.pack(pod.data(), bytes);
  return bytes;
}

void StateBus::set(std::string_view signal, double value, std::uint32_t index) {
  const Found found = find(signal);
  if (!found.group->change) {
    throw Error(ErrorCode::read_only_member,
                "`" + std::string(signal) + "` is written by the loop alone");
  }
  found.group->change([&](void* pod) { Layout::set(*found.signal, pod, value, index); });
}

void StateBus::set(std::string_view signal, const std::vector<double>& values) {
  const Found found = find(signal);
  if (!found.group->change) {
    throw Error(ErrorCode::read_only_member,
                "`" + std::string(signal) + "` is written by the loop alone");
  }
  found.group->change([&](void* pod) {
    for (std::uint32_t i = 0; i < values.size(); ++i) {
      Layout::set(*found.signal, pod, values[i], i);
    }
  });
}

const Layout& StateBus::layout(std::string_view group) const { return find_group(group).layout; }

}  // namespace rr::realtime
