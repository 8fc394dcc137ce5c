// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/platform/waiting.hpp"

#include <algorithm>
#include <thread>
#include <vector>

#include "errors.hpp"
#include "opened_socket.hpp"
#include "system_sockets.hpp"

namespace rr::platform {
namespace {

// WSAPoll() of older versions does not tell of a connection that could not be made, so the sockets
// are asked this often.
constexpr std::chrono::milliseconds look_period{100};

short wanted_of(std::uint32_t events) {
  short wanted = 0;
  if ((events & (ready::input | ready::closing)) != 0) wanted |= POLLRDNORM;
  if ((events & ready::room) != 0) wanted |= POLLWRNORM;
  return wanted;
}

std::uint32_t found_of(short found) {
  std::uint32_t events = 0;
  if ((found & POLLRDNORM) != 0) events |= ready::input;
  if ((found & POLLWRNORM) != 0) events |= ready::room;
  if ((found & (POLLHUP | POLLERR | POLLNVAL)) != 0) events |= ready::end & ~ready::closing;
  return events;
}

// A connection that could not be made.
bool has_failed(SOCKET socket) {
  fd_set failed;
  FD_ZERO(&failed);
  FD_SET(socket, &failed);
  timeval at_once{};
  return select(0, nullptr, nullptr, &failed, &at_once) == 1;
}

bool find_failed(std::vector<WSAPOLLFD>& sockets) {
  bool is_found = false;
  for (WSAPOLLFD& each : sockets) {
    if ((each.events & POLLWRNORM) == 0 || !has_failed(each.fd)) continue;
    each.revents |= POLLERR;
    is_found = true;
  }
  return is_found;
}

int poll_once(std::vector<WSAPOLLFD>& sockets, std::chrono::milliseconds pause) {
  if (sockets.empty()) {
    std::this_thread::sleep_for(pause);
    return 0;
  }
  return WSAPoll(sockets.data(), static_cast<ULONG>(sockets.size()),
                 static_cast<int>(pause.count()));
}

// False at the deadline.
bool poll_until(std::vector<WSAPOLLFD>& sockets, Time deadline) {
  constexpr std::chrono::milliseconds none{0};
  while (true) {
    const bool is_endless = deadline == Time::max();
    const auto left = is_endless ? look_period
                                 : std::chrono::ceil<std::chrono::milliseconds>(
                                       deadline - std::chrono::steady_clock::now());
    const int found = poll_once(sockets, std::clamp(left, none, look_period));
    if (found > 0 || find_failed(sockets)) return true;
    if (found < 0 || (!is_endless && left <= look_period)) return false;
  }
}

}  // namespace

bool wait_for(int socket, std::uint32_t events, Time deadline) {
  Awaited wanted{socket, events};
  return wait_for_any({&wanted, 1}, deadline);
}

bool wait_for_any(std::span<Awaited> sockets, Time deadline) {
  std::vector<WSAPOLLFD> wanted;
  std::vector<Awaited*> asked;
  for (Awaited& each : sockets) {
    each.found = 0;
    if (each.socket < 0) continue;
    wanted.push_back({static_cast<SOCKET>(each.socket), wanted_of(each.wanted), 0});
    asked.push_back(&each);
  }
  const bool is_found = poll_until(wanted, deadline);
  for (std::size_t i = 0; i < wanted.size(); ++i) asked[i]->found = found_of(wanted[i].revents);
  return is_found;
}

// A socket of UDP that has sent itself something, which nobody takes.
Bell::Bell(std::error_code& error) : event_(open_socket(AF_INET, SOCK_DGRAM)) {
  const Address loopback = address_of(parse_ip("127.0.0.1").value(), 0);
  const auto socket = static_cast<SOCKET>(event_.get());
  const auto* const any = reinterpret_cast<const sockaddr*>(loopback.bytes.data());
  bool is_made = event_ && ::bind(socket, any, static_cast<int>(loopback.size)) == 0;
  if (is_made) {
    const Address own = local_address(event_.get());
    const auto* const to = reinterpret_cast<const sockaddr*>(own.bytes.data());
    is_made = ::connect(socket, to, static_cast<int>(own.size)) == 0;
  }
  if (!is_made) error = last_socket_error();
}

void Bell::ring() const {
  const char mark = 0;
  ::send(static_cast<SOCKET>(event_.get()), &mark, sizeof mark, 0);
}

}  // namespace rr::platform
