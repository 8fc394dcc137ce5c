// SPDX-License-Identifier: Apache-2.0
#include "conformance/harness/passing_parts.hpp"

#include <algorithm>
#include <string>

#include "conformance/harness/entry_types.hpp"

namespace rr::conformance {
namespace {

template <class Elements>
auto* named(Elements& elements, const char* name) {
  const auto found = std::find_if(elements.begin(), elements.end(), [&](const Json& element) {
    return element.value("name", std::string()) == name;
  });
  return found == elements.end() ? nullptr : &*found;
}

bool is_entry(const Json& entry, EntryType type) {
  return entry.at("entry_type") == number_of(type);
}

// The index of a generator that an element holds, as its JSON; null for anything else.
template <class Element>
auto* index_in(Element* element) {
  constexpr int int32_type = 7;
  const bool is_index = element != nullptr && element->at("type") == int32_type &&
                        element->contains("value") && element->at("value").size() == 1;
  return is_index ? &element->at("value").at(0) : nullptr;
}

// {seconds, nanoseconds} with nothing wrong in it.
bool is_time(const Json& element) {
  if (!element.contains("elements") || element["elements"].size() != 2) return false;
  const Json* nanoseconds = named(element["elements"], "nanoseconds");
  const Json* value = index_in(nanoseconds);
  return value != nullptr && *value >= 0 && *value < 1'000'000'000;
}

}  // namespace

void put_aside_packet_time(const Json& recorded, Json& live) {
  const Json* before = named(recorded.at("elements"), "packettime");
  Json* now = named(live.at("elements"), "packettime");
  if (before == nullptr || now == nullptr || !is_time(*before) || !is_time(*now)) return;
  for (const Json& part : before->at("elements")) {
    Json* other = named(now->at("elements"), part.at("name").get_ref<const std::string&>().c_str());
    if (other != nullptr && other->at("type") == part.at("type") &&
        other->at("count") == part.at("count")) {
      other->at("value") = part.at("value");
    }
  }
}

void put_aside_generator_index(const Json& recorded, Json& live, Generators& generators) {
  if (!is_entry(recorded, EntryType::function_call_res) ||
      !is_entry(live, EntryType::function_call_res)) {
    return;
  }
  const Json* before = index_in(named(recorded.at("elements"), "index"));
  Json* now = index_in(named(live.at("elements"), "index"));
  if (before == nullptr || now == nullptr) return;
  generators.insert_or_assign(before->get<std::int32_t>(), now->get<std::int32_t>());
  *now = *before;
}

void rename_generator(Json& entry, const Generators& generators) {
  if (!is_entry(entry, EntryType::generator_next_req)) return;
  Json* index = index_in(named(entry.at("elements"), "index"));
  if (index == nullptr) return;
  const auto known = generators.find(index->get<std::int32_t>());
  if (known != generators.end()) *index = known->second;
}

}  // namespace rr::conformance
