// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/replay/parts.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

#include "runtime/cpp/src/replay/words.hpp"

namespace rr::replay {
namespace {

template <class Elements>
auto* find_in(Elements& elements, std::string_view name) {
  const auto found = std::find_if(elements.begin(), elements.end(),
                                  [&](const ElementTree& each) { return each.name == name; });
  return found == elements.end() ? nullptr : &*found;
}

void put(ElementTree& element, std::int32_t value) {
  std::memcpy(element.payload.data(), &value, sizeof value);
}

void take_over(const ElementTree& recorded, ElementTree& live) {
  live.payload = recorded.payload;
  live.count = recorded.count;
}

// {seconds, nanoseconds} with nothing wrong in it.
bool is_time(const ElementTree& element) {
  if (element.elements.size() != 2) return false;
  const ElementTree* const part = find_named(element.elements, "nanoseconds");
  const auto nanoseconds = part == nullptr ? std::nullopt : int32_of(*part);
  return nanoseconds && *nanoseconds >= 0 && *nanoseconds < 1'000'000'000;
}

// A URL in front of its port and behind it; nothing when the text is none.
struct AroundPort {
  std::string_view front;
  std::string_view back;
  bool operator==(const AroundPort&) const = default;
};
std::optional<AroundPort> around_port(std::string_view text) {
  constexpr std::string_view scheme = "rr+tcp://";
  if (!text.starts_with(scheme)) return std::nullopt;
  const std::size_t path = text.find('/', scheme.size());
  if (path == std::string_view::npos) return std::nullopt;
  const std::size_t colon = text.rfind(':', path);
  if (colon == std::string_view::npos || colon < scheme.size() || colon + 1 == path) {
    return std::nullopt;
  }
  const std::string_view port = text.substr(colon + 1, path - colon - 1);
  if (port.find_first_not_of("0123456789") != std::string_view::npos) return std::nullopt;
  return AroundPort{text.substr(0, colon), text.substr(path)};
}

void put_aside_port_of(const ElementTree& recorded, ElementTree& live) {
  if (recorded.type == ElementType::string && live.type == ElementType::string) {
    const auto before = around_port(string_of(recorded));
    if (before && before == around_port(string_of(live))) take_over(recorded, live);
  }
  for (std::size_t i = 0; i < std::min(recorded.elements.size(), live.elements.size()); ++i) {
    put_aside_port_of(recorded.elements[i], live.elements[i]);
  }
}

}  // namespace

const ElementTree* find_named(const std::vector<ElementTree>& elements, std::string_view name) {
  return find_in(elements, name);
}
ElementTree* find_named(std::vector<ElementTree>& elements, std::string_view name) {
  return find_in(elements, name);
}

std::optional<std::int32_t> int32_of(const ElementTree& element) {
  std::int32_t value = 0;
  if (element.type != ElementType::int32 || element.payload.size() != sizeof value) {
    return std::nullopt;
  }
  std::memcpy(&value, element.payload.data(), sizeof value);
  return value;
}

void put_aside_client_version(const EntryTree& recorded, EntryTree& live) {
  constexpr std::string_view name = "clientversion";
  const ElementTree* const before = find_named(recorded.elements, name);
  ElementTree* const now = find_named(live.elements, name);
  if (before != nullptr && now != nullptr && before->type == ElementType::string &&
      now->type == ElementType::string) {
    take_over(*before, *now);
  }
}

void put_aside_packet_time(const EntryTree& recorded, EntryTree& live) {
  constexpr std::string_view name = "packettime";
  const ElementTree* const before = find_named(recorded.elements, name);
  ElementTree* const now = find_named(live.elements, name);
  if (before == nullptr || now == nullptr || !is_time(*before) || !is_time(*now)) return;
  for (const ElementTree& part : before->elements) {
    ElementTree* const other = find_named(now->elements, part.name);
    if (other != nullptr && other->type == part.type &&
        other->payload.size() == part.payload.size()) {
      other->payload = part.payload;
    }
  }
}

void put_aside_ports(const EntryTree& recorded, EntryTree& live) {
  for (std::size_t i = 0; i < std::min(recorded.elements.size(), live.elements.size()); ++i) {
    put_aside_port_of(recorded.elements[i], live.elements[i]);
  }
}

void put_aside_generator_index(const EntryTree& recorded, EntryTree& live, Generators& generators) {
  if (recorded.type != EntryType::function_call_res || live.type != EntryType::function_call_res) {
    return;
  }
  const ElementTree* const element = find_named(recorded.elements, "index");
  ElementTree* const other = find_named(live.elements, "index");
  const auto before = element == nullptr ? std::nullopt : int32_of(*element);
  const auto now = other == nullptr ? std::nullopt : int32_of(*other);
  if (!before || !now) return;
  generators.insert_or_assign(*before, *now);
  put(*other, *before);
}

void rename_generator(EntryTree& entry, const Generators& generators) {
  if (entry.type != EntryType::generator_next_req) return;
  ElementTree* const element = find_named(entry.elements, "index");
  if (element == nullptr) return;
  const auto index = int32_of(*element);
  const auto known = index ? generators.find(*index) : generators.end();
  if (known != generators.end()) put(*element, known->second);
}

void put_in_order(const EntryTree& recorded, EntryTree& live) {
  std::vector<ElementTree> ordered;
  for (const ElementTree& element : recorded.elements) {
    if (const ElementTree* found = find_named(live.elements, element.name)) {
      ordered.push_back(*found);
    }
  }
  if (ordered.size() == live.elements.size()) live.elements = std::move(ordered);
}

void rename_endpoints(MessageTree& message, const Endpoints& names) {
  for (std::uint32_t* const endpoint : {&message.sender_endpoint, &message.receiver_endpoint}) {
    const auto name = names.find(*endpoint);
    if (name != names.end()) *endpoint = name->second;
  }
}

void learn_endpoint(const MessageTree& recorded, const MessageTree& live, Endpoints& endpoints) {
  if (recorded.sender_endpoint != 0 && live.sender_endpoint != 0) {
    endpoints.try_emplace(recorded.sender_endpoint, live.sender_endpoint);
  }
}

std::vector<std::byte> connection_test_answer(const MessageTree& test) {
  if (test.entries.empty() || test.entries.front().type != EntryType::connection_test) return {};
  MessageTree answer = test;
  answer.entries.front().type = EntryType::connection_test_ret;
  std::swap(answer.sender_node, answer.receiver_node);
  std::swap(answer.sender_name, answer.receiver_name);
  std::swap(answer.sender_endpoint, answer.receiver_endpoint);
  return write_tree(answer);
}

}  // namespace rr::replay
