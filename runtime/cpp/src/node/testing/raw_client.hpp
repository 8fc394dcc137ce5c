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

  struct Request {
    EntryType type = EntryType::null;
    std::string path;
    std::string member;
    Elements elements{};
    std::uint32_t id = 7;
    std::uint16_t error = 0;
  };
  struct Answer {
    EntryType type = EntryType::null;
    std::string member;
    std::uint32_t id = 0;
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
    /// The same of another type.
    template <class T>
    [[nodiscard]] T value_of(std::string_view name) const {
      Decoder decoder(MessageVersion::v2);
      Element element;
      std::optional<T> value;
      if (find_element(decoder, elements, element_count, name, element)) {
        type_of<T>.read(decoder, element, &value.emplace());
      }
      return std::move(value.value());
    }
  };

  /// One that is not connected to any service.
  explicit RawClient(Node& node) : server_(node.id()) { node.adopt(sockets_.give_away()); }
  RawClient(Node& node, const std::string& service) : server_(node.id()) { connect(node, service); }
  /// From an address of the loopback interface.
  RawClient(Node& node, const std::string& service, const char* from)
      : server_(node.id()), sockets_(from) {
    connect(node, service);
  }

  void send(EntryType type, std::string_view path, std::string_view member,
            const Elements& elements = nullptr) {
    const Request request{type, std::string(path), std::string(member), elements};
    send({&request, 1});
  }
  /// Several in one message.
  void send(std::span<const Request> requests) {
    Writer writer;
    writer.reset(MessageVersion::v2);
    for (std::size_t i = requests.size(); i-- != 0;) {
      const Request& request = requests[i];
      const std::size_t end = writer.position();
      const std::uint32_t count = request.elements ? request.elements(writer) : 0;
      writer.entry({.type = request.type,
                    .service_path = request.path,
                    .member = request.member,
                    .request_id = request.id,
                    .error = request.error},
                   count, end);
    }
    writer.message({.sender_node = own_,
                    .receiver_node = server_,
                    .sender_endpoint = 31,
                    .receiver_endpoint = endpoint_},
                   static_cast<std::uint32_t>(requests.size()));
    sockets_.send(writer.copy());
  }
  /// The next message of one entry; nothing when none comes in time.
  std::optional<Answer> receive(int milliseconds = 10000) {
    std::vector<Answer> answers = receive_all(milliseconds);
    if (answers.size() != 1) return std::nullopt;
    return std::move(answers.front());
  }
  /// The entries of the next message; none when none comes in time.
  std::vector<Answer> receive_all(int milliseconds = 10000) {
    const std::vector<std::byte> bytes = sockets_.receive_message(milliseconds);
    Message message;
    Entry first;
    if (bytes.empty() || !read_message(bytes, {}, false, message, first)) return {};
    if (endpoint_ == 0) endpoint_ = message.sender_endpoint;
    std::vector<Answer> answers;
    EntryReader entries(message);
    for (Entry entry; entries.next(entry);) {
      answers.push_back({entry.type,
                         std::string(entry.member),
                         entry.request_id,
                         entry.error,
                         std::string(message.metadata),
                         std::string(entry.metadata),
                         entry.element_count,
                         {entry.elements.begin(), entry.elements.end()}});
    }
    return answers;
  }
  /// Sends a request; what comes next is its answer.
  Answer ask(EntryType type, std::string_view path, std::string_view member,
             const Elements& elements = nullptr) {
    send(type, path, member, elements);
    return receive().value();
  }

 private:
  void connect(Node& node, const std::string& service) {
    node.adopt(sockets_.give_away());
    send(EntryType::connect_client, service, "");
    if (!receive()) throw Error(ErrorCode::connection_error, "no answer");
  }

  const NodeId own_ = NodeId::random();
  const NodeId server_;
  std::uint32_t endpoint_ = 0;
  SocketPair sockets_;
};

}  // namespace rr::testing
