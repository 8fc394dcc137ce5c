// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <memory>
#include <span>
#include <string>

#include "rr/node_id.hpp"
#include "rr/options.hpp"
#include "rr/reader.hpp"
#include "runtime/cpp/src/channel/layer.hpp"
#include "runtime/cpp/src/channel/layered_carrier.hpp"
#include "runtime/cpp/src/channel/link_terms.hpp"
#include "runtime/cpp/src/channel/repeated_request.hpp"
#include "runtime/cpp/src/channel/shared_carrier.hpp"

namespace rr::channel {

class SendQueue;

/// What is around the messages of one connection, and who the other side has proved to be. A client
/// may ask for layers: TLS or web sockets by its first bytes, TLS by STARTTLS.
///
/// Changed by whoever has the read lease; what says so may be read by any thread.
class PeerLayers {
 public:
  struct Terms {
    int socket = -1;
    bool is_server = false;
    bool must_certify_clients = false;
  };
  /// `carrier`: of a channel of its own; null for the plain bytes of the socket.
  PeerLayers(const Terms& terms, const LinkTerms& link, SendQueue& sending,
             std::unique_ptr<Carrier> carrier);

  /// Null: the plain bytes of the socket.
  [[nodiscard]] Carrier* carrier() const { return carrier_.get(); }
  [[nodiscard]] bool is_layered() const { return is_layered_; }
  /// The layer that first bytes like these ask for; null: none.
  [[nodiscard]] std::unique_ptr<Layer> asked(std::byte first);
  /// Puts a layer around everything; `received` are bytes for it that have come already.
  void add(std::unique_ptr<Layer> layer, std::span<const std::byte> received = {});

  // STARTTLS (04, section 6): answered in clear, and followed by TLS. `request` are the bytes of
  // the message that asked for it.
  void ask_for_tls(bool is_mutual, std::span<const std::byte> request) {
    begins_tls_ = true;
    is_mutual_ = is_mutual;
    request_ = RepeatedRequest::kept(request);
  }
  [[nodiscard]] bool begins_tls() const { return begins_tls_; }
  /// Bytes have come behind the request, in clear: they must not be taken for what was said inside.
  void note_bytes_behind() { has_bytes_behind_ = true; }
  [[nodiscard]] bool has_bytes_behind() const { return has_bytes_behind_; }
  /// Forgets that TLS was asked for, and begins it. Throws rr::Error.
  void begin_tls();
  void forget_tls() { begins_tls_ = false; }

  // Shared memory: bytes go through it from the next one on.
  void share(std::unique_ptr<SharedCarrier> carrier);
  /// Since bytes were taken last; once.
  [[nodiscard]] bool begins_sharing() const { return begins_sharing_; }
  void forget_sharing() { begins_sharing_ = false; }
  /// Any thread: what carries it; null while nothing does.
  [[nodiscard]] SharedCarrier* shared() const { return shared_.load(std::memory_order_acquire); }

  [[nodiscard]] bool is_encrypted() const;
  [[nodiscard]] bool can_start_tls() const;
  /// The scheme that a client would have to write to come here in the same way.
  [[nodiscard]] std::string scheme() const;

  /// What the other side has proved to be; once.
  void set_certified_node(const NodeId& node);
  [[nodiscard]] bool is_proven() const { return is_proven_.load(std::memory_order_acquire); }
  /// Zero without a proof.
  [[nodiscard]] NodeId certified_node() const { return is_proven() ? certified_node_ : NodeId(); }
  /// Takes what the layers have proved; null when that is to be watched by nobody.
  [[nodiscard]] std::shared_ptr<const PeerProof> take_proof();
  /// False for a message in the name of another node than the certified one.
  [[nodiscard]] bool may_send(const Message& message) const;
  /// Whoever has proved to be a node is that node, also without saying so.
  [[nodiscard]] const NodeId& sender_of(const Message& message) const;

 private:
  LayeredCarrier& layers();

  static constexpr unsigned web_tls = 1;
  static constexpr unsigned web_socket = 2;
  static constexpr unsigned started_tls = 4;

  const Terms terms_;
  const LinkTerms& link_;
  SendQueue& sending_;
  std::unique_ptr<Carrier> carrier_;
  bool is_layered_ = false;  // carrier_ is a LayeredCarrier
  bool begins_tls_ = false;
  bool is_mutual_ = false;
  Bytes request_;  // that asked for TLS, until that begins
  bool has_bytes_behind_ = false;
  bool begins_sharing_ = false;
  std::atomic<SharedCarrier*> shared_{nullptr};  // carrier_, and never another one after it
  std::atomic<unsigned> around_{0};
  NodeId certified_node_;  // once, before is_proven_ is set
  std::atomic<bool> is_proven_{false};
};

}  // namespace rr::channel
