// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/fuzz/conversation.hpp"

#include <cstring>
#include <string>
#include <utility>

#include "rr/reader.hpp"
#include "runtime/cpp/src/codec/flags.hpp"

namespace rr::fuzz {
namespace {

namespace element_flag = codec::element_flag;
namespace entry_flag = codec::entry_flag;
namespace message_flag = codec::message_flag;

std::size_t find_place(std::span<const std::byte> bytes) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  return text.find("\x07\x07\x07\x07");
}

void announce_fields(ElementTree& element) {
  element.flags = element.name.empty() ? element_flag::number : element_flag::name_text;
  if (!element.type_name.empty()) element.flags |= element_flag::type_name_text;
  if (!element.metadata.empty()) element.flags |= element_flag::metadata;
  for (ElementTree& nested : element.elements) announce_fields(nested);
}

void name_numbered(ElementTree& element) {
  if (element.name.empty()) element.name = std::to_string(element.number);
  for (ElementTree& nested : element.elements) name_numbered(nested);
}

void announce_fields(EntryTree& entry) {
  entry.flags = entry_flag::path_text | entry_flag::member_text | entry_flag::request_id;
  if (entry.error != 0) entry.flags |= entry_flag::error;
  if (!entry.metadata.empty()) entry.flags |= entry_flag::metadata;
  for (ElementTree& element : entry.elements) announce_fields(element);
}

void announce_fields(MessageTree& message) {
  message.flags = message_flag::routing | message_flag::endpoints | message_flag::meta;
  if (message.entries.size() != 1) message.flags |= message_flag::multiple_entries;
  for (EntryTree& entry : message.entries) announce_fields(entry);
}

MessageTree request(MessageVersion version, EntryType type, std::string_view path,
                    std::string_view member) {
  MessageTree message;
  message.version = version;
  message.sender_node = client_node();
  EntryTree entry;
  entry.type = type;
  entry.service_path = path;
  entry.member = member;
  entry.request_id = 1;
  message.entries.push_back(std::move(entry));
  announce_fields(message);
  return message;
}

}  // namespace

NodeId client_node() { return NodeId::parse("a1b2c3d4-1111-4222-8333-444455556666").value(); }
NodeId service_node() { return NodeId::parse("5f3a1c20-8d64-4b1e-9a77-0c2d4e6f8a01").value(); }

std::vector<std::span<const std::byte>> split_messages(std::span<const std::byte> input) {
  constexpr std::size_t header_size = 8;
  std::vector<std::span<const std::byte>> parts;
  while (input.size() > header_size && std::memcmp(input.data(), "RRAC", 4) == 0) {
    std::uint32_t size = 0;
    std::memcpy(&size, input.data() + 4, sizeof size);
    if (size < smallest_message || size > input.size()) break;
    parts.push_back(input.first(size));
    input = input.subspan(size);
  }
  if (!input.empty()) parts.push_back(input);
  return parts;
}

void name_service_endpoint(std::span<std::byte> input, std::uint32_t number) {
  for (std::size_t at = 0; (at = find_place(input)) != std::string_view::npos;) {
    std::memcpy(input.data() + at, &number, sizeof number);
    input = input.subspan(at + sizeof number);
  }
}

std::size_t find_service_endpoint(std::span<const std::byte> input) {
  std::size_t at = 0;
  for (const auto part : split_messages(input)) {
    if (find_place(part) != std::string_view::npos) return at;
    at += part.size();
  }
  return input.size();
}

ElementTree named_element(std::string_view name, ElementType type, Bytes payload) {
  ElementTree element;
  element.name = name;
  element.type = type;
  element.payload = std::move(payload);
  announce_fields(element);
  return element;
}

MessageTree create_connection(bool offer_v4, bool offer_strings) {
  std::vector<std::uint32_t> codes = {0x02000003};
  if (offer_v4) codes.push_back(0x04000003);
  if (offer_strings) codes.push_back(0x04100007);
  Bytes payload(codes.size() * sizeof codes.front());
  std::memcpy(payload.data(), codes.data(), payload.size());
  MessageTree message = request(MessageVersion::v2, EntryType::stream_op, "", "CreateConnection");
  message.sender_name = client_node_name;
  message.entries.front().request_id = 0;
  message.entries.front().elements.push_back(
      named_element("capabilities", ElementType::uint32, std::move(payload)));
  return message;
}

MessageTree special_request(MessageVersion version, EntryType type, std::string_view path) {
  MessageTree message = request(version, type, path, "");
  message.sender_name = client_node_name;
  message.sender_endpoint = client_endpoint;
  return message;
}

MessageTree session_request(MessageVersion version, EntryType type, std::string_view path,
                            std::string_view member) {
  MessageTree message = request(version, type, path, member);
  message.receiver_node = service_node();
  message.sender_endpoint = client_endpoint;
  message.receiver_endpoint = service_endpoint_place;
  // In format 4 the connection knows both ends.
  message.flags = message_flag::meta;
  return message;
}

void change_version(MessageTree& message, MessageVersion version) {
  message.version = version;
  if (version == MessageVersion::v4) {
    announce_fields(message);
    return;
  }
  for (EntryTree& entry : message.entries) {
    for (ElementTree& element : entry.elements) name_numbered(element);
  }
}

}  // namespace rr::fuzz
