// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/channel/listening_socket.hpp"

#include <system_error>
#include <utility>

#include "rr/error.hpp"
#include "runtime/cpp/src/channel/accept.hpp"
#include "runtime/cpp/src/channel/logging.hpp"
#include "runtime/cpp/src/channel/metrics.hpp"

namespace rr::channel {
namespace {

// After a failure to accept, for want of descriptors, it is tried again.
constexpr Milliseconds accept_pause{20};
// So long a connection that gives way may take to release its descriptor.
constexpr Milliseconds giving_way{200};

// After so many at once others get their chance: who opens connections without end slows down
// nobody but those who connect.
constexpr int accepts_at_once = 16;

bool is_for_want_of_descriptors(const std::error_code& error) {
  return error == std::errc::too_many_files_open ||
         error == std::errc::too_many_files_open_in_system;
}

}  // namespace

ListeningSocket::ListeningSocket(ChannelContext context, Descriptor socket, LinkTerms terms,
                                 AcceptHandler accept)
    : context_(std::move(context)),
      socket_(std::move(socket)),
      terms_(std::move(terms)),
      accept_(std::move(accept)),
      spare_(platform::open_spare()) {}

ListeningSocket::~ListeningSocket() { context_.reactor->cancel(*this); }

void ListeningSocket::start() { context_.reactor->add(socket_.get(), ready::input, *this); }

void ListeningSocket::stop() {
  is_stopped_ = true;
  context_.reactor->remove(socket_.get());
  platform::shut_down(socket_.get());
  context_.reactor->retire(shared_from_this());
}

void ListeningSocket::on_ready(std::uint32_t /*events*/) {
  for (int left = accepts_at_once; !is_stopped_; --left) {
    if (left == 0) {
      ask_again();
      return;
    }
    if (!keep_spare()) {
      if (may_give_way()) context_.accepted->give_way();
      context_.reactor->schedule(*this, weak_from_this(), Clock::now() + accept_pause);
      return;
    }
    std::error_code error;
    Descriptor accepted = platform::accept_one(socket_.get(), error);
    if (accepted) {
      take(std::move(accepted));
      continue;
    }
    if (error == std::errc::operation_would_block || is_stopped_) return;
    if (is_for_want_of_descriptors(error) && take_with_spare()) {
      look_again();  // when the one that gave way has released its descriptor
    } else {
      context_.reactor->schedule(*this, weak_from_this(), Clock::now() + accept_pause);
    }
    return;
  }
}

bool ListeningSocket::keep_spare() {
  const MutexLock lock(mutex_);
  if (!spare_) spare_ = platform::open_spare();
  return static_cast<bool>(spare_);
}

// The descriptor of the one that gave way last may not be free yet.
bool ListeningSocket::may_give_way() {
  const MutexLock lock(mutex_);
  const Time now = Clock::now();
  if (now < gave_way_ + giving_way) return false;
  gave_way_ = now;
  return true;
}

// For want of descriptors. True when there may soon be one.
bool ListeningSocket::take_with_spare() {
  Descriptor accepted;
  {
    const MutexLock lock(mutex_);
    gave_way_ = Clock::now();
    spare_ = platform::File();
    std::error_code error;
    accepted = platform::accept_one(socket_.get(), error);
  }
  const bool has_room = context_.accepted->give_way();
  if (accepted && has_room) {
    take(std::move(accepted));
    return true;
  }
  context_.accepted->warn("a connection is refused: the process has no more file descriptors");
  accepted = Descriptor();
  return keep_spare();
}

// The reactor tells of those who are left once more, behind what else there is.
void ListeningSocket::ask_again() {
  try {
    context_.reactor->change(socket_.get(), ready::input, *this);
  } catch (const std::system_error&) {
    // It has been stopped.
  }
}

void ListeningSocket::on_timer() { look_again(); }

void ListeningSocket::look_again() {
  context_.reactor->post([self = shared_from_this()] { self->on_ready(ready::input); });
}

// Whoever may write to a private folder is still not its user.
bool ListeningSocket::is_welcome(const Descriptor& accepted) const {
  if (!terms_.only_user) return true;
  const auto client = platform::peer_user(accepted.get());
  if (client && (*client == *terms_.only_user || *client == platform::system_user)) return true;
  if (Metrics* const metrics = context_.reactor->metrics()) metrics->count_failed_handshake();
  const std::string user = client ? std::to_string(*client) : std::string("unknown");
  log(*context_.options, LogLevel::warning, "a local connection was refused: it is of user " + user,
      "uid " + user);
  return false;
}

void ListeningSocket::take(Descriptor accepted) {
  if (!is_welcome(accepted)) return;
  try {
    accept_connection(context_, std::move(accepted), terms_, nullptr, accept_);
  } catch (const std::exception&) {
    // It has been closed; who has connected finds that out.
  }
}

}  // namespace rr::channel
