// SPDX-License-Identifier: Apache-2.0
// What a client asks for before it speaks of anything else: web sockets and TLS.
#include <utility>

#include "rr/error.hpp"
#include "runtime/cpp/src/channel/operations.hpp"
#include "runtime/cpp/src/channel/stream_connection.hpp"
#include "runtime/cpp/src/channel/tls.hpp"
#include "runtime/cpp/src/channel/web_socket.hpp"

namespace rr::channel {

// The layer that bytes which begin so are for; null: none. TLS may be around everything, web
// sockets around messages, and nothing twice.
std::unique_ptr<Layer> StreamConnection::asked_layer(std::byte first) {
  constexpr auto http_begin = std::byte{'G'};  // of `GET `
  constexpr auto tls_begin = std::byte{22};    // a record of a handshake
  if (role_ != Role::server) return nullptr;
  const std::size_t around =
      is_layered_ ? static_cast<const LayeredCarrier&>(*carrier_).count() : 0;
  if (carrier_ != nullptr && !is_layered_) return nullptr;
  if (first == tls_begin && around == 0 && terms_.tls && terms_.tls->has_certificate()) {
    auto layer = terms_.tls->make_server(options_->tls.must_certify_clients);
    ways_ |= web_tls_way;
    return layer;
  }
  if (first == http_begin && terms_.web_sockets && (ways_ & web_socket_way) == 0) {
    auto layer = terms_.web_sockets->make_server();
    ways_ |= web_socket_way;
    return layer;
  }
  return nullptr;
}

// With the read turn.
LayeredCarrier& StreamConnection::layers() {
  if (!is_layered_) {
    const std::lock_guard lock(sending_);
    carrier_ = std::make_unique<LayeredCarrier>(socket_.get());
    is_layered_ = true;
  }
  return static_cast<LayeredCarrier&>(*carrier_);
}

bool StreamConnection::is_encrypted() const {
  return terms_.traits.is_encrypted || (ways_ & (web_tls_way | start_tls_way)) != 0;
}

// As a client would have to write it to come here in the same way.
std::string StreamConnection::scheme() const {
  const unsigned ways = ways_;
  if (ways == 0) return terms_.scheme;
  const bool is_web = (ways & web_socket_way) != 0;
  const bool is_web_tls = (ways & web_tls_way) != 0;
  const bool is_safe = (ways & start_tls_way) != 0 || (is_web_tls && !is_web);
  return std::string(is_safe ? "rrs+" : "rr+") + (is_web ? (is_web_tls ? "wss" : "ws") : "tcp");
}

// Nobody speaks for a node that the certificate is not of.
bool StreamConnection::is_certified(const Message& message) const {
  return certified_node_.is_any() || !message.has_routing || message.sender_node.is_any() ||
         message.sender_node == certified_node_;
}

// Whoever has proved to be a node is that node, also without saying so.
const NodeId& StreamConnection::sender_of(const Message& message) const {
  const bool is_silent = message.sender_node.is_any() && is_proven_.load(std::memory_order_acquire);
  return is_silent ? certified_node_ : message.sender_node;
}

// With the read turn: what the other side has proved to be, and will be looked at again for.
void StreamConnection::note_peer() {
  set_certified_node(layers().certified_node());
  auto proof = layers().take_proof();
  if (proof && terms_.tls) terms_.tls->watch(shared_from_this(), std::move(proof));
}

// What was received is for a layer, not for the inbox.
StreamConnection::Received StreamConnection::upgrade(Scratch& scratch, std::size_t size,
                                                     std::unique_ptr<Layer> layer) {
  layers().add(std::move(layer), std::span(scratch.bytes).first(size));
  bool is_full = false;
  const Received received = receive_bytes(scratch, false, is_full);
  if (carrier_->unsent() != 0) flush();
  return received == Received::nothing ? Received::some : received;
}

// 04, section 6, step 2: answers in clear what is followed by TLS.
void StreamConnection::answer_start_tls(const Message& message, const Entry& entry) {
  const bool is_target =
      (message.receiver_node.is_any() || message.receiver_node == options_->id) &&
      (message.receiver_name.empty() || message.receiver_name == options_->name);
  Decoder decoder(message.version, &message.strings);
  Element element;
  const bool is_mutual =
      find_element(decoder, entry.elements, entry.element_count, "mutualauth", element) &&
      element.text() == "true";
  Writer& writer = thread_writer();
  writer.reset(version());
  const std::size_t end = writer.position();
  std::uint32_t count = 0;
  ErrorCode error = ErrorCode::none;
  if (!is_target) {
    error = ErrorCode::node_not_found;
    count = write_error(writer, error_name(error), "Node not found");
  } else if (is_mutual) {
    writer.string_element("mutualauth", "true");
    count = 1;
  }
  writer.entry({.type = EntryType::stream_op_ret,
                .service_path = entry.service_path,
                .member = entry.member,
                .request_id = entry.request_id,
                .error = static_cast<std::uint16_t>(error)},
               count, end);
  writer.message({.sender_node = options_->id,
                  .receiver_node = message.sender_node,
                  .sender_name = options_->name,
                  .receiver_name = message.sender_name},
                 1);
  send_own(writer);
  begins_tls_ = is_target;
  is_mutual_ = is_mutual;
}

// What follows on the connection is TLS. Bytes that came together with the request in clear are not
// taken for something that was said inside.
StreamConnection::Received StreamConnection::begin_tls() {
  begins_tls_ = false;
  was_heard_ = false;  // so that the handshake has its time limit too
  const bool has_more = inbox_.is_assembling() || !inbox_.kept().empty() ||
                        (carrier_ != nullptr && carrier_->has_received()) || has_more_behind_;
  bool is_sent = false;
  {
    const std::lock_guard lock(sending_);
    is_sent = outbox_.empty();
  }
  if (has_more || !is_sent) {
    return fail_reading({ErrorCode::protocol_error, "the other side speaks before it uses TLS"});
  }
  const bool asks = is_mutual_ || options_->tls.must_certify_clients;
  ways_ |= start_tls_way;
  try {
    layers().add(terms_.tls->make_server(asks));
  } catch (const Error& error) {
    return fail_reading(error);
  }
  return Received::some;
}

}  // namespace rr::channel
