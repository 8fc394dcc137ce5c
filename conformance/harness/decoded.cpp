// SPDX-License-Identifier: Apache-2.0
#include "conformance/harness/decoded.hpp"

#include <stdexcept>
#include <string>

#include "conformance/harness/hex.hpp"
#include "conformance/harness/numbers.hpp"

namespace rr::conformance {
namespace {

using rr::ElementTree;
using rr::ElementType;
using rr::EntryTree;
using rr::MessageTree;
using rr::MessageVersion;

// Flags of format 4 (02, sections 2, 3 and 4).
namespace header_flag {
constexpr unsigned routing = 0x01, endpoints = 0x02, priority = 0x04, meta = 0x10,
                   string_table = 0x20, extended = 0x80;
}
namespace entry_flag {
constexpr unsigned path_code = 0x02, member_code = 0x08, meta = 0x40, extended = 0x80;
}
namespace element_flag {
constexpr unsigned name_text = 0x01, name_code = 0x02, number = 0x04, type_name_text = 0x08,
                   type_name_code = 0x10, meta = 0x20, extended = 0x80;
}

// The names of the captures for header fields; used in both directions.
constexpr const char* sender_id = "sender_node_id";
constexpr const char* receiver_id = "receiver_node_id";
constexpr const char* sender_name = "sender_node_name";
constexpr const char* receiver_name = "receiver_node_name";
constexpr const char* sender_endpoint = "sender_endpoint";
constexpr const char* receiver_endpoint = "receiver_endpoint";

void put_text(Json& json, const char* key, const std::string& text, bool present) {
  if (present) json[key] = text;
}

// A code that is in no table stands for no text.
std::string text_or_code(const std::string& text, bool has_code, std::uint32_t code) {
  return has_code && code != 0 && text.empty() ? "?" + std::to_string(code) : text;
}

Json header_of_v2(const MessageTree& message) {
  Json header = {{"version", 2},
                 {sender_id, message.sender_node.text()},
                 {receiver_id, message.receiver_node.text()},
                 {sender_endpoint, message.sender_endpoint},
                 {receiver_endpoint, message.receiver_endpoint},
                 {"message_id", message.message_id}};
  put_text(header, sender_name, message.sender_name, !message.sender_name.empty());
  put_text(header, receiver_name, message.receiver_name, !message.receiver_name.empty());
  put_text(header, "metadata", message.metadata, !message.metadata.empty());
  if (message.message_res_id != 0) header["message_res_id"] = message.message_res_id;
  return header;
}

Json header_of_v4(const MessageTree& message) {
  const unsigned flags = message.flags;
  Json header = {{"version", 4}, {"flags", flags}};
  if (flags & header_flag::routing) {
    header[sender_id] = message.sender_node.text();
    header[receiver_id] = message.receiver_node.text();
    header[sender_name] = message.sender_name;
    header[receiver_name] = message.receiver_name;
  }
  if (flags & header_flag::endpoints) {
    header[sender_endpoint] = message.sender_endpoint;
    header[receiver_endpoint] = message.receiver_endpoint;
  }
  if (flags & header_flag::priority) header["priority"] = message.priority;
  if (flags & header_flag::meta) {
    header["metadata"] = message.metadata;
    header["message_id"] = message.message_id;
    header["message_res_id"] = message.message_res_id;
  }
  if (flags & header_flag::string_table) {
    Json& table = header["string_table"] = Json::array();
    for (const auto& [code, text] : message.strings) table.push_back({code, text});
  }
  if (flags & header_flag::extended) header["extended"] = hex_of_bytes(message.extended);
  return header;
}

Json json_of_entry(const EntryTree& entry, MessageVersion version) {
  Json json = {{"entry_type", static_cast<unsigned>(entry.type)},
               {"service_path", entry.service_path},
               {"member", entry.member},
               {"request_id", entry.request_id},
               {"error", entry.error}};
  if (version == MessageVersion::v2) {
    put_text(json, "metadata", entry.metadata, !entry.metadata.empty());
  } else {
    json["flags"] = entry.flags;
    const bool path_code = (entry.flags & entry_flag::path_code) != 0;
    const bool member_code = (entry.flags & entry_flag::member_code) != 0;
    json["service_path"] = text_or_code(entry.service_path, path_code, entry.service_path_code);
    json["member"] = text_or_code(entry.member, member_code, entry.member_code);
    if (path_code) json["service_path_code"] = entry.service_path_code;
    if (member_code) json["member_code"] = entry.member_code;
    put_text(json, "metadata", entry.metadata, (entry.flags & entry_flag::meta) != 0);
    if (entry.flags & entry_flag::extended) json["extended"] = hex_of_bytes(entry.extended);
  }
  Json& elements = json["elements"] = Json::array();
  for (const ElementTree& element : entry.elements) {
    elements.push_back(json_of_element(element, version));
  }
  return json;
}

void put_value(Json& json, const ElementTree& element, MessageVersion version) {
  if (rr::is_nested(element.type)) {
    Json& elements = json["elements"] = Json::array();
    for (const ElementTree& nested : element.elements) {
      elements.push_back(json_of_element(nested, version));
    }
    return;
  }
  Json value;
  if (element.type == ElementType::string) {
    if (std::string text = text_of_bytes(element.payload); is_utf8(text)) value = std::move(text);
  } else if (element.type != ElementType::void_) {
    value = json_of_numbers(element.type, element.payload);
  }
  if (value.is_null() && element.type != ElementType::void_) {
    json["value_hex"] = hex_of_bytes(element.payload);
  } else {
    json["value"] = std::move(value);
  }
}

std::string text_of(const Json& json, const char* key) { return json.value(key, std::string()); }

rr::NodeId node_id_of(const Json& header, const char* key) {
  const auto found = header.find(key);
  if (found == header.end()) return {};
  const auto id = rr::NodeId::parse(found->get<std::string>());
  if (!id) throw std::runtime_error("no node id: " + found->dump());
  return *id;
}

template <class Number>
Number number_of(const Json& json, const char* key) {
  const auto found = json.find(key);
  return found == json.end() ? Number{} : integer_of_json<Number>(*found);
}

Bytes extended_of(const Json& json) { return bytes_of_hex(text_of(json, "extended")); }

EntryTree entry_of_json(const Json& json, MessageVersion version) {
  EntryTree entry;
  entry.flags = number_of<std::uint8_t>(json, "flags");
  entry.type = static_cast<rr::EntryType>(number_of<std::uint16_t>(json, "entry_type"));
  entry.service_path = text_of(json, "service_path");
  entry.service_path_code = number_of<std::uint32_t>(json, "service_path_code");
  entry.member = text_of(json, "member");
  entry.member_code = number_of<std::uint32_t>(json, "member_code");
  entry.request_id = number_of<std::uint32_t>(json, "request_id");
  entry.error = number_of<std::uint16_t>(json, "error");
  entry.metadata = text_of(json, "metadata");
  entry.extended = extended_of(json);
  for (const Json& element : json.at("elements")) {
    entry.elements.push_back(element_of_json(element, version));
  }
  return entry;
}

}  // namespace

Json json_of_message(const MessageTree& message) {
  const bool old = message.version == MessageVersion::v2;
  Json json = {{"header", old ? header_of_v2(message) : header_of_v4(message)}};
  Json& entries = json["entries"] = Json::array();
  for (const EntryTree& entry : message.entries) {
    entries.push_back(json_of_entry(entry, message.version));
  }
  return json;
}

MessageTree message_of_json(const Json& decoded) {
  const Json& header = decoded.at("header");
  MessageTree message;
  message.version = static_cast<MessageVersion>(number_of<std::uint8_t>(header, "version"));
  message.flags = number_of<std::uint8_t>(header, "flags");
  message.sender_node = node_id_of(header, sender_id);
  message.receiver_node = node_id_of(header, receiver_id);
  message.sender_name = text_of(header, sender_name);
  message.receiver_name = text_of(header, receiver_name);
  message.sender_endpoint = number_of<std::uint32_t>(header, sender_endpoint);
  message.receiver_endpoint = number_of<std::uint32_t>(header, receiver_endpoint);
  message.priority = number_of<std::uint16_t>(header, "priority");
  message.metadata = text_of(header, "metadata");
  message.message_id = number_of<std::uint16_t>(header, "message_id");
  message.message_res_id = number_of<std::uint16_t>(header, "message_res_id");
  message.extended = extended_of(header);
  if (const auto table = header.find("string_table"); table != header.end()) {
    for (const Json& entry : *table) {
      message.strings.emplace_back(entry.at(0).get<std::uint32_t>(), entry.at(1));
    }
  }
  for (const Json& entry : decoded.at("entries")) {
    message.entries.push_back(entry_of_json(entry, message.version));
  }
  return message;
}

Json json_of_element(const ElementTree& element, MessageVersion version) {
  Json json = {{"type", static_cast<unsigned>(element.type)}, {"count", element.count}};
  if (version == MessageVersion::v2) {
    json["name"] = element.name;
    put_text(json, "type_name", element.type_name, !element.type_name.empty());
    put_text(json, "metadata", element.metadata, !element.metadata.empty());
  } else {
    const unsigned flags = element.flags;
    using namespace element_flag;
    json["flags"] = flags;
    put_text(json, "name", element.name, (flags & (name_text | name_code)) != 0);
    if (flags & name_code) json["name_code"] = element.name_code;
    if (flags & number) json["number"] = element.number;
    put_text(json, "type_name", element.type_name,
             (flags & (type_name_text | type_name_code)) != 0);
    if (flags & type_name_code) json["type_name_code"] = element.type_name_code;
    put_text(json, "metadata", element.metadata, (flags & meta) != 0);
    if (flags & extended) json["extended"] = hex_of_bytes(element.extended);
  }
  put_value(json, element, version);
  return json;
}

ElementTree element_of_json(const Json& decoded, MessageVersion version) {
  ElementTree element;
  element.flags = number_of<std::uint8_t>(decoded, "flags");
  element.name = text_of(decoded, "name");
  element.name_code = number_of<std::uint32_t>(decoded, "name_code");
  element.number = number_of<std::int32_t>(decoded, "number");
  element.type = static_cast<ElementType>(number_of<std::uint16_t>(decoded, "type"));
  element.type_name = text_of(decoded, "type_name");
  element.type_name_code = number_of<std::uint32_t>(decoded, "type_name_code");
  element.metadata = text_of(decoded, "metadata");
  element.extended = extended_of(decoded);
  element.count = number_of<std::uint32_t>(decoded, "count");
  if (const auto nested = decoded.find("elements"); nested != decoded.end()) {
    for (const Json& item : *nested) element.elements.push_back(element_of_json(item, version));
  } else if (const auto bytes = decoded.find("value_hex"); bytes != decoded.end()) {
    element.payload = bytes_of_hex(bytes->get<std::string>());
  } else if (element.type == ElementType::string) {
    element.payload = bytes_of_text(decoded.at("value").get<std::string>());
  } else if (element.type != ElementType::void_) {
    element.payload = numbers_of_json(element.type, decoded.at("value"));
  }
  return element;
}

}  // namespace rr::conformance
