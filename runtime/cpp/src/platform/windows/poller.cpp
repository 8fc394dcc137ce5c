// SPDX-License-Identifier: Apache-2.0
// One event object stands for all sockets. What Winsock records for a socket it records once, until
// a call asks for it again: a receive for input, a send without room for room. That is what
// edge-triggered means here, and what WSAPoll(), which tells of everything again and again, does
// not have. Each wait looks at all sockets: good for hundreds of them, not for many thousands.
#include "runtime/cpp/src/platform/poller.hpp"

#include <algorithm>
#include <map>
#include <system_error>
#include <utility>

#include "errors.hpp"
#include "rr/mutex.hpp"
#include "system_sockets.hpp"

namespace rr::platform {
namespace {

// In Wine 8 an accept that finds nothing does not ask for the next connection to be recorded, so
// listening sockets are looked at this often as well.
constexpr DWORD look_period_ms = 200;

long interest_of(std::uint32_t events) {
  long interest = FD_CLOSE;
  if ((events & ready::input) != 0) interest |= FD_READ | FD_ACCEPT;
  if ((events & ready::room) != 0) interest |= FD_WRITE | FD_CONNECT;
  return interest;
}

std::uint32_t events_of(long recorded) {
  std::uint32_t events = 0;
  if ((recorded & (FD_READ | FD_ACCEPT)) != 0) events |= ready::input;
  if ((recorded & (FD_WRITE | FD_CONNECT)) != 0) events |= ready::room;
  if ((recorded & FD_CLOSE) != 0) events |= ready::input | ready::closing;
  return events;
}

// What is there already, asked beside the event object.
std::uint32_t present_at(int socket, std::uint32_t wanted) {
  WSAPOLLFD asked{static_cast<SOCKET>(socket), POLLRDNORM | POLLWRNORM, 0};
  if (WSAPoll(&asked, 1, 0) <= 0) return 0;
  std::uint32_t events = 0;
  if ((asked.revents & POLLRDNORM) != 0) events |= ready::input;
  if ((asked.revents & POLLWRNORM) != 0) events |= ready::room;
  events &= wanted;
  if ((asked.revents & (POLLHUP | POLLERR)) != 0) events |= ready::input | ready::closing;
  return events;
}

bool is_listening(int socket) {
  BOOL result = FALSE;
  int size = sizeof result;
  getsockopt(static_cast<SOCKET>(socket), SOL_SOCKET, SO_ACCEPTCONN,
             reinterpret_cast<char*>(&result), &size);
  return result != FALSE;
}

}  // namespace

struct Poller::System {
  struct Watched {
    std::uint32_t wanted = 0;
    std::uint32_t pending = 0;  // to be reported, whatever is recorded
    void* key = nullptr;
    bool is_listening = false;
  };

  void watch(int socket, std::uint32_t events, void* key, bool is_new);
  std::size_t collect(std::span<Event> events);
  void await_event();

  const HANDLE event = CreateEventW(nullptr, FALSE, FALSE, nullptr);
  Mutex mutex;
  std::map<int, Watched> sockets RR_GUARDED_BY(mutex);
  int last RR_GUARDED_BY(mutex) =
      -1;  // the socket that was reported last: the next one comes first
  bool is_woken RR_GUARDED_BY(mutex) = false;
};

void Poller::System::watch(int socket, std::uint32_t events, void* key, bool is_new) {
  const MutexLock lock(mutex);
  const auto place = sockets.find(socket);
  if ((place == sockets.end()) != is_new) {
    throw std::system_error(std::make_error_code(is_new ? std::errc::file_exists
                                                        : std::errc::no_such_file_or_directory),
                            "watching a socket");
  }
  if (WSAEventSelect(static_cast<SOCKET>(socket), event, interest_of(events)) != 0) {
    throw std::system_error(last_socket_error(), "watching a socket");
  }
  sockets[socket] = {events, present_at(socket, events), key, is_listening(socket)};
  SetEvent(event);
}

std::size_t Poller::System::collect(std::span<Event> events) {
  const MutexLock lock(mutex);
  std::size_t count = 0;
  if (is_woken && !events.empty()) {
    events[count++] = {nullptr, ready::input};
    is_woken = false;
  }
  auto each = sockets.upper_bound(last);
  for (std::size_t left = sockets.size(); left != 0; --left, ++each) {
    if (each == sockets.end()) each = sockets.begin();
    if (count == events.size()) {
      SetEvent(event);  // there may be more
      break;
    }
    WSANETWORKEVENTS recorded{};
    WSAEnumNetworkEvents(static_cast<SOCKET>(each->first), nullptr, &recorded);
    const std::uint32_t found =
        std::exchange(each->second.pending, 0) | events_of(recorded.lNetworkEvents);
    if (found == 0) continue;
    events[count++] = {each->second.key, found};
    last = each->first;
  }
  return count;
}

void Poller::System::await_event() {
  const auto listens = [](const auto& each) { return each.second.is_listening; };
  DWORD limit = INFINITE;
  {
    const MutexLock lock(mutex);
    if (std::ranges::any_of(sockets, listens)) limit = look_period_ms;
  }
  if (WaitForSingleObject(event, limit) != WAIT_TIMEOUT) return;
  const MutexLock lock(mutex);
  for (auto& [socket, watched] : sockets) {
    if (watched.is_listening) watched.pending |= present_at(socket, watched.wanted);
  }
}

Poller::Poller() : system_(std::make_unique<System>()) {
  if (system_->event == nullptr) throw std::system_error(last_system_error(), "CreateEvent");
}

Poller::~Poller() { CloseHandle(system_->event); }

void Poller::add(int socket, std::uint32_t events, void* key) {
  system_->watch(socket, events, key, true);
}

void Poller::change(int socket, std::uint32_t events, void* key) {
  system_->watch(socket, events, key, false);
}

void Poller::remove(int socket) {
  const MutexLock lock(system_->mutex);
  if (system_->sockets.erase(socket) != 0) {
    WSAEventSelect(static_cast<SOCKET>(socket), nullptr, 0);
  }
}

std::size_t Poller::wait(std::span<Event> events, bool may_wait) {
  while (true) {
    const std::size_t count = system_->collect(events);
    if (count != 0 || !may_wait) return count;
    system_->await_event();
  }
}

void Poller::wake() {
  {
    const MutexLock lock(system_->mutex);
    system_->is_woken = true;
  }
  SetEvent(system_->event);
}

}  // namespace rr::platform
