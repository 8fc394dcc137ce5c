// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/platform/poller.hpp"

#include <sys/epoll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <system_error>

#include "runtime/cpp/src/platform/sockets.hpp"

namespace rr::platform {
namespace {

static_assert(ready::input == EPOLLIN && ready::room == EPOLLOUT && ready::closing == EPOLLRDHUP &&
              ready::end == (EPOLLRDHUP | EPOLLHUP | EPOLLERR));

[[noreturn]] void fail(const char* what) {
  throw std::system_error(errno, std::generic_category(), what);
}

void control(int epoll, int operation, int socket, std::uint32_t events, void* key) {
  epoll_event event{};
  event.events = events | EPOLLET;
  event.data.ptr = key;
  if (epoll_ctl(epoll, operation, socket, &event) != 0) fail("epoll_ctl");
}

}  // namespace

struct Poller::System {
  Descriptor epoll;
  Descriptor wake_up;
};

Poller::Poller() : system_(std::make_unique<System>()) {
  system_->epoll = Descriptor(epoll_create1(EPOLL_CLOEXEC));
  if (!system_->epoll) fail("epoll_create1");
  system_->wake_up = Descriptor(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK));
  if (!system_->wake_up) fail("eventfd");
  // Edge-triggered, so it need not be read.
  add(system_->wake_up.get(), ready::input, nullptr);
}

Poller::~Poller() = default;

void Poller::add(int socket, std::uint32_t events, void* key) {
  control(system_->epoll.get(), EPOLL_CTL_ADD, socket, events, key);
}

void Poller::change(int socket, std::uint32_t events, void* key) {
  control(system_->epoll.get(), EPOLL_CTL_MOD, socket, events, key);
}

void Poller::remove(int socket) {
  epoll_event event{};
  epoll_ctl(system_->epoll.get(), EPOLL_CTL_DEL, socket, &event);
}

[[gnu::hot]] std::size_t Poller::wait(std::span<Event> events, bool may_wait) {
  std::array<epoll_event, most_events> found;
  const auto room = static_cast<int>(std::min(events.size(), found.size()));
  const int count = epoll_wait(system_->epoll.get(), found.data(), room, may_wait ? -1 : 0);
  for (int i = 0; i < count; ++i) {
    const epoll_event& event = found[static_cast<std::size_t>(i)];
    events[static_cast<std::size_t>(i)] = {event.data.ptr, event.events};
  }
  return count > 0 ? static_cast<std::size_t>(count) : 0;
}

void Poller::wake() {
  const std::uint64_t one = 1;
  // Can fail only when the counter is full, and then there is an event already.
  [[maybe_unused]] const ssize_t written = ::write(system_->wake_up.get(), &one, sizeof one);
}

}  // namespace rr::platform
