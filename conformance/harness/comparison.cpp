// SPDX-License-Identifier: Apache-2.0
#include "conformance/harness/comparison.hpp"

#include <algorithm>

#include "conformance/harness/decoded.hpp"
#include "conformance/harness/explanation.hpp"
#include "runtime/cpp/src/replay/words.hpp"

namespace rr::conformance {
namespace {

using replay::find_named;
using replay::string_of;

constexpr std::uint8_t meta_flag = 0x10;  // of a message of version 4 (02, section 2)

// In version 4 a message id of 0 without metadata is not on the wire.
void set_message_id(rr::MessageTree& message, int id) {
  message.message_id = static_cast<std::uint16_t>(id);
  if (message.version == rr::MessageVersion::v2) return;
  const bool is_left_out = id == 0 && message.metadata.empty();
  if (is_left_out) message.message_res_id = 0;
  message.flags = static_cast<std::uint8_t>(is_left_out ? message.flags & ~meta_flag
                                                        : message.flags | meta_flag);
}

bool counts_messages(const rr::MessageTree& message) {
  return message.version == rr::MessageVersion::v2 || (message.flags & meta_flag) != 0;
}

void align_message_id(const rr::MessageTree& recorded, rr::MessageTree& live,
                      PlayedConnection& connection) {
  // The first message of a connection that has been made anew counts from 0 again.
  if (connection.take_next_message_id && counts_messages(recorded) && recorded.message_id != 0) {
    connection.message_id_lead = recorded.message_id - live.message_id;
    connection.take_next_message_id = false;
  }
  if (connection.left_out != 0 && counts_messages(live) && recorded.message_id != 0) {
    const int more = recorded.message_id - live.message_id - connection.message_id_lead;
    if (more > 0 && more <= connection.left_out) connection.message_id_lead += more;
    connection.left_out = 0;
  }
  if (connection.message_id_lead == 0 || recorded.message_id == 0) return;
  set_message_id(live, (live.message_id + connection.message_id_lead) & 0xFFFF);
}

bool is_text(const rr::ElementTree& element) { return element.type == rr::ElementType::string; }

// The texts of a message's own string table come in any order.
void put_aside_table_order(const rr::MessageTree& recorded, rr::MessageTree& live) {
  const auto sorted = [](auto table) {
    std::sort(table.begin(), table.end());
    return table;
  };
  if (sorted(recorded.strings) == sorted(live.strings)) live.strings = recorded.strings;
}

std::string_view query_of(const rr::ElementTree& url) {
  const std::string_view text = string_of(url);
  return text.substr(std::min(text.find('?'), text.size()));
}

// The list of URLs of a service in the service index (05, section 6), wherever it is.
void put_aside_places(const std::vector<rr::ElementTree>& recorded,
                      std::vector<rr::ElementTree>& live) {
  for (std::size_t i = 0; i < std::min(recorded.size(), live.size()); ++i) {
    const rr::ElementTree& before = recorded[i];
    rr::ElementTree& now = live[i];
    if (before.name != "ConnectionURL" || before.name != now.name || before.elements.empty()) {
      put_aside_places(before.elements, now.elements);
      continue;
    }
    const auto names_the_same = [&](const rr::ElementTree& url) {
      return is_text(url) && query_of(url) == query_of(before.elements.front());
    };
    if (!now.elements.empty() && std::ranges::all_of(now.elements, names_the_same)) now = before;
  }
}

bool has_text(const Json& json, const std::string& text) {
  if (json.is_string()) return json.get_ref<const std::string&>() == text;
  return json.is_structured() && std::any_of(json.begin(), json.end(), [&](const Json& item) {
           return has_text(item, text);
         });
}

// The names of errors that an object, or a callback of a plan, throws by its script: also `$n`.
void collect_names(const Json& json, std::set<std::string>& names) {
  if (!json.is_structured()) return;
  for (const auto& [key, item] : json.items()) {
    const bool is_thrown = key == "end" || key.ends_with("throw");
    const Json name = is_thrown && item.is_object() ? item.value("name", Json()) : Json();
    if (name.is_string()) names.insert(name.get<std::string>());
    collect_names(item, names);
  }
}

void collect_strings(const Json& json, std::set<std::string>& strings) {
  if (json.is_string()) strings.insert(json.get<std::string>());
  if (!json.is_structured()) return;
  for (const auto& item : json) collect_strings(item, strings);
}

void collect_messages(const Json& json, std::set<std::string>& texts, bool& echoes) {
  if (!json.is_structured()) return;
  if (json.is_object()) {
    for (const char* key : {"message", "native"}) {
      if (!json.contains(key) || !json[key].is_string()) continue;
      const std::string text = json[key];
      if (text.starts_with('$')) {
        echoes = true;
      } else {
        texts.insert(text);
      }
    }
  }
  for (const Json& item : json) collect_messages(item, texts, echoes);
}

}  // namespace

Bytes addressed(const Frame& frame, const PlayedConnection& connection) {
  rr::MessageTree recorded;
  if (!rr::read_tree(frame.bytes, recorded)) return frame.bytes;
  rr::MessageTree message = recorded;
  replay::rename_endpoints(message, connection.live_endpoints);
  for (rr::EntryTree& entry : message.entries) {
    replay::rename_generator(entry, connection.live_generators);
  }
  return message == recorded ? frame.bytes : rr::write_tree(message);
}

Comparison::Comparison(const Captures& captures) {
  collect_messages(captures.service, scripted_texts_, echoes_texts_);
  collect_names(captures.service, scripted_names_);
  const bool echoes_names = std::any_of(scripted_names_.begin(), scripted_names_.end(),
                                        [](const auto& name) { return name.starts_with('$'); });
  for (const Scenario& scenario : captures.scenarios) {
    for (const Step& step : scenario.steps) {
      collect_names(step.plan, scripted_names_);
      // Then any argument of a call may be the name of an error.
      if (echoes_names) collect_strings(step.plan, scripted_names_);
    }
  }
}

bool Comparison::is_host_specific(const std::string& error_name) const {
  return !error_name.starts_with("RobotRaconteur.") && !scripted_names_.contains(error_name);
}

bool Comparison::is_scripted(const std::string& text, const Json& request) const {
  return scripted_texts_.contains(text) || (echoes_texts_ && has_text(request, text));
}

void Comparison::put_aside_error_texts(const rr::EntryTree& recorded, rr::EntryTree& live,
                                       const Json& request) const {
  replay::put_in_order(recorded, live);
  for (const rr::ElementTree& element : recorded.elements) {
    rr::ElementTree* const other = find_named(live.elements, element.name);
    if (other == nullptr || !is_text(element) || !is_text(*other)) continue;
    const std::string text(string_of(element));
    const bool free = (element.name == "errorname" && is_host_specific(text)) ||
                      (element.name == "errorstring" && !is_scripted(text, request));
    if (free) other->payload = element.payload;
  }
}

std::optional<std::string> Comparison::difference(const Frame& frame,
                                                  std::span<const std::byte> bytes,
                                                  PlayedConnection& connection,
                                                  const Frame* request) const {
  rr::MessageTree recorded;
  rr::MessageTree live;
  if (!rr::read_tree(bytes, live))
    return "not a message: " + hex_of_bytes(bytes.first(std::min<std::size_t>(bytes.size(), 40)));
  if (!rr::read_tree(frame.bytes, recorded)) return "the recorded frame is not a message";
  replay::learn_endpoint(recorded, live, connection.live_endpoints);
  replay::Endpoints recorded_names;
  for (const auto& [before, now] : connection.live_endpoints) recorded_names[now] = before;
  replay::rename_endpoints(live, recorded_names);
  align_message_id(recorded, live, connection);
  put_aside_table_order(recorded, live);
  const Json nothing = Json::array();
  for (std::size_t i = 0; i < std::min(live.entries.size(), recorded.entries.size()); ++i) {
    const rr::EntryTree& before = recorded.entries[i];
    rr::EntryTree& now = live.entries[i];
    if (before.error != 0 && now.error == before.error) {
      put_aside_error_texts(before, now, request == nullptr ? nothing : request->entries());
    }
    replay::put_aside_client_version(before, now);
    replay::put_aside_ports(before, now);
    if (has_other_urls_) put_aside_places(before.elements, now.elements);
    replay::put_aside_packet_time(before, now);
    replay::put_aside_generator_index(before, now, connection.live_generators);
  }
  if (rr::write_tree(live) == frame.bytes) return std::nullopt;
  if (auto wrong = contradiction(frame)) return wrong;
  const std::string fields = describe_difference(frame.decoded, json_of_message(live));
  // What was put aside is not among the fields, but may have another length.
  return fields.empty() ? describe_bytes(frame.bytes, rr::write_tree(live)) : fields;
}

}  // namespace rr::conformance
