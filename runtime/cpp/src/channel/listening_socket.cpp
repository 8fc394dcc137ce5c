// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/channel/listening_socket.hpp"

#include <sys/epoll.h>
#include <sys/socket.h>

#include <cerrno>
#include <utility>

#include "rr/error.hpp"
#include "runtime/cpp/src/channel/accept.hpp"

namespace rr::channel {
namespace {

// After a failure to accept, for want of descriptors, it is tried again.
constexpr Milliseconds accept_pause{100};

}  // namespace

ListeningSocket::ListeningSocket(Ground ground, Descriptor socket, LinkTerms terms,
                                 AcceptHandler accept)
    : ground_(std::move(ground)),
      socket_(std::move(socket)),
      terms_(std::move(terms)),
      accept_(std::move(accept)) {}

ListeningSocket::~ListeningSocket() { ground_.reactor->cancel(*this); }

void ListeningSocket::start() { ground_.reactor->add(socket_.get(), EPOLLIN, *this); }

void ListeningSocket::stop() {
  is_stopped_ = true;
  ground_.reactor->remove(socket_.get());
  ::shutdown(socket_.get(), SHUT_RDWR);
  ground_.reactor->retire(shared_from_this());
}

void ListeningSocket::on_ready(std::uint32_t /*events*/) {
  while (!is_stopped_) {
    Descriptor accepted(accept4(socket_.get(), nullptr, nullptr, SOCK_CLOEXEC));
    if (accepted) {
      take(std::move(accepted));
      continue;
    }
    if (errno == EINTR || errno == ECONNABORTED) continue;
    if (errno != EAGAIN && errno != EWOULDBLOCK && !is_stopped_) {
      ground_.reactor->schedule(*this, weak_from_this(), Clock::now() + accept_pause);
    }
    return;
  }
}

void ListeningSocket::on_timer() {
  ground_.reactor->post([self = shared_from_this()] { self->on_ready(EPOLLIN); });
}

void ListeningSocket::take(Descriptor accepted) {
  try {
    accept_connection(ground_, std::move(accepted), terms_, nullptr, accept_);
  } catch (const std::exception&) {
    // It has been closed; who has connected finds that out.
  }
}

}  // namespace rr::channel
