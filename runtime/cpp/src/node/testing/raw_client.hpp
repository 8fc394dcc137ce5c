// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "rr/node.hpp"
#include "rr/node_id.hpp"
#include "rr/reader.hpp"
#include "rr/type.hpp"
#include "rr/writer.hpp"
#include "runtime/cpp/src/channel/testing/socket_pair.hpp"

namespace rr::testing {

/// A client that says what a test wants, in message format 2, over a socket pair. A test that looks
/// at the bytes of a service needs no more.
class RawClient {
 public:
  /// Writes the elements of an entry, last first; returns how many.
  using Elements = std::function<std::uint32_t(Writer&)>;

  struct Answer {
    EntryType type = EntryType::null;
    std::string member;
    std::uint16_t error = 0;
    std::string header_metadata;
    std::string entry_metadata;
    std::uint32_t element_count = 0;
    std::vector<std::byte> elements;

    /// A number among the elements. Throws std::bad_optional_access when there is none.
    [[nodiscard]] double number(std::string_view name) const {
      Decoder decoder(MessageVersion::v2);
      Element element;
      std::optional<double> value;
      if (find_element(decoder, elements, element_count, name, element)) {
        type_of<double>.read(decoder, element, &value.emplace());
      }
      return value.value();
    }
  };

  RawClient(Node& node, const std::string& service) : server_(node.id()) {
    node.adopt(sockets_.give_away());
    send(EntryType::connect_client, service, "");
    if (!receive()) throw Error(ErrorCode::connection_error, "no answer");
  }

  void send(EntryType type, std::string_view path, std::string_view member,
            const Elements& elements = nullptr) {
    Writer writer;
    writer.reset(MessageVersion::v2);
    const std::uint32_t count = elements ? elements(writer) : 0;
    writer.entry({.type = type, .service_path = path, .member = member, .request_id = 7}, count, 0);
    writer.message({.sender_node = own_,
                    .receiver_node = server_,
                    .sender_endpoint = 31,
                    .receiver_endpoint = endpoint_},
                   1);
    sockets_.send(writer.copy());
  }
  /// The next message; nothing when none comes in time.
  std::optional<Answer> receive(int milliseconds = 10000) {
    const std::vector<std::byte> bytes = sockets_.receive_message(milliseconds);
    if (bytes.empty()) return std::nullopt;
    Message message;
    Entry entry;
    if (!read_message(bytes, {}, false, message, entry)) return std::nullopt;
    if (endpoint_ == 0) endpoint_ = message.sender_endpoint;
    return Answer{entry.type,
                  std::string(entry.member),
                  entry.error,
                  std::string(message.metadata),
                  std::string(entry.metadata),
                  entry.element_count,
                  {entry.elements.begin(), entry.elements.end()}};
  }
  /// Sends a request; what comes next is its answer.
  Answer ask(EntryType type, std::string_view path, std::string_view member,
             const Elements& elements = nullptr) {
    send(type, path, member, elements);
    return receive().value();
  }

 private:
  const NodeId own_ = NodeId::random();
  const NodeId server_;
  std::uint32_t endpoint_ = 0;
  SocketPair sockets_;
};

}  // namespace rr::testing
