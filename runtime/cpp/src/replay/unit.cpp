// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/replay/unit.hpp"

#include <algorithm>
#include <utility>

#include "runtime/cpp/src/replay/words.hpp"

namespace rr::replay {
namespace {

// The value of an element without its name.
std::string value_text(const ElementTree& element) {
  const std::string text = text_of(element);
  return text.substr(label_of(element).size() + 2);
}

std::optional<std::string> difference(const ElementTree& recorded, const ElementTree& live,
                                      const std::string& path) {
  if (label_of(recorded) != label_of(live)) {
    return path + "element `" + label_of(recorded) + "` recorded, `" + label_of(live) + "` came";
  }
  const std::string name = path + "`" + label_of(recorded) + "`";
  const bool is_alike = recorded.type == live.type && recorded.type_name == live.type_name &&
                        recorded.metadata == live.metadata && recorded.extended == live.extended &&
                        recorded.count == live.count;
  if (!is_alike || recorded.payload != live.payload ||
      recorded.elements.size() != live.elements.size()) {
    const std::string before = value_text(recorded);
    const std::string now = value_text(live);
    return before == now ? name + " has other contents"
                         : name + ": " + before + " recorded, " + now + " came";
  }
  for (std::size_t i = 0; i < recorded.elements.size(); ++i) {
    if (auto found = difference(recorded.elements[i], live.elements[i], name + " in ")) {
      return found;
    }
  }
  return std::nullopt;
}

bool is_split(EntryType type) {
  return type == EntryType::pipe_packet || type == EntryType::pipe_packet_ret;
}

}  // namespace

std::vector<Unit> units_of(const std::shared_ptr<const MessageTree>& message) {
  std::vector<Unit> units;
  for (const EntryTree& entry : message->entries) {
    if (!is_split(entry.type) || entry.elements.size() < 2) {
      units.push_back({message, entry});
      continue;
    }
    for (const ElementTree& element : entry.elements) {
      units.push_back({message, entry});
      units.back().entry.elements = {element};
    }
  }
  return units;
}

bool may_be(const EntryTree& recorded, const EntryTree& live) {
  return recorded.type == live.type && recorded.service_path == live.service_path &&
         recorded.member == live.member &&
         (is_request(recorded.type) || recorded.request_id == live.request_id);
}

std::optional<std::string> difference(const EntryTree& recorded, const EntryTree& live) {
  if (recorded.error != live.error) {
    return "error " + std::to_string(recorded.error) + " recorded, " + std::to_string(live.error) +
           " came: " + text_of(live);
  }
  if (recorded.metadata != live.metadata) return "other metadata came";
  for (std::size_t i = 0; i < std::min(recorded.elements.size(), live.elements.size()); ++i) {
    if (auto found = difference(recorded.elements[i], live.elements[i], "")) return found;
  }
  if (recorded.elements.size() == live.elements.size()) return std::nullopt;
  return std::to_string(recorded.elements.size()) + " elements recorded, " +
         std::to_string(live.elements.size()) + " came";
}

}  // namespace rr::replay
