// SPDX-License-Identifier: Apache-2.0
#include "conformance/harness/explanation.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

#include "conformance/harness/decoded.hpp"
#include "runtime/cpp/src/replay/words.hpp"

namespace rr::conformance {
namespace {

constexpr std::size_t most_places = 3;
constexpr std::size_t most_letters = 120;
constexpr std::size_t most_bytes = 20;

std::string text_of(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace).substr(0, most_letters);
}

std::vector<std::string> tokens_of(Json::json_pointer pointer) {
  std::vector<std::string> tokens;
  for (; !pointer.empty(); pointer.pop_back()) tokens.push_back(pointer.back());
  std::ranges::reverse(tokens);
  return tokens;
}

bool is_number(const std::string& token) {
  return !token.empty() && token.find_first_not_of("0123456789") == std::string::npos;
}

std::string counted(const std::string& index) { return std::to_string(std::stoul(index) + 1); }

std::string words_of_entry(const Json* entry) {
  if (entry == nullptr || !entry->contains("entry_type")) return {};
  const auto type = static_cast<EntryType>(entry->at("entry_type").get<int>());
  std::string place = entry->value("service_path", "");
  const std::string member = entry->value("member", "");
  if (!member.empty()) place += (place.empty() ? "" : ".") + member;
  return " (" + replay::name_of(type) + (place.empty() ? "" : " ") + place + ")";
}

std::string words_of_element(const Json* element, const std::string& index) {
  if (element != nullptr && element->contains("name")) {
    const std::string name = element->at("name").get<std::string>();
    if (!name.empty()) return "element " + name;
  }
  return "element " + counted(index);
}

// `/entries/0/elements/1/value/2` of a message, or what of it is there in a value.
std::string words_of(const Json::json_pointer& pointer, const Json& message) {
  const std::vector<std::string> tokens = tokens_of(pointer);
  std::string words;
  const Json* at = &message;
  const auto enter = [&](const std::string& token) {
    const auto place = Json::json_pointer().operator/=(token);
    at = at != nullptr && at->contains(place) ? &at->at(place) : nullptr;
  };
  const auto add = [&](const std::string& word) { words += (words.empty() ? "" : ", ") + word; };
  for (std::size_t i = 0; i < tokens.size(); ++i) {
    const bool has_index = i + 1 < tokens.size() && is_number(tokens[i + 1]);
    const std::string& token = tokens[i];
    enter(token);
    if (has_index && token == "entries") {
      enter(tokens[++i]);
      add("entry " + counted(tokens[i]) + words_of_entry(at));
    } else if (has_index && token == "elements") {
      enter(tokens[++i]);
      add(words_of_element(at, tokens[i]));
    } else if (is_number(token)) {
      add("item " + counted(token));
    } else if (token == "-") {  // of a JSON pointer: behind the last one
      add("one item more");
    } else if (token != "value") {
      add(token);
    }
  }
  return words;
}

std::string describe_change(const Json& change, const Json& recorded, const Json& live,
                            const Sides& sides) {
  const Json::json_pointer path(change.at("path").get<std::string>());
  const std::string operation = change.at("op");
  const bool is_added = operation == "add";
  const std::string place = words_of(path, is_added ? live : recorded);
  const std::string before = is_added ? "nothing" : text_of(recorded.at(path));
  const std::string now = operation == "remove" ? "nothing" : text_of(change.at("value"));
  return place + (place.empty() ? "" : ": ") + before + ' ' + std::string(sides.one) + ", " + now +
         ' ' + std::string(sides.other);
}

// How many floats lie between them, in the order of all floats.
template <class Float, class Bits>
Bits steps_between(Float one, Float other) {
  const auto order = [](Float value) {
    const Bits bits = std::bit_cast<Bits>(value);
    constexpr Bits sign = Bits{1} << (8 * sizeof(Bits) - 1);
    return (bits & sign) != 0 ? sign - (bits & ~sign) : sign + bits;
  };
  const Bits a = order(one);
  const Bits b = order(other);
  return a < b ? b - a : a - b;
}

bool is_single(const Json& element) {
  if (!element.contains("type") || !element.at("type").is_number()) return false;
  const auto type = static_cast<ElementType>(element.at("type").get<int>());
  return type == ElementType::single || type == ElementType::csingle;
}

bool is_near(const Json& one, const Json& other, bool single) {
  if (single) {
    return steps_between<float, std::uint32_t>(one.get<float>(), other.get<float>()) <= 1;
  }
  return steps_between<double, std::uint64_t>(one.get<double>(), other.get<double>()) <= 1;
}

bool is_nearly(const Json& written, const Json& exact, bool single) {
  if (written == exact) return true;
  const bool has_float = written.is_number_float() || exact.is_number_float();
  if (written.is_number() && exact.is_number()) return has_float && is_near(written, exact, single);
  if (written.type() != exact.type() || written.size() != exact.size()) return false;
  if (written.is_array()) {
    return std::equal(
        written.begin(), written.end(), exact.begin(),
        [&](const Json& one, const Json& other) { return is_nearly(one, other, single); });
  }
  if (!written.is_object()) return false;
  const bool is_now_single = exact.contains("type") ? is_single(exact) : single;
  return std::ranges::all_of(written.items(), [&](const auto& item) {
    const auto other = exact.find(item.key());
    return other != exact.end() && is_nearly(item.value(), *other, is_now_single);
  });
}

}  // namespace

std::string describe_difference(const Json& recorded, const Json& live, const Sides& sides) {
  const Json patch = Json::diff(recorded, live);
  std::string text;
  for (std::size_t i = 0; i < patch.size() && i < most_places; ++i) {
    text += (text.empty() ? "" : "; ") + describe_change(patch[i], recorded, live, sides);
  }
  if (patch.size() > most_places) {
    text += "; and " + std::to_string(patch.size() - most_places) + " more";
  }
  return text;
}

std::string describe_bytes(std::span<const std::byte> recorded, std::span<const std::byte> live) {
  const auto at =
      static_cast<std::size_t>(std::ranges::mismatch(recorded, live).in1 - recorded.begin());
  const auto some = [at](std::span<const std::byte> bytes) -> std::string {
    if (at >= bytes.size()) return "the end";
    const bool is_whole = bytes.size() - at <= most_bytes;
    return hex_of_bytes(bytes.subspan(at, std::min(most_bytes, bytes.size() - at))) +
           (is_whole ? "" : "...");
  };
  return "byte " + std::to_string(at) + " of " + std::to_string(recorded.size()) + ": " +
         some(recorded) + " recorded, " + some(live) + " came";
}

std::optional<std::string> contradiction(const Frame& frame) {
  MessageTree tree;
  if (!read_tree(frame.bytes, tree)) return "the recording's `hex` is not a message";
  const std::string difference = describe_difference(frame.decoded, json_of_message(tree),
                                                     {"in its `decoded`", "in its `hex`"});
  if (difference.empty()) return std::nullopt;
  return "the recording contradicts itself: " + difference;
}

bool is_nearly(const Json& written, const Json& exact) { return is_nearly(written, exact, false); }

}  // namespace rr::conformance
