// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/channel/handshake.hpp"

#include <utility>

#include "rr/error.hpp"
#include "rr/writer.hpp"
#include "runtime/cpp/src/channel/operations.hpp"

namespace rr::channel {
namespace {

// The failure that an entry reports.
Error reported_error(Decoder& decoder, const Entry& entry) {
  Element name;
  Element text;
  const bool has_name =
      find_element(decoder, entry.elements, entry.element_count, "errorname", name);
  const bool has_text =
      find_element(decoder, entry.elements, entry.element_count, "errorstring", text);
  return {static_cast<ErrorCode>(entry.error), std::string(has_name ? name.text() : ""),
          std::string(has_text ? text.text() : "the other side refused the connection")};
}

/// What is answered.
struct Asked {
  std::string_view member;
  EntryType answer = EntryType::stream_op_ret;
  bool has_standard_strings = false;
};

// Reads the answer to a stream operation. Throws when it is something else.
void read_answer(std::span<const std::byte> answer, const Asked& asked, const NodeOptions& options,
                 const std::string& place, Message& message, Entry& entry) {
  if (!read_message(answer, options.limits, asked.has_standard_strings, message, nullptr) ||
      !EntryReader(message).next(entry) || entry.type != asked.answer ||
      entry.member != asked.member) {
    throw Error(ErrorCode::protocol_error, place + " speaks another protocol");
  }
}

void check_node(const Message& message, const Url& url, const std::string& place) {
  if ((!url.node_name.empty() && url.node_name != message.sender_name) ||
      (!url.node_id.is_any() && url.node_id != message.sender_node)) {
    throw Error(ErrorCode::connection_error, "the node at " + place + " is not the one wanted");
  }
}

}  // namespace

std::vector<std::byte> create_connection_request(const Url& url, const NodeOptions& options) {
  // A local socket is named by one of the two (04, section 4.1).
  const bool has_only_one = url.scheme == "rr+local" && !url.node_id.is_any();
  Writer writer;
  write_create_connection(writer,
                          {.sender_node = options.id,
                           .receiver_node = url.node_id,
                           .sender_name = options.name,
                           .receiver_name = has_only_one ? std::string_view() : url.node_name},
                          offered_codes(options.client_offer));
  return writer.copy();
}

void check_create_connection(std::span<const std::byte> answer, const Url& url,
                             const NodeOptions& options, const std::string& place, Agreed& agreed) {
  const auto message = std::make_unique<Message>();
  Entry entry;
  read_answer(answer, {create_connection}, options, place, *message, entry);
  Decoder decoder(message->version, &message->strings);
  // An old server does not know the operation; it is used as such servers are.
  if (entry.error != 0 && static_cast<ErrorCode>(entry.error) != ErrorCode::protocol_error) {
    throw reported_error(decoder, entry);
  }
  check_node(*message, url, place);
  if (!agreed.certified_node.is_any() && agreed.certified_node != message->sender_node) {
    throw Error(ErrorCode::connection_error,
                "the node at " + place + " says that it is another than its certificate does");
  }
  Element element;
  if (entry.error == 0 &&
      find_element(decoder, entry.elements, entry.element_count, "capabilities", element)) {
    const auto codes = read_codes(element);
    const auto agreement = codes ? agree(*codes, options.client_offer) : std::nullopt;
    if (!agreement) {
      throw Error(ErrorCode::protocol_error, place + " agreed to what was not offered");
    }
    agreed.agreement = *agreement;
  }
  agreed.remote_node = message->sender_node;
  agreed.remote_name = message->sender_name;
  agreed.answer.assign(answer.begin(), answer.end());
}

namespace {

std::vector<std::byte> request_of(EntryType type, std::string_view member, const Agreed& agreed,
                                  const NodeOptions& options, bool has_slots = false) {
  Writer writer;
  writer.reset(agreed.agreement.version);
  const std::size_t end = writer.position();
  if (has_slots) write_slots_level(writer);
  writer.entry({.type = type, .member = member}, has_slots ? 1 : 0, end);
  writer.message({.sender_node = options.id, .receiver_node = agreed.remote_node}, 1);
  return writer.copy();
}

}  // namespace

std::vector<std::byte> capability_request(std::string_view capability, const Agreed& agreed,
                                          const NodeOptions& options) {
  return request_of(EntryType::stream_check_capability, capability, agreed, options);
}

std::uint32_t check_capability(std::span<const std::byte> answer, std::string_view capability,
                               const Agreed& agreed, const NodeOptions& options,
                               const std::string& place) {
  const auto message = std::make_unique<Message>();
  Entry entry;
  const Asked asked{capability, EntryType::stream_check_capability_ret,
                    agreed.agreement.standard_strings};
  read_answer(answer, asked, options, place, *message, entry);
  Decoder decoder(message->version, &message->strings);
  Element element;
  if (entry.error != 0 ||
      !find_element(decoder, entry.elements, entry.element_count, "return", element)) {
    return 0;
  }
  const auto level = read_codes(element);
  return level && level->size() == 1 ? level->front() : 0;
}

std::vector<std::byte> share_memory_request(const Agreed& agreed, const NodeOptions& options) {
  return request_of(EntryType::stream_op, share_memory, agreed, options, wants_slots(options));
}

std::optional<SharedTerms> check_share_memory(std::span<const std::byte> answer,
                                              const Agreed& agreed, const NodeOptions& options,
                                              const std::string& place) {
  const auto message = std::make_unique<Message>();
  Entry entry;
  const Asked asked{share_memory, EntryType::stream_op_ret, agreed.agreement.standard_strings};
  read_answer(answer, asked, options, place, *message, entry);
  if (entry.error != 0) return std::nullopt;
  Decoder decoder(message->version, &message->strings);
  return SharedTerms{wants_slots(options) && has_slots_level(decoder, entry)};
}

std::vector<std::byte> start_tls_request(const Url& url, bool is_mutual) {
  Writer writer;
  writer.reset(MessageVersion::v2);
  const std::size_t end = writer.position();
  if (is_mutual) writer.string_element("mutualauth", "true");
  writer.entry({.type = EntryType::stream_op, .member = start_tls}, is_mutual ? 1 : 0, end);
  const bool has_id = !url.node_id.is_any();
  writer.message(
      {.receiver_node = url.node_id, .receiver_name = has_id ? std::string_view() : url.node_name},
      1);
  return writer.copy();
}

NodeId check_start_tls(std::span<const std::byte> answer, const Url& url,
                       const NodeOptions& options, const std::string& place) {
  const auto message = std::make_unique<Message>();
  Entry entry;
  read_answer(answer, {start_tls}, options, place, *message, entry);
  Decoder decoder(message->version, &message->strings);
  if (static_cast<ErrorCode>(entry.error) == ErrorCode::node_not_found) {
    throw reported_error(decoder, entry);
  }
  if (entry.error != 0) {
    throw Error(ErrorCode::connection_error,
                place + " does not offer encryption: " + reported_error(decoder, entry).message());
  }
  check_node(*message, url, place);
  return message->sender_node;
}

}  // namespace rr::channel
