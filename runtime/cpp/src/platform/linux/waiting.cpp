// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/platform/waiting.hpp"

#include <poll.h>
#include <sys/eventfd.h>

#include <algorithm>
#include <cerrno>
#include <vector>

namespace rr::platform {
namespace {

static_assert(ready::input == POLLIN && ready::room == POLLOUT);

// For poll(): rounded up, -1 for never.
int milliseconds_until(Time deadline) {
  if (deadline == Time::max()) return -1;
  const auto left =
      std::chrono::ceil<std::chrono::milliseconds>(deadline - std::chrono::steady_clock::now())
          .count();
  return static_cast<int>(std::clamp<std::int64_t>(left, 0, 1'000'000'000));
}

// False at the deadline.
bool poll_until(pollfd* first, std::size_t count, Time deadline) {
  while (true) {
    const int found = ::poll(first, count, milliseconds_until(deadline));
    if (found > 0) return true;
    if (found == 0 || errno != EINTR) return false;
  }
}

}  // namespace

bool wait_for(int socket, std::uint32_t events, Time deadline) {
  pollfd wait{socket, static_cast<short>(events), 0};
  return poll_until(&wait, 1, deadline);
}

bool wait_for_any(std::span<Awaited> sockets, Time deadline) {
  std::vector<pollfd> wanted;
  for (const Awaited& each : sockets) {
    wanted.push_back({each.socket, static_cast<short>(each.wanted), 0});
  }
  const bool is_found = poll_until(wanted.data(), wanted.size(), deadline);
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    sockets[i].found = static_cast<std::uint32_t>(wanted[i].revents);
  }
  return is_found;
}

Bell::Bell(std::error_code& error) : event_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  if (!event_) error = {errno, std::generic_category()};
}

void Bell::ring() const { ::eventfd_write(event_.get(), 1); }

}  // namespace rr::platform
