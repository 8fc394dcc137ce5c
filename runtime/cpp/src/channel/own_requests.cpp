// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/channel/own_requests.hpp"

#include <array>
#include <span>

#include "rr/error.hpp"
#include "runtime/cpp/src/channel/handshake.hpp"
#include "runtime/cpp/src/channel/operations.hpp"

namespace rr::channel {

void write_codes(Writer& writer, std::string_view name, std::span<const std::uint32_t> codes) {
  const std::size_t end = writer.position();
  writer.prepend_bytes(codes.data(), codes.size_bytes());
  writer.element(name, ElementType::uint32, {}, static_cast<std::uint32_t>(codes.size()), end);
}

void write_slots_level(Writer& writer) { write_codes(writer, slots_element, {&slots_level, 1}); }

bool has_slots_level(Decoder& decoder, const Entry& entry) {
  Element element;
  if (!find_element(decoder, entry.elements, entry.element_count, slots_element, element)) {
    return false;
  }
  const auto level = read_codes(element);
  return level && level->size() == 1 && level->front() == slots_level;
}

std::uint32_t write_error(Writer& writer, std::string_view name, std::string_view message) {
  writer.string_element("errorstring", message);
  writer.string_element("errorname", name);
  return 2;
}

void write_create_connection(Writer& writer, const MessageHeader& header,
                             std::span<const std::uint32_t> codes) {
  writer.reset(MessageVersion::v2);
  const std::size_t end = writer.position();
  write_codes(writer, "capabilities", codes);
  writer.entry({.type = EntryType::stream_op, .member = create_connection}, 1, end);
  writer.message(header, 1);
}

namespace {

EntryHeader answer_header(const Entry& entry, ErrorCode error = ErrorCode::none) {
  return {.type = static_cast<EntryType>(static_cast<std::uint16_t>(entry.type) + 1),
          .service_path = entry.service_path,
          .member = entry.member,
          .request_id = entry.request_id,
          .error = static_cast<std::uint16_t>(error)};
}

std::uint32_t write_error(Writer& writer, ErrorCode code, std::string_view message) {
  return channel::write_error(writer, error_name(code), message);
}

}  // namespace

bool is_own(EntryType type) {
  switch (type) {
    case EntryType::stream_op:
    case EntryType::stream_check_capability:
    case EntryType::connection_test:
    case EntryType::stream_op_ret:
    case EntryType::stream_check_capability_ret:
    case EntryType::connection_test_ret:
      return true;
    default:
      return false;
  }
}

OwnAnswer OwnRequests::answer(const Message& message, const Entry& entry) {
  switch (entry.type) {
    case EntryType::stream_op:
      return answer_stream_op(message, entry);
    case EntryType::stream_check_capability:
      return answer_capability(message, entry);
    case EntryType::connection_test:
      return answer_test(message, entry);
    default:
      return {};
  }
}

bool OwnRequests::is_for_this_node(const Message& message) const {
  const NodeOptions& options = side_.options;
  return (message.receiver_node.is_any() || message.receiver_node == options.id) &&
         (message.receiver_name.empty() || message.receiver_name == options.name);
}

MessageHeader OwnRequests::header_to(const Message& message) const {
  return {.sender_node = side_.options.id,
          .receiver_node = message.sender_node,
          .sender_name = side_.options.name,
          .receiver_name = message.sender_name};
}

OwnAnswer OwnRequests::answer_stream_op(const Message& message, const Entry& entry) {
  const bool is_start_tls = entry.member == start_tls && side_.is_server;
  if (entry.member == create_connection && side_.is_server) {
    return answer_create_connection(message, entry);
  }
  if (is_start_tls && side_.layers.can_start_tls()) return answer_start_tls(message, entry);
  if (entry.member == share_memory && side_.may_share) return answer_share_memory(message, entry);
  if (is_start_tls) {
    write_refusal(message, entry, ErrorCode::connection_error, "Server certificate not loaded");
  } else if (entry.member != get_remote_node_id) {
    write_refusal(message, entry, ErrorCode::protocol_error, "Invalid Stream Operation");
  } else {
    writer_.reset(side_.version);
    writer_.entry(answer_header(entry), 0, writer_.position());
    writer_.message(header_to(message), 1);
  }
  return {.is_answer = true};
}

OwnAnswer OwnRequests::answer_share_memory(const Message& message, const Entry& entry) {
  Decoder decoder(message.version, &message.strings);
  const bool has_slots = wants_slots(side_.options) && has_slots_level(decoder, entry);
  writer_.reset(side_.version);
  const std::size_t end = writer_.position();
  if (has_slots) write_slots_level(writer_);
  writer_.entry(answer_header(entry), has_slots ? 1 : 0, end);
  writer_.message(header_to(message), 1);
  return {.is_answer = true, .shares_memory = true, .has_slots = has_slots};
}

void OwnRequests::write_refusal(const Message& message, const Entry& entry, ErrorCode code,
                                std::string_view why) {
  writer_.reset(side_.version);
  const std::size_t end = writer_.position();
  const std::uint32_t count = write_error(writer_, code, why);
  writer_.entry(answer_header(entry, code), count, end);
  writer_.message(header_to(message), 1);
}

void OwnRequests::refuse(const Message& message, const Entry& entry, std::string_view why) {
  write_refusal(message, entry, ErrorCode::out_of_system_resource, why);
}

OwnAnswer OwnRequests::answer_create_connection(const Message& message, const Entry& entry) {
  const bool is_first = side_.remote_node.is_any();
  const bool is_same = is_first || side_.remote_node == side_.layers.sender_of(message);
  ErrorCode error =
      is_same && is_for_this_node(message) ? ErrorCode::none : ErrorCode::node_not_found;

  Decoder decoder(message.version, &message.strings);
  Element element;
  std::optional<ServerAnswer> answer;
  if (find_element(decoder, entry.elements, entry.element_count, "capabilities", element)) {
    if (const auto codes = read_codes(element)) {
      answer = answer_codes(*codes, side_.options.server_offer);
    }
    if (!answer) error = ErrorCode::protocol_error;
  }
  const bool lacks_tls = side_.link.is_tls_required && !side_.layers.is_encrypted();
  if (lacks_tls) error = ErrorCode::connection_error;

  OwnAnswer result{.is_answer = true};
  MessageVersion version = side_.version;
  if (error == ErrorCode::none && is_first) {
    result.agreement = answer ? answer->agreement : Agreement{};
    version = result.agreement->version;
  }
  // In format 2 as the request; everything behind it in what was agreed.
  writer_.reset(message.version == MessageVersion::v2 ? MessageVersion::v2 : version);
  const std::size_t end = writer_.position();
  std::uint32_t count = 0;
  if (error == ErrorCode::node_not_found) count += write_error(writer_, error, "Node not found");
  if (lacks_tls) {
    count += write_error(writer_, error, "this node serves encrypted connections only");
  }
  if (error == ErrorCode::protocol_error) {
    count += write_error(writer_, error, "Invalid capabilities");
  }
  if (answer) {
    write_codes(writer_, "capabilities", answer->codes);
    ++count;
  }
  writer_.entry(answer_header(entry, error), count, end);
  writer_.message(header_to(message), 1);
  return result;
}

// 04, section 6, step 2: answers in clear what is followed by TLS.
OwnAnswer OwnRequests::answer_start_tls(const Message& message, const Entry& entry) {
  Decoder decoder(message.version, &message.strings);
  Element element;
  OwnAnswer result{.is_answer = true, .begins_tls = is_for_this_node(message)};
  result.is_mutual =
      find_element(decoder, entry.elements, entry.element_count, "mutualauth", element) &&
      element.text() == "true";
  writer_.reset(side_.version);
  const std::size_t end = writer_.position();
  std::uint32_t count = 0;
  ErrorCode error = ErrorCode::none;
  if (!result.begins_tls) {
    error = ErrorCode::node_not_found;
    count = write_error(writer_, error, "Node not found");
  } else if (result.is_mutual) {
    writer_.string_element("mutualauth", "true");
    count = 1;
  }
  writer_.entry({.type = EntryType::stream_op_ret,
                 .service_path = entry.service_path,
                 .member = entry.member,
                 .request_id = entry.request_id,
                 .error = static_cast<std::uint16_t>(error)},
                count, end);
  writer_.message(header_to(message), 1);
  return result;
}

OwnAnswer OwnRequests::answer_capability(const Message& message, const Entry& entry) {
  writer_.reset(side_.version);
  const std::size_t end = writer_.position();
  const bool may_share = entry.member == shared_memory_capability && side_.may_share;
  const std::array<std::uint32_t, 1> level = {may_share ? shared_memory_level
                                                        : stream_capability(entry.member)};
  write_codes(writer_, "return", level);
  writer_.entry(answer_header(entry), 1, end);
  writer_.message({.sender_node = side_.options.id, .receiver_node = message.sender_node}, 1);
  return {.is_answer = true};
}

OwnAnswer OwnRequests::answer_test(const Message& message, const Entry& entry) {
  writer_.reset(side_.version);
  writer_.entry(answer_header(entry), 0, writer_.position());
  MessageHeader header = header_to(message);
  header.receiver_endpoint = message.sender_endpoint;
  header.routing = false;
  writer_.message(header, 1);
  return {.is_answer = true};
}

void OwnRequests::write_test() {
  writer_.reset(side_.version);
  writer_.entry({.type = EntryType::connection_test}, 0, writer_.position());
  writer_.message({.sender_node = side_.options.id}, 1);
}

}  // namespace rr::channel
