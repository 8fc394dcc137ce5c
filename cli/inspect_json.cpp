// SPDX-License-Identifier: Apache-2.0
#include "cli/inspect_json.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <rr/message_tree.hpp>

#include "cli/inspect_text.hpp"
#include "compiler/output/json.hpp"
#include "runtime/cpp/src/replay/words.hpp"

namespace robdef {
namespace {

using rr::ElementType;

// Those that a double holds.
bool is_json_number(ElementType type) {
  return type != ElementType::int64 && type != ElementType::uint64 &&
         type != ElementType::cdouble && type != ElementType::csingle;
}

void put_number(JsonWriter& json, const rr::ElementTree& element, std::size_t index) {
  const std::string text = rr::replay::number_at(element, index);
  const bool is_plain =
      is_json_number(element.type) && text.find_first_not_of("0123456789+-.e") == std::string::npos;
  if (element.type == ElementType::bool_ && (text == "true" || text == "false")) {
    json.value(text == "true");
  } else if (!is_plain) {
    json.value(text);
  } else if (element.type == ElementType::double_ || element.type == ElementType::single) {
    json.value(std::strtod(text.c_str(), nullptr));
  } else {
    json.value(std::strtoll(text.c_str(), nullptr, 10));
  }
}

void put(JsonWriter& json, const rr::ElementTree& element) {
  json.begin_object().member("name", rr::replay::label_of(element));
  json.member("type", rr::replay::name_of(element.type));
  if (!element.type_name.empty()) json.member("type_name", element.type_name);
  if (!element.metadata.empty()) json.member("metadata", element.metadata);
  if (element.type == ElementType::string) {
    json.member("value", rr::replay::string_of(element));
  } else if (rr::is_nested(element.type)) {
    json.key("elements").begin_array();
    for (const rr::ElementTree& inner : element.elements) put(json, inner);
    json.end_array();
  } else if (element.type != ElementType::void_) {
    json.key("value").begin_array();
    const std::size_t count = rr::replay::items_of(element);
    for (std::size_t i = 0; i < count; ++i) put_number(json, element, i);
    json.end_array();
  }
  json.end_object();
}

void put(JsonWriter& json, const rr::EntryTree& entry) {
  json.begin_object().member("entry_type", static_cast<unsigned>(entry.type));
  json.member("name", rr::replay::name_of(entry.type));
  json.member("service_path", entry.service_path).member("member", entry.member);
  json.member("request_id", entry.request_id);
  json.member("error", static_cast<unsigned>(entry.error));
  if (!entry.metadata.empty()) json.member("metadata", entry.metadata);
  json.key("elements").begin_array();
  for (const rr::ElementTree& element : entry.elements) put(json, element);
  json.end_array().end_object();
}

void put(JsonWriter& json, const rr::MessageTree& tree) {
  json.member("version", static_cast<unsigned>(tree.version));
  json.member("sender_node", tree.sender_node.text());
  json.member("receiver_node", tree.receiver_node.text());
  json.member("sender_endpoint", tree.sender_endpoint);
  json.member("receiver_endpoint", tree.receiver_endpoint);
  json.member("message_id", static_cast<unsigned>(tree.message_id));
  json.member("message_res_id", static_cast<unsigned>(tree.message_res_id));
  json.key("entries").begin_array();
  for (const rr::EntryTree& entry : tree.entries) put(json, entry);
  json.end_array();
}

void put(JsonWriter& json, const rr::RecordedMessage& message) {
  json.member("kind", "message").member("number", message.number);
  json.member("direction",
              message.direction == rr::Direction::to_service ? "to_service" : "to_client");
  json.member("bytes", message.bytes.size());
  rr::MessageTree tree;
  if (rr::read_tree(message.bytes, tree)) {
    put(json, tree);
    return;
  }
  std::string digits;
  for (const std::byte each : message.bytes) {
    digits += fmt::format("{:02x}", std::to_integer<unsigned>(each));
  }
  json.member("malformed", digits);
}

void put(JsonWriter& json, const rr::ConnectionOpened& opened) {
  json.member("kind", "opened").member("side", word_of(opened.side));
  json.member("client_url", opened.client_url).member("service_url", opened.service_url);
}

void put(JsonWriter& json, const rr::ConnectionAgreed& agreed) {
  json.member("kind", "agreed");
  json.member("client_node", agreed.client_node.text()).member("client_name", agreed.client_name);
  json.member("service_node", agreed.service_node.text());
  json.member("service_name", agreed.service_name);
  json.member("version", static_cast<unsigned>(agreed.version));
  json.member("combined_connect", agreed.combined_connect);
  json.member("standard_strings", agreed.standard_strings);
  json.member("local_strings", agreed.local_strings);
}

void put(JsonWriter& json, const rr::ConnectionClosed& closed) {
  json.member("kind", "closed").member("code", static_cast<unsigned>(closed.code));
  json.member("reason", closed.reason);
}

void put(JsonWriter& json, const rr::MessageReplaced& replaced) {
  json.member("kind", "replaced").member("number", replaced.number);
}

void put(JsonWriter& json, const rr::DefinitionText& definition) {
  json.member("kind", "definition").member("name", service_of_definition(definition.text));
  json.member("text", definition.text);
}

void put(JsonWriter& json, const rr::MessagesLost& lost) {
  json.member("kind", "lost").member("count", lost.count).member("bytes", lost.bytes);
}

}  // namespace

std::string json_of(const rr::Record& record) {
  JsonWriter json(JsonWriter::Layout::one_line);
  json.begin_object().member("time_ns", record.time.count());
  if (record.connection != 0) json.member("connection", record.connection);
  std::visit([&](const auto& each) { put(json, each); }, record.what);
  json.end_object();
  return std::move(json).text();
}

}  // namespace robdef
