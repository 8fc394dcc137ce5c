// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "rr/node_id.hpp"
#include "rr/reader.hpp"
#include "rr/type.hpp"
#include "rr/writer.hpp"
#include "runtime/cpp/src/node/testing/silent_peer.hpp"

namespace rr::testing {

/// A service that says what a test wants, in message format 2, and connects in steps. What the test
/// does not answer is answered as by a service that does as it is told.
class RawService {
 public:
  /// Writes the elements of an entry, last first; returns how many.
  using Elements = std::function<std::uint32_t(Writer&)>;

  struct Request {
    EntryType type = EntryType::null;
    std::string path;
    std::string member;
    std::uint32_t id = 0;
    std::string service_type;  ///< of a request for a definition
  };
  struct Answer {
    EntryType type = EntryType::null;
    std::string path;
    std::string member;
    std::uint32_t id = 0;
    Elements elements{};
    std::uint16_t error = 0;
    std::uint32_t endpoint = 77;
    std::string node_name = "raw.service";
    NodeId node{};  ///< zero: that of this service
  };
  /// False leaves the request to the service.
  using Handler = std::function<bool(const Request&)>;

  RawService(std::string definition, std::string object_type, Handler handler = nullptr)
      : object_type_(std::move(object_type)),
        definition_(std::move(definition)),
        handler_(std::move(handler)),
        thread_([this] { serve(); }) {}
  ~RawService() {
    is_over_ = true;
    hang_up();
    RawSocketEnd(peer_.port());  // NOLINT(bugprone-unused-raii): accept() returns
    thread_.join();
  }
  RawService(const RawService&) = delete;
  RawService& operator=(const RawService&) = delete;

  [[nodiscard]] std::uint16_t port() const { return peer_.port(); }
  [[nodiscard]] std::string url(const std::string& service = "raw") const {
    return "rr+tcp://127.0.0.1:" + std::to_string(port()) + "/?service=" + service;
  }
  [[nodiscard]] const NodeId& node() const { return node_; }
  /// Bytes that have been sent.
  [[nodiscard]] std::size_t sent() const { return sent_; }
  /// Answers of clients that have been read.
  [[nodiscard]] std::size_t answered() { return answers().size(); }
  /// Type and error of each of them.
  [[nodiscard]] std::vector<std::pair<EntryType, std::uint16_t>> answers() {
    const std::lock_guard lock(client_mutex_);
    return answers_;
  }

  /// The answer that a request should get, without elements.
  static Answer answer_to(const Request& request) {
    Answer answer;
    answer.type =
        static_cast<EntryType>(static_cast<std::uint16_t>(static_cast<int>(request.type) + 1));
    answer.path = request.path;
    answer.member = request.member;
    answer.id = request.id;
    return answer;
  }
  template <class T>
  static Elements value(std::string name, T value) {
    return [name = std::move(name), value = std::move(value)](Writer& writer) {
      type_of<T>.write(writer, name, &value);
      return 1U;
    };
  }
  static Elements error_elements(std::string name, std::string text) {
    return [name = std::move(name), text = std::move(text)](Writer& writer) {
      writer.string_element("errorstring", text);
      writer.string_element("errorname", name);
      return 2U;
    };
  }

  /// Ends the connection to the client, and with it a send() that waits.
  void hang_up() {
    if (const int socket = socket_; socket >= 0) ::shutdown(socket, SHUT_RDWR);
  }
  /// From any thread. False when nobody takes it any more.
  bool send(const Answer& answer) { return send({&answer, 1}); }
  /// Several in one message.
  bool send(std::span<const Answer> answers) {
    Writer writer;
    writer.reset(MessageVersion::v2);
    for (std::size_t i = answers.size(); i-- != 0;) {
      const std::size_t end = writer.position();
      const std::uint32_t count = answers[i].elements ? answers[i].elements(writer) : 0;
      writer.entry({.type = answers[i].type,
                    .service_path = answers[i].path,
                    .member = answers[i].member,
                    .request_id = answers[i].id,
                    .error = answers[i].error},
                   count, end);
    }
    const Answer& first = answers.front();
    const std::lock_guard lock(mutex_);
    const auto [client, client_endpoint] = this->client();
    writer.message({.sender_node = first.node.is_any() ? node_ : first.node,
                    .receiver_node = client,
                    .sender_name = first.node_name,
                    .sender_endpoint = first.endpoint,
                    .receiver_endpoint = client_endpoint},
                   static_cast<std::uint32_t>(answers.size()));
    const std::vector<std::byte> bytes = writer.copy();
    return send_bytes(bytes);
  }

 private:
  struct RawSocketEnd {
    explicit RawSocketEnd(std::uint16_t port) : socket(::socket(AF_INET, SOCK_STREAM, 0)) {
      sockaddr_in address{};
      address.sin_family = AF_INET;
      address.sin_port = htons(port);
      address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
      static_cast<void>(
          ::connect(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address));
    }
    ~RawSocketEnd() { ::close(socket); }
    int socket;
  };

  std::pair<NodeId, std::uint32_t> client() {
    const std::lock_guard lock(client_mutex_);
    return {client_, client_endpoint_};
  }
  bool send_bytes(std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
      const int socket = socket_;
      if (socket < 0) return false;
      const ssize_t now = ::send(socket, bytes.data(), bytes.size(), MSG_NOSIGNAL);
      if (now <= 0) return false;
      sent_ += static_cast<std::size_t>(now);
      bytes = bytes.subspan(static_cast<std::size_t>(now));
    }
    return true;
  }
  void serve() {
    while (!is_over_) {
      const int socket = peer_.accept();
      socket_ = socket;
      while (!is_over_ && take_message(socket)) {
      }
      ::shutdown(socket, SHUT_RDWR);  // wakes a thread that sends
      socket_ = -1;
      const std::lock_guard lock(mutex_);
      ::close(socket);
    }
  }

  static bool receive(int socket, std::byte* bytes, std::size_t size) {
    while (size != 0) {
      const ssize_t received = ::recv(socket, bytes, size, 0);
      if (received <= 0) return false;
      bytes += received;
      size -= static_cast<std::size_t>(received);
    }
    return true;
  }

  bool take_message(int socket) {
    std::vector<std::byte> bytes(10);
    if (!receive(socket, bytes.data(), bytes.size())) return false;
    bytes.resize(message_size(bytes, {}));
    if (bytes.size() <= 10 || !receive(socket, bytes.data() + 10, bytes.size() - 10)) return false;
    const auto message = std::make_unique<Message>();
    if (!read_message(bytes, {}, false, *message, nullptr)) return false;
    {
      const std::lock_guard lock(client_mutex_);
      client_ = message->sender_node;
      client_endpoint_ = message->sender_endpoint;
    }
    EntryReader entries(*message);
    for (Entry entry; entries.next(entry);) {
      Request request{entry.type,
                      std::string(entry.service_path),
                      std::string(entry.member),
                      entry.request_id,
                      {}};
      Decoder decoder(message->version);
      Element element;
      if (find_element(decoder, entry.elements, entry.element_count, "ServiceType", element)) {
        request.service_type = element.text();
      }
      if (static_cast<int>(request.type) % 2 == 0) {
        const std::lock_guard lock(client_mutex_);
        answers_.emplace_back(entry.type, entry.error);
        continue;
      }
      if (!handler_ || !handler_(request)) do_as_told(request);
    }
    return true;
  }

  void do_as_told(const Request& request) {
    Answer answer = answer_to(request);
    switch (request.type) {
      case EntryType::stream_op:
      case EntryType::connection_test:
        answer.endpoint = 0;
        break;
      case EntryType::get_service_desc:
        answer.elements = value("servicedef", definition_);
        break;
      case EntryType::object_type_name:
        answer.elements = value("objecttype", object_type_);
        break;
      case EntryType::client_keep_alive_req:
        return;
      default:
        break;
    }
    send(answer);
  }

  const NodeId node_ = NodeId::random();
  const std::string object_type_;
  const std::string definition_;
  const Handler handler_;
  std::mutex mutex_;  // one message at a time; before the next
  // The client and its answers, which are read while a message waits to be sent.
  std::mutex client_mutex_;
  NodeId client_;
  std::uint32_t client_endpoint_ = 0;
  std::vector<std::pair<EntryType, std::uint16_t>> answers_;
  std::atomic<int> socket_{-1};
  std::atomic<std::size_t> sent_{0};
  std::atomic<bool> is_over_{false};
  SilentPeer peer_;
  std::thread thread_;
};

}  // namespace rr::testing
