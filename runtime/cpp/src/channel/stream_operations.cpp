// SPDX-License-Identifier: Apache-2.0
// What a connection answers by itself: stream operations and connection tests.
#include <array>
#include <cstring>
#include <optional>
#include <span>
#include <vector>

#include "rr/error.hpp"
#include "runtime/cpp/src/channel/operations.hpp"
#include "runtime/cpp/src/channel/stream_connection.hpp"
#include "runtime/cpp/src/channel/tls.hpp"

namespace rr::channel {

void write_codes(Writer& writer, std::string_view name, std::span<const std::uint32_t> codes) {
  const std::size_t end = writer.position();
  writer.prepend_bytes(codes.data(), codes.size_bytes());
  writer.element(name, ElementType::uint32, {}, static_cast<std::uint32_t>(codes.size()), end);
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

// True when the message was for the connection itself.
bool StreamConnection::take_own(const Message& message, const Entry& entry) {
  switch (entry.type) {
    case EntryType::stream_op:
      answer_stream_op(message, entry);
      return true;
    case EntryType::stream_check_capability:
      answer_capability(message, entry);
      return true;
    case EntryType::connection_test:
      answer_test(message, entry);
      return true;
    case EntryType::stream_op_ret:
    case EntryType::stream_check_capability_ret:
    case EntryType::connection_test_ret:
      return true;
    default:
      return false;
  }
}

void StreamConnection::answer_stream_op(const Message& message, const Entry& entry) {
  if (entry.member == create_connection && role_ == Role::server) {
    answer_create_connection(message, entry);
    return;
  }
  const bool has_tls = terms_.tls != nullptr && terms_.tls->has_certificate() && !is_encrypted();
  if (entry.member == start_tls && role_ == Role::server && has_tls) {
    answer_start_tls(message, entry);
    return;
  }
  Writer& writer = thread_writer();
  writer.reset(version());
  const std::size_t end = writer.position();
  ErrorCode error = ErrorCode::none;
  std::uint32_t count = 0;
  if (entry.member == start_tls && role_ == Role::server) {
    error = ErrorCode::connection_error;
    count = write_error(writer, error, "Server certificate not loaded");
  } else if (entry.member != get_remote_node_id) {
    error = ErrorCode::protocol_error;
    count = write_error(writer, error, "Invalid Stream Operation");
  }
  writer.entry(answer_header(entry, error), count, end);
  writer.message({.sender_node = options_->id,
                  .receiver_node = message.sender_node,
                  .sender_name = options_->name,
                  .receiver_name = message.sender_name},
                 1);
  send_own(writer);
}

void StreamConnection::answer_create_connection(const Message& message, const Entry& entry) {
  const bool is_first = remote_node_.is_any();
  const NodeId& sender = sender_of(message);
  const bool is_same = is_first || remote_node_ == sender;
  const bool is_target =
      (message.receiver_node.is_any() || message.receiver_node == options_->id) &&
      (message.receiver_name.empty() || message.receiver_name == options_->name);
  ErrorCode error = is_same && is_target ? ErrorCode::none : ErrorCode::node_not_found;

  Decoder decoder(message.version, &message.strings);
  Element element;
  std::optional<ServerAnswer> answer;
  const bool has_codes =
      find_element(decoder, entry.elements, entry.element_count, "capabilities", element);
  if (has_codes) {
    if (const auto codes = read_codes(element))
      answer = answer_codes(*codes, options_->server_offer);
    if (!answer) error = ErrorCode::protocol_error;
  }
  const bool lacks_tls = terms_.is_tls_required && !is_encrypted();
  if (lacks_tls) error = ErrorCode::connection_error;

  if (error == ErrorCode::none && is_first) {
    set_agreement(sender, std::string(message.sender_name),
                  answer ? answer->agreement : Agreement{});
  }
  Writer& writer = thread_writer();
  // In format 2 as the request; everything behind it in what was agreed.
  writer.reset(message.version == MessageVersion::v2 ? MessageVersion::v2 : version());
  const std::size_t end = writer.position();
  std::uint32_t count = 0;
  if (error == ErrorCode::node_not_found) count += write_error(writer, error, "Node not found");
  if (lacks_tls) {
    count += write_error(writer, error, "this node serves encrypted connections only");
  }
  if (error == ErrorCode::protocol_error) {
    count += write_error(writer, error, "Invalid capabilities");
  }
  if (answer) {
    write_codes(writer, "capabilities", answer->codes);
    ++count;
  }
  writer.entry(answer_header(entry, error), count, end);
  writer.message({.sender_node = options_->id,
                  .receiver_node = message.sender_node,
                  .sender_name = options_->name,
                  .receiver_name = message.sender_name},
                 1);
  send_own(writer);
}

void StreamConnection::answer_capability(const Message& message, const Entry& entry) {
  Writer& writer = thread_writer();
  writer.reset(version());
  const std::size_t end = writer.position();
  const std::array<std::uint32_t, 1> level = {stream_capability(entry.member)};
  write_codes(writer, "return", level);
  writer.entry(answer_header(entry), 1, end);
  writer.message({.sender_node = options_->id, .receiver_node = message.sender_node}, 1);
  send_own(writer);
}

void StreamConnection::answer_test(const Message& message, const Entry& entry) {
  Writer& writer = thread_writer();
  writer.reset(version());
  writer.entry(answer_header(entry), 0, writer.position());
  writer.message({.sender_node = options_->id,
                  .receiver_node = message.sender_node,
                  .sender_name = options_->name,
                  .receiver_name = message.sender_name,
                  .receiver_endpoint = message.sender_endpoint,
                  .routing = false},
                 1);
  send_own(writer);
}

void StreamConnection::send_test() {
  Writer& writer = thread_writer();
  writer.reset(version());
  writer.entry({.type = EntryType::connection_test}, 0, writer.position());
  writer.message({.sender_node = options_->id}, 1);
  send_own(writer);
}

}  // namespace rr::channel
