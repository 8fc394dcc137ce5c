// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/replay/stream.hpp"

#include <algorithm>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <system_error>

#include "rr/error.hpp"
#include "runtime/cpp/src/platform/local_socket.hpp"
#include "runtime/cpp/src/platform/shared_memory.hpp"
#include "runtime/cpp/src/platform/waiting.hpp"

namespace rr::replay {
namespace {

using Clock = std::chrono::steady_clock;

// What a message says of its own size, in its first eight bytes.
std::uint32_t announced_size(const Bytes& bytes) {
  std::uint32_t size = 0;
  std::memcpy(&size, bytes.data() + 4, sizeof size);
  return size;
}

constexpr std::size_t smallest_message = 16;

// What is not there may not answer for minutes.
constexpr Milliseconds longest_connecting{5'000};

// Not open when it cannot connect.
Descriptor connect_to(const platform::Address& address) {
  platform::Descriptor socket;
  std::error_code error;
  const auto state = platform::begin_connect(address, socket, error);
  if (state == platform::Connecting::failed) return {};
  const bool is_connected =
      state == platform::Connecting::done ||
      (platform::wait_for(socket.get(), platform::ready::room, Clock::now() + longest_connecting) &&
       !platform::connect_result(socket.get()));
  return is_connected ? Descriptor(socket.release()) : Descriptor();
}

}  // namespace

void Descriptor::close() {
  if (number_ >= 0) platform::close_socket(std::exchange(number_, -1));
}

bool wait_readable(int descriptor, Milliseconds limit) {
  return platform::wait_for(descriptor, platform::ready::input, Clock::now() + limit);
}

Stream::Stream(Descriptor socket) : socket_(std::move(socket)) {
  platform::set_stream_options(socket_.get());
}

Stream Stream::connect(const std::string& host, int port) {
  const std::vector<platform::Address> addresses = platform::look_up(host, platform::LookUp::all);
  if (addresses.empty()) throw std::runtime_error("unknown host " + host);
  for (platform::Address address : addresses) {
    address.set_port(static_cast<std::uint16_t>(port));
    if (Descriptor socket = connect_to(address); socket.is_open()) {
      return Stream(std::move(socket));
    }
  }
  throw std::runtime_error("nobody listens at " + host + ":" + std::to_string(port));
}

Stream Stream::connect(const std::filesystem::path& local) {
  const auto address = platform::local_socket_address(local.string());
  if (!address) throw std::runtime_error("no local socket can have the path " + local.string());
  Descriptor socket = connect_to(*address);
  if (!socket.is_open()) throw std::runtime_error("nobody listens at " + local.string());
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
    if (shared_) {
      const platform::Buffer piece{bytes.data(), bytes.size()};
      const std::ptrdiff_t sent = shared_->send({&piece, 1});
      if (sent < 0) return;
      bytes = bytes.subspan(static_cast<std::size_t>(sent));
      if (!bytes.empty()) shared_->wait_for_room(Clock::now() + longest_connecting);
      continue;
    }
    const std::ptrdiff_t sent = platform::send(socket_.get(), bytes);
    if (sent == platform::broken) return;
    if (sent == platform::nothing_now) {
      platform::wait_for(socket_.get(), platform::ready::room, platform::Time::max());
      continue;
    }
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

void Stream::put_back(const std::vector<Bytes>& messages) {
  Bytes bytes;
  for (const Bytes& message : messages) bytes.insert(bytes.end(), message.begin(), message.end());
  received_.insert(received_.begin(), bytes.begin(), bytes.end());
}

Arrival Stream::receive(Bytes& message, Milliseconds limit) {
  const auto end = Clock::now() + limit;
  while (true) {
    const auto left = std::chrono::ceil<Milliseconds>(end - Clock::now());
    const Arrival arrival = receive_unfiltered(message, std::max(left, Milliseconds(0)));
    if (arrival != Arrival::message || !filter_) return arrival;
    const auto filter = std::exchange(filter_, nullptr);  // may receive itself
    const bool is_done = filter(*this, message);
    if (!filter_) filter_ = filter;
    if (!is_done) return arrival;
  }
}

Arrival Stream::receive_unfiltered(Bytes& message, Milliseconds limit) {
  const auto end = Clock::now() + limit;
  while (!take_message(message)) {
    if (!is_open()) return Arrival::closed;
    const auto left = std::chrono::ceil<Milliseconds>(end - Clock::now());
    if (!has_ended_ && !wait_for_bytes(left)) return Arrival::nothing;
    if (has_ended_ || !read()) {
      close();
      return Arrival::closed;
    }
  }
  return Arrival::message;
}

// The bell may have rung before.
bool Stream::wait_for_bytes(Milliseconds limit) {
  if (shared_ && shared_->rest()) return true;
  return wait_readable(socket_.get(), limit);
}

// In shared memory there may be nothing, though the bell has rung.
std::ptrdiff_t Stream::receive_some(std::span<std::byte> room) {
  if (shared_) {
    shared_->note_event();
    return shared_->receive(room, false);
  }
  const std::ptrdiff_t size = platform::receive_with_handle(socket_.get(), room, handle_);
  if (size != platform::nothing_now) return size;
  return platform::receive(socket_.get(), room, platform::Wait::some);
}

bool Stream::read() {
  std::byte buffer[65536];
  while (true) {
    const std::ptrdiff_t count = receive_some(buffer);
    if (count == platform::nothing_now && shared_) return true;
    if (count == platform::nothing_now) continue;
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
  platform::IpAddress ip;
  if (!any_interface) ip = platform::parse_ip("127.0.0.1").value();
  std::error_code error;
  platform::Descriptor socket =
      platform::listen_at(platform::address_of(ip, static_cast<std::uint16_t>(port)), error);
  if (!socket) {
    throw std::runtime_error("cannot listen on port " + std::to_string(port) + ": " +
                             error.message());
  }
  socket_ = Descriptor(socket.release());
  port_ = platform::local_address(socket_.get()).port();
}

Listener::Listener(const std::filesystem::path& local) {
  std::error_code error;
  platform::PlacedSocket placed(local.string(), false, error);
  if (error) {
    throw std::runtime_error("cannot listen at " + local.string() + ": " + error.message());
  }
  socket_ = Descriptor(placed.take().release());
}

std::optional<Stream> Listener::accept(Milliseconds limit) {
  if (!wait_readable(socket_.get(), limit)) return std::nullopt;
  std::error_code error;
  platform::Descriptor accepted = platform::accept_one(socket_.get(), error);
  if (!accepted) return std::nullopt;
  return Stream(Descriptor(accepted.release()));
}

}  // namespace rr::replay
