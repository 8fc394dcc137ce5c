// SPDX-License-Identifier: Apache-2.0
// The life of a connection: start, heartbeats and limits of time, end.
#include "runtime/cpp/src/channel/stream_connection.hpp"

#include <algorithm>
#include <utility>

#include "runtime/cpp/src/channel/remote_address.hpp"

namespace rr::channel {
namespace {

std::string remote_address_of(int descriptor, const LinkTerms& terms) {
  std::string address = channel::remote_address_of(descriptor);
  if (!address.empty()) return address;
  return terms.scheme == "rr+intra" ? "intra" : terms.scheme;
}

// A server waits a little longer, so that the client's heartbeat comes first.
Milliseconds heartbeat_period(bool is_server, const LinkTerms& terms) {
  const Milliseconds period = terms.heartbeat_period;
  return is_server ? period + period / 5 : period;
}

}  // namespace

StreamConnection::StreamConnection(Role role, Descriptor socket, std::shared_ptr<Reactor> reactor,
                                   const std::shared_ptr<const NodeOptions>& options)
    : StreamConnection(role, std::move(socket), std::move(reactor), options, tcp_terms(*options),
                       nullptr) {}

StreamConnection::StreamConnection(Role role, Descriptor socket, std::shared_ptr<Reactor> reactor,
                                   std::shared_ptr<const NodeOptions> options, LinkTerms terms,
                                   std::unique_ptr<Carrier> carrier)
    : role_(role),
      socket_(std::move(socket)),
      reactor_(std::move(reactor)),
      options_(std::move(options)),
      terms_(std::move(terms)),
      largest_size_(terms_.traits.message_limit == 0
                        ? options_->limits.message_size
                        : std::min(options_->limits.message_size, terms_.traits.message_limit)),
      remote_address_(remote_address_of(socket_.get(), terms_)),
      tap_(*options_, role_ == Role::client),
      sending_({.socket = socket_.get(),
                .limit = options_->send_queue_limit,
                .answer_limit = options_->answer_queue_limit,
                .is_server = role_ == Role::server},
               tap_),
      layers_({.socket = socket_.get(),
               .is_server = role_ == Role::server,
               .must_certify_clients = options_->tls.must_certify_clients},
              terms_, sending_, std::move(carrier)),
      strand_(options_->request_queue_limit, account_),
      keep_alive_({.first_message_timeout = options_->first_message_timeout,
                   .receive_timeout = terms_.receive_timeout,
                   .heartbeat_period = heartbeat_period(role_ == Role::server, terms_)},
                  coarse_now()),
      watch_(*reactor_, socket_.get(), *this),
      meter_(reactor_->metrics(), *this) {
  platform::set_stream_options(socket_.get());
  if (role_ == Role::server) threads_ = reactor_->open_share(remote_key(remote_address_));
  tap_.open(socket_.get());
}

StreamConnection::~StreamConnection() {
  reactor_->cancel(life_timer_);
  reactor_->cancel(watch_timer_);
  reactor_->cancel(look_timer_);
}

void StreamConnection::set_agreement(const NodeId& remote_node, std::string remote_name,
                                     const Agreement& agreement) {
  remote_node_ = remote_node;
  remote_name_ = std::move(remote_name);
  version_ = agreement.version;
  may_combine_ = agreement.combined_connect;
  has_local_strings_ = agreement.local_strings;
  has_standard_strings_ = agreement.standard_strings;
  tap_.agreed(*options_, remote_node_, remote_name_, agreement);
}

void StreamConnection::tell_handshake(std::span<const std::byte> request,
                                      std::span<const std::byte> answer) const {
  if (!tap_.is_open()) return;
  const Piece sent{request.data(), request.size()};
  tap_.sent({&sent, 1});
  tap_.received(answer);
}

void StreamConnection::start(std::shared_ptr<Receiver> receiver) {
  keep_alive_.set_heard(role_ == Role::client);
  {
    const MutexLock lock(mutex_);
    if (is_closing_) return;
    receiver_ = std::move(receiver);
    // A message on its way to a client is one at most, and may be what a caller waits for.
    if (role_ == Role::server) inbox_.set_account(account_);
    sending_.set_account(account_);
    if (layers_.carrier() != nullptr) {
      layers_.carrier()->set_on_room([reactor = reactor_.get(), weak = weak_from_this()] {
        if (const auto self = weak.lock()) reactor->post([self] { self->flush(); });
      });
    }
    reactor_->connections().begin();
    self_ = shared_from_this();
    if (layers_.shared() != nullptr) watch_.use_bell(false);
    watch_.begin(role_ == Role::client, sending_.has_unsent());
  }
  constexpr Milliseconds first_look{400};  // 04, section 5
  const Milliseconds soon = role_ == Role::server ? options_->first_message_timeout : first_look;
  reactor_->schedule(life_timer_, weak_from_this(), keep_alive_.first_look(Clock::now(), soon));
}

std::string StreamConnection::local_url() const {
  if (!terms_.local_url.empty()) return terms_.local_url;
  return url_of(platform::local_address(socket_.get()), layers_.scheme());
}

ChannelTraits StreamConnection::traits() const {
  ChannelTraits traits = terms_.traits;
  traits.message_limit = largest_size_;
  traits.is_encrypted = layers_.is_encrypted();
  return traits;
}

ConnectionSample StreamConnection::sample() const {
  ConnectionSample sample{.is_open = !is_closed(),
                          .is_server = role_ == Role::server,
                          .is_in_session = is_authorised_.load(std::memory_order_relaxed),
                          .transport = layers_.scheme(),
                          .queued_bytes = sending_.waiting_bytes(),
                          .traffic = sending_.traffic()};
  sample.traffic.messages_received = messages_received_.get();
  sample.traffic.bytes_received = bytes_received_.get();
  return sample;
}

std::uint32_t StreamConnection::largest_message() const {
  const std::uint32_t size = largest_size_;
  if (is_authorised_.load(std::memory_order_relaxed)) return size;
  return std::min(size, terms_.size_before_connect);
}

Limits StreamConnection::limits() const {
  return {.message_size = largest_message(), .depth = options_->limits.depth};
}

// On the watching thread.
void StreamConnection::look_after() {
  bool is_full = false;  // then it is not the other side that is slow
  {
    const MutexLock lock(mutex_);
    is_full = strand_.is_full();
  }
  const KeepAlive::Look look = keep_alive_.look(Clock::now(), sending_.last_sent(), is_full);
  if (look.failure != nullptr) {
    close(Error(ErrorCode::connection_error, look.failure));
    return;
  }
  if (look.is_test_due) send_test();
  reactor_->schedule(life_timer_, weak_from_this(), look.next);
}

void StreamConnection::close_after(Milliseconds delay) {
  const Time when = after(Clock::now(), delay);
  keep_alive_.close_at(when);
  reactor_->schedule(life_timer_, weak_from_this(), when);
}

void StreamConnection::close(const Error& why) {
  bool has_lease = false;
  {
    const MutexLock lock(mutex_);
    begin_close(why);
    has_lease = lease_.take();
  }
  if (has_lease) finish_close();
}

// Whoever has the read lease, or gets it now, keeps it for ever and finishes.
void StreamConnection::begin_close(const Error& why) {
  if (is_closing_) return;
  is_closing_ = true;
  sending_.close();
  why_closed_ = std::make_unique<const Error>(why);
  platform::shut_down(socket_.get());  // wakes a thread that receives
  if (SharedCarrier* const shared = layers_.shared()) {
    shared->interrupt();
    shared->interrupt_other();
  }
}

// With the read lease, which is not given back.
void StreamConnection::finish_close() {
  reactor_->cancel(life_timer_);
  reactor_->cancel(watch_timer_);
  reactor_->cancel(look_timer_);
  inbox_.clear();
  sending_.clear();
  DeferredCallbacks deferred;
  if (tap_.is_open()) tap_.closed(*why_closed_);
  if (receiver_) receiver_->lost(*why_closed_, deferred);  // receiver_ stays until closed() is due
  std::shared_ptr<StreamConnection> self;
  bool must_post = false;
  std::unique_ptr<std::deque<Frame>> dropped;
  std::shared_ptr<ThreadShare> callbacks;
  {
    const MutexLock lock(mutex_);
    if (is_departed()) dropped = strand_.take_queue();
    callbacks = callback_threads_;
    self = std::move(self_);
    watch_.end();
    if (receiver_) strand_.owe_end();
    must_post = strand_.is_end_due() && !strand_.is_taken();
    if (must_post) strand_.orphan();
  }
  dropped.reset();
  for (const auto& share : {threads_, callbacks}) {
    if (!share) continue;
    share->depart();
    reactor_->reconsider();
  }
  if (layers_.carrier() != nullptr) layers_.carrier()->end();
  if (on_gone_) on_gone_(*this);
  if (must_post) deferred.emplace_back([keep = shared_from_this()] { keep->drain_posted(); });
  for (std::function<void()>& later : deferred) reactor_->post(std::move(later));
  if (self) reactor_->retire(std::move(self));
}

}  // namespace rr::channel
