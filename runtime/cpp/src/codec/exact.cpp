// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/codec/exact.hpp"

#include <limits>

#include "runtime/cpp/src/codec/back.hpp"
#include "runtime/cpp/src/codec/flags.hpp"

namespace rr::codec {
namespace {

// Room for all fields of a header that are not texts or bytes.
constexpr std::size_t fixed_fields = 128;
constexpr std::size_t longest = std::numeric_limits<std::uint32_t>::max();

bool fits(Writer& writer, std::size_t texts) {
  if (texts <= longest - fixed_fields && writer.position() <= longest - fixed_fields - texts) {
    return true;
  }
  return writer.fail(ErrorCode::protocol_error, "message too long");
}

}  // namespace

void write_element_header(Writer& writer, const Element& element, std::size_t end) {
  if (writer.version() == MessageVersion::v2) {
    writer.element(element.name, element.type, element.type_name, element.metadata, {},
                   element.count, end);
    return;
  }
  const std::size_t texts = element.name.size() + element.type_name.size() +
                            element.metadata.size() + element.extended.size();
  if (!fits(writer, texts)) return;
  const std::uint8_t flags = element.flags;
  const std::size_t payload = writer.position() - end;
  Back back{writer.reserve(fixed_fields + texts)};
  const std::byte* const behind = back.at;
  back.uint_x(element.count);
  if ((flags & element_flag::extended) != 0) back.xbytes(element.extended);
  if ((flags & element_flag::metadata) != 0) back.xstring(element.metadata);
  if ((flags & element_flag::type_name_code) != 0) back.uint_x(element.type_name_code);
  if ((flags & element_flag::type_name_text) != 0) back.xstring(element.type_name);
  back.number(static_cast<std::uint16_t>(element.type));
  if ((flags & element_flag::number) != 0) back.int_x(element.number);
  if ((flags & element_flag::name_code) != 0) back.uint_x(element.name_code);
  if ((flags & element_flag::name_text) != 0) back.xstring(element.name);
  back.u8(flags);
  back.own_size(static_cast<std::uint32_t>(payload + static_cast<std::size_t>(behind - back.at)));
  writer.commit(back.at);
}

void write_entry_header(Writer& writer, const Entry& entry, std::size_t end) {
  if (writer.version() == MessageVersion::v2) {
    writer.entry(entry, entry.element_count, end);
    return;
  }
  const std::size_t texts = entry.service_path.size() + entry.member.size() +
                            entry.metadata.size() + entry.extended.size();
  if (!fits(writer, texts)) return;
  const std::uint8_t flags = entry.flags;
  const std::size_t elements = writer.position() - end;
  Back back{writer.reserve(fixed_fields + texts)};
  const std::byte* const behind = back.at;
  back.uint_x(entry.element_count);
  if ((flags & entry_flag::extended) != 0) back.xbytes(entry.extended);
  if ((flags & entry_flag::metadata) != 0) back.xstring(entry.metadata);
  if ((flags & entry_flag::error) != 0) back.number(entry.error);
  if ((flags & entry_flag::request_id) != 0) back.uint_x(entry.request_id);
  if ((flags & entry_flag::member_code) != 0) back.uint_x(entry.member_code);
  if ((flags & entry_flag::member_text) != 0) back.xstring(entry.member);
  if ((flags & entry_flag::path_code) != 0) back.uint_x(entry.service_path_code);
  if ((flags & entry_flag::path_text) != 0) back.xstring(entry.service_path);
  back.number(static_cast<std::uint16_t>(entry.type));
  back.u8(flags);
  back.own_size(static_cast<std::uint32_t>(elements + static_cast<std::size_t>(behind - back.at)));
  writer.commit(back.at);
}

void write_message_header(Writer& writer, const Message& message,
                          std::span<const StringCode> strings) {
  if (writer.version() == MessageVersion::v2) {
    writer.message(message, message.entry_count);
    return;
  }
  std::size_t texts = message.sender_name.size() + message.receiver_name.size() +
                      message.metadata.size() + message.extended.size();
  for (const StringCode& string : strings) texts += string.text.size() + 2 * longest_uint_x;
  if (!fits(writer, texts)) return;
  const std::uint8_t flags = message.flags;
  Back back{writer.reserve(fixed_fields + texts)};
  const std::byte* const behind = back.at;
  if ((flags & message_flag::extended) != 0) back.xbytes(message.extended);
  if ((flags & message_flag::multiple_entries) != 0) back.uint_x(message.entry_count);
  if ((flags & message_flag::string_table) != 0) {
    for (auto string = strings.rbegin(); string != strings.rend(); ++string) {
      back.xstring(string->text);
      back.uint_x(string->code);
    }
    back.uint_x(static_cast<std::uint32_t>(strings.size()));
  }
  if ((flags & message_flag::meta) != 0) {
    back.number(message.message_res_id);
    back.number(message.message_id);
    back.xstring(message.metadata);
  }
  if ((flags & message_flag::priority) != 0) back.number(message.priority);
  if ((flags & message_flag::endpoints) != 0) {
    back.uint_x(message.receiver_endpoint);
    back.uint_x(message.sender_endpoint);
  }
  if ((flags & message_flag::routing) != 0) {
    back.xstring(message.receiver_name);
    back.xstring(message.sender_name);
    back.number(message.receiver_node.bytes);
    back.number(message.sender_node.bytes);
  }
  back.u8(flags);
  const auto written = [&] { return static_cast<std::size_t>(behind - back.at); };
  back.own_size(static_cast<std::uint32_t>(written() + 10));  // magic, message size and version too
  back.number(std::uint16_t{4});
  back.number(static_cast<std::uint32_t>(writer.position() + written() + 8));
  back.bytes("RRAC", 4);
  writer.commit(back.at);
}

}  // namespace rr::codec
