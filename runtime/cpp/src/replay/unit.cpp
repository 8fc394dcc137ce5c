// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/replay/unit.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "runtime/cpp/src/replay/words.hpp"

namespace rr::replay {
namespace {

// The value of an element without its name.
std::string value_text(const ElementTree& element) {
  const std::string text = text_of(element);
  return text.substr(label_of(element).size() + 2);
}

// Whether two floats are near enough.
template <class Float>
bool is_near(Float recorded, Float live, double tolerance) {
  if (recorded == live || (std::isnan(recorded) && std::isnan(live))) return true;
  if (!std::isfinite(recorded) || !std::isfinite(live)) return false;
  const double before = recorded;
  return std::abs(live - before) <= tolerance * std::max(1.0, std::abs(before));
}

template <class Float>
bool are_near(const std::vector<std::byte>& recorded, const std::vector<std::byte>& live,
              double tolerance) {
  if (recorded.size() != live.size() || recorded.size() % sizeof(Float) != 0) return false;
  for (std::size_t at = 0; at != recorded.size(); at += sizeof(Float)) {
    Float before = 0;
    Float now = 0;
    std::memcpy(&before, recorded.data() + at, sizeof before);
    std::memcpy(&now, live.data() + at, sizeof now);
    if (!is_near(before, now, tolerance)) return false;
  }
  return true;
}

bool have_like_payloads(const ElementTree& recorded, const ElementTree& live, double tolerance) {
  if (recorded.payload == live.payload) return true;
  if (!(tolerance > 0) || recorded.type != live.type) return false;
  switch (recorded.type) {
    case ElementType::double_:
    case ElementType::cdouble:
      return are_near<double>(recorded.payload, live.payload, tolerance);
    case ElementType::single:
    case ElementType::csingle:
      return are_near<float>(recorded.payload, live.payload, tolerance);
    default:
      return false;
  }
}

std::optional<std::string> difference(const ElementTree& recorded, const ElementTree& live,
                                      const std::string& path, double tolerance) {
  if (label_of(recorded) != label_of(live)) {
    return path + "element `" + label_of(recorded) + "` recorded, `" + label_of(live) + "` came";
  }
  const std::string name = path + "`" + label_of(recorded) + "`";
  const bool is_alike = recorded.type == live.type && recorded.type_name == live.type_name &&
                        recorded.metadata == live.metadata && recorded.extended == live.extended &&
                        recorded.count == live.count;
  if (!is_alike || !have_like_payloads(recorded, live, tolerance) ||
      recorded.elements.size() != live.elements.size()) {
    const std::string before = value_text(recorded);
    const std::string now = value_text(live);
    return before == now ? name + " has other contents"
                         : name + ": " + before + " recorded, " + now + " came";
  }
  for (std::size_t i = 0; i < recorded.elements.size(); ++i) {
    if (auto found = difference(recorded.elements[i], live.elements[i], name + " in ", tolerance)) {
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

bool is_about(const EntryTree& entry, const std::vector<std::string>& paths) {
  const std::string place = place_of(entry);
  return std::any_of(paths.begin(), paths.end(), [&](const std::string& path) {
    if (!place.starts_with(path)) return false;
    return place.size() == path.size() || place[path.size()] == '.' || place[path.size()] == '[';
  });
}

std::optional<std::string> difference(const EntryTree& recorded, const EntryTree& live,
                                      double tolerance) {
  if (recorded.error != live.error) {
    return "error " + std::to_string(recorded.error) + " recorded, " + std::to_string(live.error) +
           " came: " + text_of(live);
  }
  if (recorded.metadata != live.metadata) return "other metadata came";
  for (std::size_t i = 0; i < std::min(recorded.elements.size(), live.elements.size()); ++i) {
    if (auto found = difference(recorded.elements[i], live.elements[i], "", tolerance))
      return found;
  }
  if (recorded.elements.size() == live.elements.size()) return std::nullopt;
  return std::to_string(recorded.elements.size()) + " elements recorded, " +
         std::to_string(live.elements.size()) + " came";
}

}  // namespace rr::replay
