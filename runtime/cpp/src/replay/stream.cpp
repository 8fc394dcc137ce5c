// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/replay/stream.hpp"

#include <arpa/inet.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <memory>
#include <stdexcept>

#include "rr/error.hpp"

namespace rr::replay {
namespace {

using Clock = std::chrono::steady_clock;

void send_at_once(int socket) {
  const int on = 1;
  ::setsockopt(socket, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
}

// What a message says of its own size, in its first eight bytes.
std::uint32_t announced_size(const Bytes& bytes) {
  std::uint32_t size = 0;
  std::memcpy(&size, bytes.data() + 4, sizeof size);
  return size;
}

constexpr std::size_t smallest_message = 16;

sockaddr_un local_address(const std::filesystem::path& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::string name = path.string();
  if (name.size() >= sizeof address.sun_path) {
    throw std::runtime_error("no local socket can have the path " + name);
  }
  std::memcpy(address.sun_path, name.data(), name.size());
  return address;
}

}  // namespace

void Descriptor::close() {
  if (number_ >= 0) ::close(std::exchange(number_, -1));
}

bool wait_readable(int descriptor, Milliseconds limit) {
  const auto end = Clock::now() + limit;
  while (true) {
    pollfd wanted{descriptor, POLLIN, 0};
    const auto left = std::chrono::ceil<Milliseconds>(end - Clock::now()).count();
    const int ready = ::poll(&wanted, 1, left < 0 ? 0 : static_cast<int>(left));
    if (ready >= 0 || errno != EINTR) return ready > 0;
  }
}

Stream::Stream(Descriptor socket) : socket_(std::move(socket)) { send_at_once(socket_.get()); }

Stream Stream::connect(const std::string& host, int port) {
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* list = nullptr;
  if (::getaddrinfo(host.c_str(), std::to_string(port).c_str(), &hints, &list) != 0) {
    throw std::runtime_error("unknown host " + host);
  }
  const std::unique_ptr<addrinfo, void (*)(addrinfo*)> owner(list, ::freeaddrinfo);
  for (const addrinfo* each = list; each != nullptr; each = each->ai_next) {
    Descriptor socket(::socket(each->ai_family, each->ai_socktype | SOCK_CLOEXEC, 0));
    // What is not there may not answer for minutes.
    const timeval limit{5, 0};
    ::setsockopt(socket.get(), SOL_SOCKET, SO_SNDTIMEO, &limit, sizeof limit);
    if (socket.is_open() && ::connect(socket.get(), each->ai_addr, each->ai_addrlen) == 0) {
      const timeval none{};
      ::setsockopt(socket.get(), SOL_SOCKET, SO_SNDTIMEO, &none, sizeof none);
      return Stream(std::move(socket));
    }
  }
  throw std::runtime_error("nobody listens at " + host + ":" + std::to_string(port));
}

Stream Stream::connect(const std::filesystem::path& local) {
  const sockaddr_un address = local_address(local);
  Descriptor socket(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
  if (::connect(socket.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    throw std::runtime_error("nobody listens at " + local.string());
  }
  return Stream(std::move(socket));
}

void Stream::put(std::unique_ptr<channel::Layer> layer, Milliseconds limit) {
  const auto end = Clock::now() + limit;
  layers_.push_back(std::move(layer));
  const std::size_t place = layers_.size() - 1;
  Bytes first;
  layers_[place]->begin(first);
  send_through(place, std::move(first));
  take(std::exchange(received_, {}), place);
  while (!layers_[place]->is_open()) {
    if (!failure_.empty()) throw std::runtime_error(failure_);
    const auto left = std::chrono::ceil<Milliseconds>(end - Clock::now());
    if (!is_open() || has_ended_) throw std::runtime_error("the other side ended the handshake");
    if (!wait_readable(socket_.get(), left)) throw std::runtime_error("no end of the handshake");
    read();
  }
}

void Stream::send(std::span<const std::byte> bytes) {
  if (layers_.empty()) {
    write(bytes);
  } else {
    send_through(layers_.size(), {bytes.begin(), bytes.end()});
  }
}

void Stream::send_through(std::size_t count, Bytes bytes) {
  if (bytes.empty()) return;
  while (count-- != 0) {
    Bytes wire;
    layers_[count]->send(bytes, wire);
    bytes = std::move(wire);
  }
  write(bytes);
}

void Stream::write(std::span<const std::byte> bytes) {
  while (is_open() && !bytes.empty()) {
    const ssize_t sent = ::send(socket_.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (sent < 0 && errno == EINTR) continue;
    if (sent < 0) return;
    bytes = bytes.subspan(static_cast<std::size_t>(sent));
  }
}

bool Stream::take_message(Bytes& message) {
  if (received_.size() < smallest_message || std::memcmp(received_.data(), "RRAC", 4) != 0) {
    return false;
  }
  const std::size_t size = announced_size(received_);
  if (size < smallest_message || received_.size() < size) return false;
  const auto end = received_.begin() + static_cast<std::ptrdiff_t>(size);
  message.assign(received_.begin(), end);
  received_.erase(received_.begin(), end);
  return true;
}

Arrival Stream::receive(Bytes& message, Milliseconds limit) {
  const auto end = Clock::now() + limit;
  while (!take_message(message)) {
    if (!is_open()) return Arrival::closed;
    const auto left = std::chrono::ceil<Milliseconds>(end - Clock::now());
    if (!has_ended_ && !wait_readable(socket_.get(), left)) return Arrival::nothing;
    if (has_ended_ || !read()) {
      close();
      return Arrival::closed;
    }
  }
  return Arrival::message;
}

bool Stream::read() {
  std::byte buffer[65536];
  while (true) {
    const ssize_t count = ::recv(socket_.get(), buffer, sizeof buffer, 0);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) {
      close();
      return false;
    }
    if (layers_.empty()) {
      received_.insert(received_.end(), buffer, buffer + count);
    } else {
      take({buffer, buffer + count}, 0);
    }
    return true;
  }
}

// A layer that fails has said why to the other side; what came before is kept.
void Stream::take(Bytes bytes, std::size_t first_layer) {
  for (std::size_t i = first_layer; i < layers_.size() && !bytes.empty(); ++i) {
    Bytes plain;
    Bytes reply;
    try {
      layers_[i]->receive(bytes, plain, reply);
    } catch (const Error& error) {
      failure_ = error.message();
      has_ended_ = true;
    }
    send_through(i, std::move(reply));
    has_ended_ = has_ended_ || layers_[i]->has_ended();
    bytes = std::move(plain);
  }
  received_.insert(received_.end(), bytes.begin(), bytes.end());
}

Listener::Listener(int port, bool any_interface) {
  socket_ = Descriptor(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
  const int on = 1;
  ::setsockopt(socket_.get(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(any_interface ? INADDR_ANY : INADDR_LOOPBACK);
  auto* plain = reinterpret_cast<sockaddr*>(&address);
  socklen_t size = sizeof address;
  if (::bind(socket_.get(), plain, size) != 0 || ::listen(socket_.get(), 16) != 0 ||
      ::getsockname(socket_.get(), plain, &size) != 0) {
    throw std::runtime_error("cannot listen on port " + std::to_string(port) + ": " +
                             std::strerror(errno));
  }
  port_ = ntohs(address.sin_port);
}

Listener::Listener(const std::filesystem::path& local) {
  const sockaddr_un address = local_address(local);
  socket_ = Descriptor(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
  if (::bind(socket_.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 ||
      ::listen(socket_.get(), 16) != 0) {
    throw std::runtime_error("cannot listen at " + local.string() + ": " + std::strerror(errno));
  }
}

std::optional<Stream> Listener::accept(Milliseconds limit) {
  if (!wait_readable(socket_.get(), limit)) return std::nullopt;
  Descriptor accepted(::accept4(socket_.get(), nullptr, nullptr, SOCK_CLOEXEC));
  if (!accepted.is_open()) return std::nullopt;
  return Stream(std::move(accepted));
}

}  // namespace rr::replay
