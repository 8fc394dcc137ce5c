// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/replay/passing.hpp"

#include <optional>

#include "rr/message_tree.hpp"
#include "rr/reader.hpp"
#include "runtime/cpp/src/channel/capabilities.hpp"
#include "runtime/cpp/src/replay/cutter.hpp"

namespace rr::replay {
namespace {

bool is_telling(EntryType type) {
  return type == EntryType::stream_op_ret || type == EntryType::get_service_desc_ret ||
         type == EntryType::connect_client_combined_ret;
}

// What the answer to CreateConnection says (04, section 4.4).
void tell_agreement(Tap& tap, std::uint32_t connection, const Message& message,
                    const Entry& entry) {
  if (entry.member != "CreateConnection" || entry.error != 0) return;
  ConnectionAgreed agreed{.client_node = message.receiver_node,
                          .service_node = message.sender_node,
                          .client_name = std::string(message.receiver_name),
                          .service_name = std::string(message.sender_name)};
  Decoder decoder(message.version, &message.strings);
  Element element;
  if (find_element(decoder, entry.elements, entry.element_count, "capabilities", element)) {
    const auto codes = channel::read_codes(element);
    const auto agreement =
        codes ? channel::agree(*codes, Offer{}) : std::optional<channel::Agreement>();
    if (agreement) {
      agreed.version = agreement->version;
      agreed.combined_connect = agreement->combined_connect;
      agreed.local_strings = agreement->local_strings;
      agreed.standard_strings = agreement->standard_strings;
    }
  }
  tap.agreed(connection, agreed);
}

std::string_view text_in(const ElementTree& element) {
  if (element.type != ElementType::string) return {};
  return {reinterpret_cast<const char*>(element.payload.data()), element.payload.size()};
}

void tell_definitions(Tap& tap, std::span<const std::byte> bytes) {
  MessageTree tree;
  if (!read_tree(bytes, tree)) return;
  for (const EntryTree& entry : tree.entries) {
    if (entry.error != 0) continue;
    for (const ElementTree& element : entry.elements) {
      if (element.name == "servicedef") tap.definition(text_in(element));
      if (element.name != "servicedefs") continue;
      for (const ElementTree& item : element.elements) tap.definition(text_in(item));
    }
  }
}

}  // namespace

void tell(Tap& tap, std::uint32_t connection, Direction direction,
          std::span<const std::byte> bytes) {
  const Piece piece{bytes.data(), bytes.size()};
  tap.message(connection, direction, {&piece, 1});
  if (direction != Direction::to_client) return;
  Message message;
  Entry entry;
  if (!read_message(bytes, {.message_size = Cutter::largest_message}, true, message, entry) ||
      !is_telling(entry.type)) {
    return;
  }
  if (entry.type == EntryType::stream_op_ret) {
    tell_agreement(tap, connection, message, entry);
  } else {
    tell_definitions(tap, bytes);
  }
}

}  // namespace rr::replay
