// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "rr/node_id.hpp"

namespace rr::channel {

struct PeerProof;

using Bytes = std::vector<std::byte>;

inline void append(Bytes& bytes, std::span<const std::byte> more) {
  bytes.insert(bytes.end(), more.begin(), more.end());
}

/// A protocol around a stream of bytes: TLS, or web sockets. Knows no socket: bytes go in and come
/// out. One thread at a time. Throws rr::Error when the other side breaks the protocol or is
/// refused; what it is to be told of that is in `reply`.
class Layer {
 public:
  virtual ~Layer() = default;
  /// Takes what came from below. What it means is added to `plain`, what is to be said in return to
  /// `reply`.
  virtual void receive(std::span<const std::byte> wire, Bytes& plain, Bytes& reply) = 0;
  /// Adds to `wire` what says these bytes; only when it is open.
  virtual void send(std::span<const std::byte> plain, Bytes& wire) = 0;
  /// Adds to `wire` what a client begins with.
  virtual void begin(Bytes& wire) = 0;
  /// Both sides have agreed, so that bytes can be sent.
  [[nodiscard]] virtual bool is_open() const = 0;
  /// The other side has said that nothing more comes.
  [[nodiscard]] virtual bool has_ended() const = 0;
  [[nodiscard]] virtual bool is_encrypted() const { return false; }
  /// The node that the other side has proved to be; zero when it has not.
  [[nodiscard]] virtual NodeId certified_node() const { return {}; }
  /// What it has proved that with, when it is open: once, then null.
  virtual std::shared_ptr<const PeerProof> take_proof() { return nullptr; }
};

}  // namespace rr::channel
