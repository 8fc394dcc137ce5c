// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <utility>

#include "rr/node_id.hpp"
#include "runtime/cpp/src/channel/layer.hpp"

namespace rr::channel {

/// The TLS of a server, which tolerates that the client repeats its request for TLS (STARTTLS).
/// Clients of the reference library sometimes send it a second time in clear, between two messages
/// of the handshake, or behind the last one. It is dropped, and never handled: once, until the
/// first record behind the handshake, where a record ends, and only when it is the request byte for
/// byte. All other bytes go to TLS, which refuses what is no record of its own.
class RepeatedRequest final : public Layer {
 public:
  /// What is kept of a request; nothing of one that is larger than those of nodes are.
  static Bytes kept(std::span<const std::byte> request);
  static constexpr std::size_t largest = 4096;

  /// Of an empty request no repetition is dropped.
  RepeatedRequest(std::unique_ptr<Layer> tls, Bytes request)
      : tls_(std::move(tls)), request_(std::move(request)) {}

  void receive(std::span<const std::byte> wire, Bytes& plain, Bytes& reply) override;
  void send(std::span<const std::byte> plain, Bytes& wire) override { tls_->send(plain, wire); }
  void begin(Bytes& wire) override { tls_->begin(wire); }
  [[nodiscard]] bool is_open() const override { return tls_->is_open(); }
  [[nodiscard]] bool has_ended() const override { return tls_->has_ended(); }
  [[nodiscard]] bool is_encrypted() const override { return tls_->is_encrypted(); }
  [[nodiscard]] NodeId certified_node() const override { return tls_->certified_node(); }
  std::shared_ptr<const PeerProof> take_proof() override { return tls_->take_proof(); }

 private:
  [[nodiscard]] bool is_between_records() const { return header_size_ == 0; }
  std::size_t take_record(std::span<const std::byte> wire);
  std::size_t take_repetition(std::span<const std::byte> wire);

  const std::unique_ptr<Layer> tls_;
  Bytes request_;                // empty: nothing is dropped any more
  std::size_t repeated_ = 0;     // of the request, withheld from TLS
  std::size_t header_size_ = 0;  // that has come of a record's header
  std::size_t body_left_ = 0;
};

}  // namespace rr::channel
