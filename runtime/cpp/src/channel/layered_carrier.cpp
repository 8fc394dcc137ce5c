// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/channel/layered_carrier.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

#include "rr/error.hpp"
#include "runtime/cpp/src/channel/socket.hpp"
#include "runtime/cpp/src/channel/watcher.hpp"

namespace rr::channel {
namespace {

// As a record of TLS. What comes out of one receive fits into a scratch.
constexpr std::size_t chunk = 16 * 1024;
// The payload of the largest frame of web sockets that is sent.
constexpr std::size_t sent_at_once = 65'535;
// Of what layers say by themselves. Who asks for more, and reads nothing, is not answered any more.
constexpr std::size_t most_unsent = 1024 * 1024;

}  // namespace

void LayeredCarrier::add(std::unique_ptr<Layer> layer, std::span<const std::byte> received) {
  const MutexLock lock(mutex_);
  layers_.push_back(std::move(layer));
  if (!received.empty()) pass(received, layers_.size() - 1);
}

void LayeredCarrier::begin(std::unique_ptr<Layer> layer) {
  const MutexLock lock(mutex_);
  Bytes first;
  layer->begin(first);
  say(layers_.size(), std::move(first));
  layers_.push_back(std::move(layer));
  flush_under_lock();
}

const Layer* LayeredCarrier::outermost() const {
  const MutexLock lock(mutex_);
  return layers_.empty() ? nullptr : layers_.back().get();
}

std::size_t LayeredCarrier::count() const {
  const MutexLock lock(mutex_);
  return layers_.size();
}

bool LayeredCarrier::is_open() const {
  const MutexLock lock(mutex_);
  return layers_.empty() || layers_.back()->is_open();
}

bool LayeredCarrier::is_encrypted() const {
  const MutexLock lock(mutex_);
  return std::any_of(layers_.begin(), layers_.end(),
                     [](const auto& layer) { return layer->is_encrypted(); });
}

NodeId LayeredCarrier::certified_node() const {
  const MutexLock lock(mutex_);
  for (const auto& layer : layers_) {
    const NodeId node = layer->certified_node();
    if (!node.is_any()) return node;
  }
  return {};
}

std::shared_ptr<const PeerProof> LayeredCarrier::take_proof() {
  const MutexLock lock(mutex_);
  for (const auto& layer : layers_) {
    if (auto proof = layer->take_proof()) return proof;
  }
  return nullptr;
}

std::string LayeredCarrier::failure() const {
  const MutexLock lock(mutex_);
  return failure_;
}

// Through the layers from this one on, the rest as plain bytes.
void LayeredCarrier::pass(std::span<const std::byte> wire, std::size_t layer) {
  Bytes bytes(wire.begin(), wire.end());
  for (; layer < layers_.size() && !has_failed_; ++layer) {
    Bytes plain;
    Bytes reply;
    try {
      layers_[layer]->receive(bytes, plain, reply);
      has_failed_ = layers_[layer]->has_ended();
    } catch (const Error& error) {
      fail(error.message());
    }
    if (!reply.empty()) say(layer, std::move(reply));
    if (unsent_.size() - unsent_at_ > most_unsent) fail("the other side does not read its answers");
    bytes = std::move(plain);
    if (bytes.empty()) break;
  }
  if (layer >= layers_.size() || !has_failed_) append(plain_, bytes);
}

void LayeredCarrier::fail(std::string why) {
  has_failed_ = true;
  if (failure_.empty()) failure_ = std::move(why);
}

// Bytes for the socket from above so many layers.
void LayeredCarrier::say(std::size_t layers, Bytes bytes) {
  while (layers != 0) {
    Bytes wire;
    layers_[--layers]->send(bytes, wire);
    bytes = std::move(wire);
  }
  append(unsent_, bytes);
  unsent_size_.store(unsent_.size() - unsent_at_, std::memory_order_relaxed);
}

// False when the socket is broken.
bool LayeredCarrier::flush_under_lock() {
  bool is_broken = false;
  while (unsent_at_ != unsent_.size()) {
    const std::ptrdiff_t sent = platform::send(socket_, std::span(unsent_).subspan(unsent_at_));
    is_broken = sent == platform::broken;
    if (sent <= 0) break;
    unsent_at_ += static_cast<std::size_t>(sent);
  }
  if (unsent_at_ == unsent_.size()) {
    unsent_.clear();
    unsent_at_ = 0;
  }
  unsent_size_.store(unsent_.size() - unsent_at_, std::memory_order_relaxed);
  return !is_broken;
}

bool LayeredCarrier::flush() {
  const MutexLock lock(mutex_);
  return flush_under_lock();
}

std::ptrdiff_t LayeredCarrier::receive(Frame& /*message*/, bool /*may_block*/) {
  return platform::broken;  // it has no messages
}

std::ptrdiff_t LayeredCarrier::receive(std::span<std::byte> room, bool may_block) {
  while (!has_received()) {
    plain_.clear();
    plain_at_ = 0;
    {
      const MutexLock lock(mutex_);
      if (has_failed_) {
        flush_under_lock();
        return 0;
      }
    }
    std::array<std::byte, chunk> wire;
    const auto wait = may_block ? platform::Wait::some : platform::Wait::none;
    const std::ptrdiff_t size = platform::receive(socket_, wire, wait);
    if (size <= 0) return size;
    const MutexLock lock(mutex_);
    pass(std::span(wire).first(static_cast<std::size_t>(size)), 0);
  }
  const std::size_t size = std::min(room.size(), plain_.size() - plain_at_);
  std::memcpy(room.data(), plain_.data() + plain_at_, size);
  plain_at_ += size;
  return static_cast<std::ptrdiff_t>(size);
}

std::ptrdiff_t LayeredCarrier::send(std::span<const platform::Buffer> pieces) {
  const MutexLock lock(mutex_);
  std::ptrdiff_t taken = 0;
  Bytes plain;
  std::size_t piece = 0;
  std::size_t at = 0;
  while (true) {
    if (!flush_under_lock()) return platform::broken;
    if (!unsent_.empty() || (!layers_.empty() && !layers_.back()->is_open())) return taken;
    plain.clear();
    while (piece != pieces.size() && plain.size() != sent_at_once) {
      const std::size_t part = std::min(pieces[piece].size - at, sent_at_once - plain.size());
      append(plain, {pieces[piece].data + at, part});
      at += part;
      if (at != pieces[piece].size) break;
      ++piece;
      at = 0;
    }
    if (plain.empty()) return taken;
    taken += static_cast<std::ptrdiff_t>(plain.size());
    say(layers_.size(), std::move(plain));
  }
}

void LayeredCarrier::wait_for_room(Time deadline) {
  platform::wait_for(socket_, ready::room, deadline);
}

}  // namespace rr::channel
