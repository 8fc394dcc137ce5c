// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "rr/reader.hpp"
#include "rr/writer.hpp"
#include "runtime/cpp/src/node/testing/silent_peer.hpp"

namespace rr::testing {

/// The other end of a node's connection: bytes that no client of ours would send.
class RawPeer {
 public:
  /// Connects to a port of this machine.
  explicit RawPeer(std::uint16_t port) : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    static_cast<void>(
        ::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address));
    const int on = 1;
    ::setsockopt(socket_, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
  }
  /// One end of a pair of sockets; `other` becomes the other one.
  struct Paired {
    int& other;
  };
  explicit RawPeer(Paired paired) : RawPeer(SOCK_STREAM, paired.other) {}
  /// The same of sockets that show what was sent by one call.
  struct PairedByPackets {
    int& other;
  };
  explicit RawPeer(PairedByPackets paired) : RawPeer(SOCK_SEQPACKET, paired.other) {}
  /// The same by TCP, on the loopback interface.
  struct PairedByTcp {
    int& other;
  };
  explicit RawPeer(PairedByTcp paired) : RawPeer(SilentPeer(), paired.other) {}
  /// Of a connection that was accepted; the socket becomes this one's.
  struct Accepted {
    int socket;
  };
  explicit RawPeer(Accepted accepted) : socket_(accepted.socket) {}
  ~RawPeer() { ::close(socket_); }
  RawPeer(const RawPeer&) = delete;
  RawPeer& operator=(const RawPeer&) = delete;

  /// A question that every node answers, with `size` bytes that mean nothing.
  void ask_for_node_info(std::size_t size = 0) { ask(EntryType::get_node_info, size); }
  /// A message of one entry, with `size` bytes in an element.
  void ask(EntryType type, std::size_t size = 0) {
    Writer writer;
    writer.reset(MessageVersion::v2);
    const std::size_t end = writer.position();
    const std::vector<char> filling(size, 'x');
    if (size != 0) writer.string_element("filling", {filling.data(), filling.size()});
    writer.entry({.type = type}, size == 0 ? 0 : 1, end);
    writer.message({}, 1);
    send(writer.copy());
  }
  /// What the other side has sent by one call, at most 64 KiB; only with PairedByPackets.
  std::vector<std::byte> receive_packet() {
    std::vector<std::byte> bytes(65'536);
    const ssize_t size = ::recv(socket_, bytes.data(), bytes.size(), 0);
    bytes.resize(size > 0 ? static_cast<std::size_t>(size) : 0);
    return bytes;
  }
  void send(std::span<const std::byte> bytes) {
    for (std::size_t sent = 0; sent < bytes.size();) {
      const ssize_t now = ::send(socket_, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
      if (now <= 0) return;
      sent += static_cast<std::size_t>(now);
    }
  }

  /// What the first entry of the next message is; its type is null when none comes within some
  /// seconds, or the connection ends.
  struct Received {
    EntryType type = EntryType::null;
    std::uint32_t request_id = 0;
    std::string member{};
  };
  EntryType next_type() { return next().type; }
  Received next() {
    std::array<std::byte, 10> header{};
    if (!receive(header.data(), header.size())) return {};
    std::vector<std::byte> bytes(header.begin(), header.end());
    bytes.resize(message_size(bytes, {}));
    if (bytes.size() <= header.size() ||
        !receive(bytes.data() + header.size(), bytes.size() - header.size())) {
      return {};
    }
    const auto message = std::make_unique<Message>();
    Entry entry;
    if (!read_message(bytes, {}, false, *message, nullptr) || !EntryReader(*message).next(entry)) {
      return {};
    }
    return {entry.type, entry.request_id, std::string(entry.member)};
  }

  /// Waits for the end of the connection, some seconds at most, and drops what comes before it.
  bool is_closed() {
    std::array<std::byte, 4096> bytes;
    while (is_readable()) {
      if (::recv(socket_, bytes.data(), bytes.size(), 0) <= 0) return true;
    }
    return false;
  }

  /// How many segments with data have come.
  [[nodiscard]] std::uint32_t data_segments_received() const { return info().data_segments_in; }
  /// How many segments that were sent the other side has not acknowledged yet.
  [[nodiscard]] std::uint32_t unacknowledged() const { return info().known.tcpi_unacked; }

 private:
  RawPeer(int type, int& other) {
    std::array<int, 2> ends{-1, -1};
    ::socketpair(AF_UNIX, type, 0, ends.data());
    socket_ = ends[0];
    other = ends[1];
  }
  RawPeer(const SilentPeer& listening, int& other) : RawPeer(listening.port()) {
    other = listening.accept();
  }
  // What the kernel tells of a connection: the C library's header knows its beginning.
  struct TcpState {
    tcp_info known;
    std::array<std::uint64_t, 4> rates_and_bytes;
    std::uint32_t segments_out;
    std::uint32_t segments_in;
    std::uint32_t unsent_bytes;
    std::uint32_t least_round_trip;
    std::uint32_t data_segments_in;
  };
  TcpState info() const {
    TcpState found{};
    socklen_t size = sizeof found;
    ::getsockopt(socket_, IPPROTO_TCP, TCP_INFO, &found, &size);
    return found;
  }
  bool is_readable() const {
    pollfd wanted{socket_, POLLIN, 0};
    return ::poll(&wanted, 1, 20'000) > 0;
  }
  bool receive(std::byte* bytes, std::size_t size) {
    while (size != 0) {
      if (!is_readable()) return false;
      const ssize_t received = ::recv(socket_, bytes, size, 0);
      if (received <= 0) return false;
      bytes += received;
      size -= static_cast<std::size_t>(received);
    }
    return true;
  }

  int socket_ = -1;
};

}  // namespace rr::testing
