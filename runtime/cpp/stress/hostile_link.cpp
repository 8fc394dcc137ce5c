// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/stress/hostile_link.hpp"

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

#include "rr/type.hpp"

namespace rr::stress {
namespace {

using Clock = std::chrono::steady_clock;

int left_until(Clock::time_point deadline) {
  const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - Clock::now()).count();
  return left > 0 ? static_cast<int>(left) : 0;
}

}  // namespace

HostileLink::HostileLink(std::uint16_t port, const NodeId& server, int number)
    : server_(server), socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK + 1 + static_cast<std::uint32_t>(number) % 4);
  static_cast<void>(::bind(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address));
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  static_cast<void>(
      ::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address));
  ::fcntl(socket_, F_SETFL, O_NONBLOCK);
  // The second part of a message does not wait for the acknowledgement of the first, which takes
  // 40 ms.
  const int on = 1;
  ::setsockopt(socket_, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
}

HostileLink::~HostileLink() {
  if (socket_ >= 0) ::close(socket_);
}

HostileLink::HostileLink(HostileLink&& other) noexcept
    : own_(other.own_),
      server_(other.server_),
      endpoint_(other.endpoint_),
      socket_(std::exchange(other.socket_, -1)) {}

void HostileLink::read_slowly() {
  const int size = 4096;
  ::setsockopt(socket_, SOL_SOCKET, SO_RCVBUF, &size, sizeof size);
}

Bytes make_message(const std::vector<HostileEntry>& entries) {
  Writer writer;
  writer.reset(MessageVersion::v2);
  for (auto entry = entries.rbegin(); entry != entries.rend(); ++entry) {
    const std::size_t end = writer.position();
    const std::uint32_t count = entry->elements ? entry->elements(writer) : 0;
    writer.entry({.type = entry->type,
                  .service_path = entry->path,
                  .member = entry->member,
                  .request_id = entry->id},
                 count, end);
  }
  writer.message({}, static_cast<std::uint32_t>(entries.size()));
  return writer.copy();
}

std::size_t HostileLink::send_made(std::span<const std::byte> message,
                                   std::chrono::milliseconds limit) {
  // Ids and endpoints stand behind magic, size, version and header size (01, section 2).
  constexpr std::size_t ids = 12;
  const std::uint32_t own_endpoint = 31;
  std::array<std::byte, ids + 40> begin;
  std::copy_n(message.begin(), begin.size(), begin.begin());
  std::memcpy(begin.data() + ids, own_.bytes.data(), own_.bytes.size());
  std::memcpy(begin.data() + ids + 16, server_.bytes.data(), server_.bytes.size());
  std::memcpy(begin.data() + ids + 32, &own_endpoint, sizeof own_endpoint);
  std::memcpy(begin.data() + ids + 36, &endpoint_, sizeof endpoint_);
  const std::size_t sent = send(begin, limit);
  return sent != begin.size() ? sent : sent + send(message.subspan(begin.size()), limit);
}

std::size_t HostileLink::send(std::span<const std::byte> bytes, std::chrono::milliseconds limit) {
  const Clock::time_point deadline = Clock::now() + limit;
  std::size_t sent = 0;
  while (sent != bytes.size()) {
    pollfd wanted{socket_, POLLOUT, 0};
    if (::poll(&wanted, 1, left_until(deadline)) != 1) break;
    const ssize_t now = ::send(socket_, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
    if (now <= 0) break;
    sent += static_cast<std::size_t>(now);
  }
  return sent;
}

bool HostileLink::receive_exactly(std::span<std::byte> bytes, Clock::time_point deadline) {
  while (!bytes.empty()) {
    pollfd wanted{socket_, POLLIN, 0};
    if (::poll(&wanted, 1, left_until(deadline)) != 1) return false;
    const ssize_t now = ::recv(socket_, bytes.data(), bytes.size(), 0);
    if (now <= 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(now));
  }
  return true;
}

Bytes HostileLink::receive(std::chrono::milliseconds limit) {
  const Clock::time_point deadline = Clock::now() + limit;
  Bytes bytes(10);
  if (!receive_exactly(bytes, deadline)) return {};
  bytes.resize(message_size(bytes, {}));
  if (bytes.size() <= 10 || !receive_exactly(std::span(bytes).subspan(10), deadline)) return {};
  return bytes;
}

void HostileLink::drop_received() {
  std::array<std::byte, 65536> bytes;
  while (::recv(socket_, bytes.data(), bytes.size(), 0) > 0) {
  }
}

bool HostileLink::connect(const std::string& service) {
  send({{.type = EntryType::connect_client, .path = service, .member = ""}});
  const Bytes bytes = receive(std::chrono::seconds(10));
  Message message;
  Entry first;
  if (bytes.empty() || !read_message(bytes, {}, false, message, first) || first.error != 0) {
    return false;
  }
  endpoint_ = message.sender_endpoint;
  return true;
}

bool HostileLink::ask_index(const HostileEntry& entry, std::int32_t& index) {
  send({entry});
  const Bytes bytes = receive(std::chrono::seconds(10));
  Message message;
  Entry first;
  if (bytes.empty() || !read_message(bytes, {}, false, message, first) || first.error != 0) {
    return false;
  }
  Decoder decoder(MessageVersion::v2);
  Element element;
  return find_element(decoder, first.elements, first.element_count, "index", element) &&
         type_of<std::int32_t>.read(decoder, element, &index);
}

}  // namespace rr::stress
