// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/channel/peer_layers.hpp"

#include <utility>

#include "runtime/cpp/src/channel/remote_address.hpp"
#include "runtime/cpp/src/channel/send_queue.hpp"
#include "runtime/cpp/src/channel/tls.hpp"
#include "runtime/cpp/src/channel/web_socket.hpp"

namespace rr::channel {

PeerLayers::PeerLayers(const Terms& terms, const LinkTerms& link, SendQueue& sending,
                       std::unique_ptr<Carrier> carrier)
    : terms_(terms), link_(link), sending_(sending), carrier_(std::move(carrier)) {
  if (!carrier_) return;
  sending_.set_carrier(carrier_.get());
  shared_ = carrier_->shared();
}

void PeerLayers::share(std::unique_ptr<SharedCarrier> carrier) {
  SharedCarrier* const shared = carrier.get();
  carrier_ = std::move(carrier);
  begins_sharing_ = true;
  shared_.store(shared, std::memory_order_release);
}

// TLS may be around everything, web sockets around messages, and nothing twice.
std::unique_ptr<Layer> PeerLayers::asked(std::byte first) {
  constexpr auto tls_begin = std::byte{22};  // a record of a handshake
  if (!terms_.is_server) return nullptr;
  const std::size_t count = is_layered_ ? layers().count() : 0;
  if (carrier_ != nullptr && !is_layered_) return nullptr;
  if (first == tls_begin && count == 0 && link_.tls && link_.tls->has_certificate()) {
    auto layer = link_.tls->make_server(terms_.must_certify_clients);
    around_ |= web_tls;
    return layer;
  }
  if (link_.web_sockets && link_.web_sockets->is_request(first) && (around_ & web_socket) == 0) {
    auto layer = link_.web_sockets->make_server({.is_encrypted = (around_ & web_tls) != 0,
                                                 .must_encrypt = link_.is_tls_required,
                                                 .address = remote_address_of(terms_.socket)});
    around_ |= web_socket;
    return layer;
  }
  return nullptr;
}

LayeredCarrier& PeerLayers::layers() {
  if (!is_layered_) {
    carrier_ = std::make_unique<LayeredCarrier>(terms_.socket);
    sending_.set_carrier(carrier_.get());
    is_layered_ = true;
  }
  return static_cast<LayeredCarrier&>(*carrier_);
}

void PeerLayers::add(std::unique_ptr<Layer> layer, std::span<const std::byte> received) {
  layers().add(std::move(layer), received);
}

void PeerLayers::begin_tls() {
  around_ |= started_tls;
  auto tls = link_.tls->make_server(is_mutual_ || terms_.must_certify_clients);
  layers().add(std::make_unique<RepeatedRequest>(std::move(tls), std::exchange(request_, {})));
}

bool PeerLayers::is_encrypted() const {
  return link_.traits.is_encrypted || (around_ & (web_tls | started_tls)) != 0;
}

bool PeerLayers::can_start_tls() const {
  return link_.tls != nullptr && link_.tls->has_certificate() && !is_encrypted();
}

std::string PeerLayers::scheme() const {
  const unsigned around = around_;
  if (around == 0) return link_.scheme;
  const bool is_web = (around & web_socket) != 0;
  const bool is_web_tls = (around & web_tls) != 0;
  const bool is_safe = (around & started_tls) != 0 || (is_web_tls && !is_web);
  return std::string(is_safe ? "rrs+" : "rr+") + (is_web ? (is_web_tls ? "wss" : "ws") : "tcp");
}

void PeerLayers::set_certified_node(const NodeId& node) {
  certified_node_ = node;
  is_proven_.store(!node.is_any(), std::memory_order_release);
}

std::shared_ptr<const PeerProof> PeerLayers::take_proof() {
  set_certified_node(layers().certified_node());
  return layers().take_proof();
}

[[gnu::hot]] bool PeerLayers::may_send(const Message& message) const {
  return !message.has_routing || certified_node_.is_any() || message.sender_node.is_any() ||
         message.sender_node == certified_node_;
}

const NodeId& PeerLayers::sender_of(const Message& message) const {
  return message.sender_node.is_any() && is_proven() ? certified_node_ : message.sender_node;
}

}  // namespace rr::channel
