// SPDX-License-Identifier: Apache-2.0
#include "conformance/harness/comparison.hpp"

#include <algorithm>
#include <regex>

#include "conformance/harness/decoded.hpp"

namespace rr::conformance {
namespace {

constexpr unsigned meta_flag = 0x10;

// Replaces the endpoint numbers of a header by what `names` says; others stay.
void rename_endpoints(Json& header, const std::map<std::uint32_t, std::uint32_t>& names) {
  for (const char* key : {"sender_endpoint", "receiver_endpoint"}) {
    const auto endpoint = header.find(key);
    if (endpoint == header.end()) continue;
    const auto name = names.find(endpoint->get<std::uint32_t>());
    if (name != names.end()) *endpoint = name->second;
  }
}

std::uint32_t endpoint_of(const Json& header, const char* key) {
  return header.value(key, std::uint32_t{0});
}

// The side that sends names its endpoint in the header: the first time it is seen, it is noted.
void learn_endpoint(const Json& recorded, const Json& live, PlayedConnection& connection) {
  const std::uint32_t before = endpoint_of(recorded, "sender_endpoint");
  const std::uint32_t now = endpoint_of(live, "sender_endpoint");
  if (before != 0 && now != 0) connection.live_endpoints.try_emplace(before, now);
}

int message_id(const Json& header) { return header.value("message_id", 0); }

// In version 4 a message id of 0 without metadata is not on the wire.
void set_message_id(Json& header, int id) {
  const bool flagged = header.at("version") == 4;
  if (flagged && id == 0 && header.value("metadata", "").empty()) {
    for (const char* key : {"metadata", "message_id", "message_res_id"}) header.erase(key);
    header["flags"] = header["flags"].get<unsigned>() & ~meta_flag;
    return;
  }
  if (flagged && !header.contains("message_id")) {
    header["metadata"] = "";
    header["message_res_id"] = 0;
    header["flags"] = header["flags"].get<unsigned>() | meta_flag;
  }
  header["message_id"] = id;
}

bool counts_messages(const Json& header) {
  return header.at("version") == 2 || header.contains("message_id");
}

void align_message_id(const Json& recorded, Json& live, PlayedConnection& connection) {
  if (connection.take_next_message_id && counts_messages(live) && counts_messages(recorded) &&
      message_id(recorded) != 0) {
    connection.message_id_lead = message_id(recorded) - message_id(live);
    connection.take_next_message_id = false;
  }
  if (connection.left_out != 0 && counts_messages(live) && message_id(recorded) != 0) {
    const int more = message_id(recorded) - message_id(live) - connection.message_id_lead;
    if (more > 0 && more <= connection.left_out) connection.message_id_lead += more;
    connection.left_out = 0;
  }
  if (connection.message_id_lead == 0 || message_id(recorded) == 0) return;
  set_message_id(live, (message_id(live) + connection.message_id_lead) & 0xFFFF);
}

Json* find_named(Json& elements, const std::string& name) {
  const auto found = std::find_if(elements.begin(), elements.end(), [&](const Json& element) {
    return element.value("name", std::string()) == name;
  });
  return found == elements.end() ? nullptr : &*found;
}

void take_over_value(const Json& recorded, Json& live) {
  live.erase("value");
  live.erase("value_hex");
  for (const char* key : {"value", "value_hex"}) {
    if (recorded.contains(key)) live[key] = recorded[key];
  }
  live["count"] = recorded.at("count");
}

bool is_text(const Json& element) { return element.at("type") == 11; }

// The version text of a library.
void put_aside_client_version(const Json& recorded, Json& live) {
  for (const Json& element : recorded) {
    if (element.value("name", "") != "clientversion" || !is_text(element)) continue;
    Json* other = find_named(live, "clientversion");
    if (other != nullptr && is_text(*other)) take_over_value(element, *other);
  }
}

// The texts of a message's own string table come in any order.
void put_aside_table_order(const Json& recorded, Json& live) {
  if (!recorded.contains("string_table") || !live.contains("string_table")) return;
  const auto sorted = [](std::vector<Json> table) {
    std::sort(table.begin(), table.end());
    return table;
  };
  if (sorted(recorded["string_table"]) == sorted(live["string_table"])) {
    live["string_table"] = recorded["string_table"];
  }
}

// The ports in connection URLs.
void put_aside_ports(const Json& recorded, Json& live) {
  static const std::regex url(R"((rr\+tcp://[^/:]*:)(\d+)(/.*))");
  if (recorded.is_string() && live.is_string()) {
    std::smatch before;
    std::smatch now;
    const std::string recorded_text = recorded;
    const std::string live_text = live;
    if (std::regex_match(recorded_text, before, url) && std::regex_match(live_text, now, url)) {
      live = now[1].str() + before[2].str() + now[3].str();
    }
  } else if (recorded.is_array() && live.is_array()) {
    for (std::size_t i = 0; i < std::min(recorded.size(), live.size()); ++i) {
      put_aside_ports(recorded[i], live[i]);
    }
  } else if (recorded.is_object() && live.is_object()) {
    for (auto& [key, value] : live.items()) {
      if (recorded.contains(key)) put_aside_ports(recorded[key], value);
    }
    if (recorded.value("type", 0) == 11 && live.value("type", 0) == 11 &&
        recorded.value("value", Json()) == live.value("value", Json())) {
      live["count"] = recorded["count"];
    }
  }
}

bool has_text(const Json& json, const std::string& text) {
  if (json.is_string()) return json.get_ref<const std::string&>() == text;
  return json.is_structured() && std::any_of(json.begin(), json.end(), [&](const Json& item) {
           return has_text(item, text);
         });
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

// Elements of an error come in any order: those of `live` are put in the order of `recorded`.
void put_in_order(const Json& recorded, Json& live) {
  Json ordered = Json::array();
  for (const Json& element : recorded) {
    if (Json* found = find_named(live, element.value("name", ""))) ordered.push_back(*found);
  }
  if (ordered.size() == live.size()) live = std::move(ordered);
}

}  // namespace

bool is_host_specific(const std::string& error_name) {
  static const std::regex mangled(R"((St|S[a-z]|N|NSt)?\d.*|std::.*)");
  return std::regex_match(error_name, mangled);
}

Bytes addressed(const Frame& frame, const PlayedConnection& connection) {
  Json decoded = frame.decoded;
  rename_endpoints(decoded.at("header"), connection.live_endpoints);
  for (Json& entry : decoded.at("entries")) rename_generator(entry, connection.live_generators);
  if (decoded == frame.decoded) return frame.bytes;
  return rr::write_tree(message_of_json(decoded));
}

Comparison::Comparison(const Captures& captures) {
  collect_messages(captures.service, scripted_texts_, echoes_texts_);
}

bool Comparison::is_scripted(const std::string& text, const Json& request) const {
  return scripted_texts_.contains(text) || (echoes_texts_ && has_text(request, text));
}

void Comparison::put_aside_error_texts(const Json& recorded, Json& live,
                                       const Json& request) const {
  Json& elements = live.at("elements");
  put_in_order(recorded.at("elements"), elements);
  for (const Json& element : recorded.at("elements")) {
    const std::string name = element.value("name", "");
    Json* other = find_named(elements, name);
    if (other == nullptr || !is_text(element) || !is_text(*other)) continue;
    const std::string text = element.contains("value") ? element["value"].get<std::string>() : "";
    const bool free = (name == "errorname" && is_host_specific(text)) ||
                      (name == "errorstring" && !is_scripted(text, request));
    if (free) take_over_value(element, *other);
  }
}

std::optional<std::string> Comparison::difference(const Frame& recorded,
                                                  std::span<const std::byte> live,
                                                  PlayedConnection& connection,
                                                  const Frame* request) const {
  rr::MessageTree tree;
  if (!rr::read_tree(live, tree))
    return "not a message: " + hex_of_bytes(live.first(std::min<std::size_t>(live.size(), 40)));
  Json decoded = json_of_message(tree);
  Json& header = decoded.at("header");
  learn_endpoint(recorded.header(), header, connection);
  std::map<std::uint32_t, std::uint32_t> recorded_names;
  for (const auto& [before, now] : connection.live_endpoints) recorded_names[now] = before;
  rename_endpoints(header, recorded_names);
  align_message_id(recorded.header(), header, connection);
  put_aside_table_order(recorded.header(), header);
  const Json nothing = Json::array();
  Json& entries = decoded.at("entries");
  for (std::size_t i = 0; i < std::min(entries.size(), recorded.entries().size()); ++i) {
    const Json& before = recorded.entries()[i];
    Json& now = entries[i];
    if (before.at("error") != 0 && now.at("error") == before.at("error")) {
      put_aside_error_texts(before, now, request == nullptr ? nothing : request->entries());
    }
    put_aside_client_version(before.at("elements"), now.at("elements"));
    put_aside_ports(before.at("elements"), now.at("elements"));
    put_aside_packet_time(before, now);
    put_aside_generator_index(before, now, connection.live_generators);
  }
  if (rr::write_tree(message_of_json(decoded)) == recorded.bytes) return std::nullopt;
  return describe_difference(recorded.decoded, decoded);
}

std::string describe_difference(const Json& recorded, const Json& live) {
  const Json patch = Json::diff(recorded, live);
  std::string text;
  std::size_t shown = 0;
  for (const Json& change : patch) {
    if (shown++ == 3) {
      text += "; and " + std::to_string(patch.size() - 3) + " more";
      break;
    }
    const Json::json_pointer path(change.at("path").get<std::string>());
    if (!text.empty()) text += "; ";
    text += change.at("path").get<std::string>() + ": ";
    const std::string operation = change.at("op");
    const std::string before =
        operation == "add"
            ? "nothing"
            : recorded.at(path).dump(-1, ' ', false, Json::error_handler_t::replace).substr(0, 120);
    const std::string now = operation == "remove"
                                ? "nothing"
                                : change.at("value")
                                      .dump(-1, ' ', false, Json::error_handler_t::replace)
                                      .substr(0, 120);
    text += before + " recorded, " + now + " came";
  }
  return text.empty() ? "the same fields, but other bytes" : text;
}

}  // namespace rr::conformance
