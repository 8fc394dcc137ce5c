// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/channel/opening.hpp"

#include <algorithm>
#include <array>
#include <system_error>
#include <utility>

#include "rr/error.hpp"
#include "rr/reader.hpp"
#include "runtime/cpp/src/channel/operations.hpp"
#include "runtime/cpp/src/channel/shared_carrier.hpp"
#include "runtime/cpp/src/channel/tls.hpp"
#include "runtime/cpp/src/channel/web_socket.hpp"
#include "runtime/cpp/src/platform/shared_memory.hpp"

namespace rr::channel {
namespace {

constexpr std::size_t smallest_header = 10;

[[noreturn]] void fail(std::string message) {
  throw Error(ErrorCode::connection_error, std::move(message));
}

}  // namespace

std::vector<OpeningStep> opening_steps(std::string_view scheme) {
  std::vector<OpeningStep> steps;
  if (scheme == "rr+wss" || scheme == "rrs+wss") steps.push_back(OpeningStep::web_tls);
  if (scheme.ends_with("+ws") || scheme.ends_with("+wss")) steps.push_back(OpeningStep::web_socket);
  if (scheme.starts_with("rrs+")) steps.push_back(OpeningStep::start_tls);
  steps.push_back(OpeningStep::agree);
  return steps;
}

namespace {

std::vector<OpeningStep> steps_to(const Url& url, const NodeOptions& options) {
  std::vector<OpeningStep> steps = opening_steps(url.scheme);
  if (url.scheme == "rr+local" && options.local.shared_memory && platform::has_shared_memory()) {
    steps.push_back(OpeningStep::ask_memory);
    steps.push_back(OpeningStep::get_memory);
  }
  return steps;
}

}  // namespace

Opening::Opening(const Address& address, const Url& url, const ChannelContext& context)
    : url_(url),
      context_(context),
      options_(*context.options),
      steps_(steps_to(url, options_)),
      place_(address.text()),
      servers_(address.servers) {
  std::error_code error;
  switch (platform::begin_connect(address, socket_, error)) {
    case platform::Connecting::done:
      connected();
      break;
    case platform::Connecting::begun:
      break;
    case platform::Connecting::failed:
      fail_connecting(error);
  }
}

platform::Awaited Opening::wanted() const {
  using namespace platform::ready;
  const bool has_unsent = carrier_ != nullptr && carrier_->unsent() != 0;
  return {socket_.get(), is_connected_ ? input | (has_unsent ? room : 0) : room};
}

std::optional<Agreed> Opening::go_on() {
  if (!is_connected_) {
    if (const std::error_code error = platform::connect_result(socket_.get())) {
      fail_connecting(error);
    }
    connected();
    return std::nullopt;
  }
  const OpeningStep step = steps_[step_];
  if (step == OpeningStep::web_tls || step == OpeningStep::web_socket) {
    if (go_on_with_layer()) ++step_, next_step();
    return std::nullopt;
  }
  if (step == OpeningStep::start_tls && !request_.empty()) {
    if (!receive_answer()) return std::nullopt;
    said_node_ = check_start_tls(answer_, url_, options_, place_);
    request_.clear();
    begin_layer(context_.tls->make_client(said_node_));
    return std::nullopt;
  }
  if (step == OpeningStep::start_tls) {
    if (go_on_with_layer()) ++step_, next_step();
    return std::nullopt;
  }
  if (!receive_answer()) return std::nullopt;
  if (step == OpeningStep::agree) agree();
  if (step == OpeningStep::ask_memory &&
      check_capability(answer_, shared_memory_capability, agreed_, options_, place_) !=
          shared_memory_level) {
    return finish();
  }
  if (step == OpeningStep::get_memory) open_memory();
  if (++step_ == steps_.size()) return finish();
  next_step();
  return std::nullopt;
}

void Opening::fail_connecting(const std::error_code& error) const {
  fail("cannot connect to " + place_ + ": " + error.message());
}

void Opening::connected() {
  is_connected_ = true;
  check_server();
  platform::set_stream_options(socket_.get());
  next_step();
}

// Before anything is said: another user can have put a socket where there was none.
void Opening::check_server() const {
  if (servers_.empty()) return;
  const auto server = platform::peer_user(socket_.get());
  if (server && std::find(servers_.begin(), servers_.end(), *server) != servers_.end()) return;
  fail(place_ + " is served by " +
       (server ? "user " + std::to_string(*server) : std::string("nobody who can be named")) +
       ", to whom its folder does not belong");
}

LayeredCarrier& Opening::carrier() {
  if (!carrier_) carrier_ = std::make_unique<LayeredCarrier>(socket_.get());
  return *carrier_;
}

void Opening::begin_layer(std::unique_ptr<Layer> layer) { carrier().begin(std::move(layer)); }

void Opening::next_step() {
  answer_.clear();
  answer_size_ = 0;
  switch (steps_[step_]) {
    case OpeningStep::web_tls:
      // With TLS of nodes inside, that one proves the node.
      begin_layer(context_.tls->make_web_client(url_.host,
                                                url_.scheme == "rr+wss" ? url_.node_id : NodeId()));
      break;
    case OpeningStep::web_socket:
      begin_layer(context_.web_sockets->make_client(url_));
      break;
    case OpeningStep::start_tls:
      request_ = start_tls_request(url_, context_.tls->has_certificate());
      send(request_);
      break;
    case OpeningStep::agree:
      request_ = create_connection_request(url_, options_);
      send(request_);
      break;
    case OpeningStep::ask_memory:
      send(capability_request(shared_memory_capability, agreed_, options_));
      break;
    case OpeningStep::get_memory:
      send(share_memory_request(agreed_, options_));
      break;
  }
}

// A new socket has room for one small message.
void Opening::send(std::span<const std::byte> message) {
  std::ptrdiff_t sent = 0;
  if (carrier_) {
    const platform::Buffer piece{message.data(), message.size()};
    sent = carrier_->send({&piece, 1});
  } else {
    sent = platform::send(socket_.get(), message);
  }
  if (sent != static_cast<std::ptrdiff_t>(message.size())) {
    fail("the connection to " + place_ + " broke");
  }
}

std::ptrdiff_t Opening::receive(std::span<std::byte> room) {
  std::ptrdiff_t size = 0;
  if (carrier_) {
    size = carrier_->receive(room, false);
  } else if (steps_[step_] == OpeningStep::get_memory) {
    size = platform::receive_with_handle(socket_.get(), room, memory_);
  } else {
    size = platform::receive(socket_.get(), room, platform::Wait::none);
  }
  if (carrier_) carrier_->flush();
  if (size > 0) return size;
  if (size == platform::nothing_now) return 0;
  fail_reading(size);
}

void Opening::fail_reading(std::ptrdiff_t size) const {
  const std::string failure = carrier_ ? carrier_->failure() : std::string();
  if (!failure.empty()) fail(place_ + ": " + failure);
  fail(size == 0 ? place_ + " closed the connection" : "the connection to " + place_ + " broke");
}

// True when the layer that has begun is open.
bool Opening::go_on_with_layer() {
  std::array<std::byte, 1> none{};
  if (!carrier_->is_open() && receive(none) != 0) {
    throw Error(ErrorCode::protocol_error, place_ + " speaks before it was asked");
  }
  return carrier_->is_open();
}

// No more than the answer, so that nothing behind it gets lost. True when it is whole.
bool Opening::receive_answer() {
  while (true) {
    const std::size_t have = answer_.size();
    const std::size_t wanted = answer_size_ == 0 ? smallest_header : answer_size_;
    answer_.resize(wanted);
    const std::ptrdiff_t size = receive(std::span(answer_).subspan(have));
    answer_.resize(have + static_cast<std::size_t>(size));
    if (answer_.size() != wanted) return false;
    if (answer_size_ != 0) return true;
    Limits limits = options_.limits;
    limits.message_size = static_cast<std::uint32_t>(longest_answer);
    answer_size_ = message_size(answer_, limits);
    if (answer_size_ == 0) {
      throw Error(ErrorCode::protocol_error, place_ + " speaks another protocol");
    }
  }
}

void Opening::agree() {
  if (carrier_) {
    agreed_.certified_node = carrier_->certified_node();
    agreed_.proof = carrier_->take_proof();
  }
  check_create_connection(answer_, url_, options_, place_, agreed_);
  if (carrier_ && carrier_->is_encrypted() && agreed_.certified_node.is_any() &&
      context_.tls->is_pinned(agreed_.remote_node)) {
    fail("the node at " + place_ + " says that it is one whose certificate is another");
  }
  agreed_.request = std::move(request_);
}

// The other side has changed over with its answer, so that there is no way back.
void Opening::open_memory() {
  const auto terms = check_share_memory(answer_, agreed_, options_, place_);
  if (!terms) return;
  std::error_code error;
  SharedRings rings = SharedRings::open(memory_, error);
  if (!rings) fail(place_ + " shares memory that cannot be used: " + error.message());
  auto carrier =
      std::make_unique<SharedCarrier>(std::move(rings), false, socket_.get(), options_.spin);
  if (terms->has_slots) carrier->use_slots();
  agreed_.carrier = std::move(carrier);
}

std::optional<Agreed> Opening::finish() {
  agreed_.socket = std::move(socket_);
  if (carrier_) agreed_.carrier = std::move(carrier_);
  return std::move(agreed_);
}

}  // namespace rr::channel
