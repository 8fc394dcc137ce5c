// SPDX-License-Identifier: Apache-2.0
// Sockets, epoll, eventfd and poll of the C library, in a run: descriptors of a run belong to the
// simulated network, all others to the system.
#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/epoll.h>
#include <sys/eventfd.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <sys/uio.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdarg>
#include <cstring>
#include <memory>

#include "runtime/cpp/sim/clock.hpp"
#include "runtime/cpp/sim/faults.hpp"
#include "runtime/cpp/sim/network.hpp"
#include "runtime/cpp/sim/real.hpp"

namespace rr::sim {
namespace {

template <class Result>
Result given(Result result) {
  if (result >= 0) return result;
  errno = static_cast<int>(-result);
  return -1;
}

Nanoseconds after(Scheduler& run, Nanoseconds length) {
  return length >= never - run.now() ? never : run.now() + length;
}

std::uint16_t port_of(const sockaddr* address) {
  // The port is at the same place in both families.
  return ntohs(reinterpret_cast<const sockaddr_in*>(address)->sin_port);
}

void write_address(sa_family_t family, std::uint16_t port, sockaddr* address, socklen_t* size) {
  sockaddr_storage whole{};
  socklen_t length = sizeof(sockaddr_in);
  if (family == AF_INET6) {
    auto& its = reinterpret_cast<sockaddr_in6&>(whole);
    its.sin6_family = AF_INET6;
    its.sin6_port = htons(port);
    its.sin6_addr = in6addr_loopback;
    length = sizeof(sockaddr_in6);
  } else {
    auto& its = reinterpret_cast<sockaddr_in&>(whole);
    its.sin_family = AF_INET;
    its.sin_port = htons(port);
    its.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  }
  std::memcpy(address, &whole, std::min(length, *size));
  *size = length;
}

std::ptrdiff_t send(Scheduler& run, Stream& stream, std::span<const std::byte> bytes,
                    const void* caller) {
  run.point("send", &stream, static_cast<std::int64_t>(bytes.size()), caller);
  return stream.send(bytes);
}

std::ptrdiff_t receive(Scheduler& run, Stream& stream, std::span<std::byte> room, int flags,
                       const void* caller) {
  run.point("receive", &stream, static_cast<std::int64_t>(room.size()), caller);
  const bool may_wait = (flags & MSG_DONTWAIT) == 0 && stream.is_blocking;
  const Nanoseconds deadline = after(run, stream.receive_timeout);
  std::size_t done = 0;
  while (true) {
    const auto size = stream.receive(room.subspan(done), (flags & MSG_PEEK) != 0);
    if (size > 0) done += static_cast<std::size_t>(size);
    const bool has_enough = (flags & MSG_WAITALL) != 0 ? done == room.size() : done != 0;
    if (size == 0 || has_enough) return static_cast<std::ptrdiff_t>(done);
    if (size < 0 && (size != -EAGAIN || !may_wait)) {
      return done != 0 ? static_cast<std::ptrdiff_t>(done) : size;
    }
    if (size < 0 && !run.wait("bytes", any_file(), deadline, caller)) {
      return done != 0 ? static_cast<std::ptrdiff_t>(done) : -EAGAIN;
    }
  }
}

int poll(Scheduler& run, Network& network, std::span<pollfd> wanted, Nanoseconds deadline,
         const void* caller) {
  run.point("poll", nullptr, static_cast<std::int64_t>(wanted.size()), caller);
  while (true) {
    int count = 0;
    for (pollfd& each : wanted) {
      each.revents = 0;
      if (each.fd < 0) continue;
      const auto file = network.find(each.fd);
      const auto events = static_cast<std::uint32_t>(each.events) | POLLHUP | POLLERR;
      each.revents = static_cast<short>(file ? file->ready() & events : POLLNVAL);
      if (each.revents != 0) ++count;
    }
    if (count != 0 || deadline <= run.now()) return count;
    run.wait("a socket", any_file(), deadline, caller);
  }
}

Nanoseconds timeout_of(const void* value) {
  const auto& time = *static_cast<const timeval*>(value);
  const Nanoseconds length = time.tv_sec * 1'000'000'000 + time.tv_usec * 1'000;
  return length == 0 ? never : length;
}

int set_option(Network& network, int descriptor, int level, int name, const void* value) {
  if (level != SOL_SOCKET) return 0;
  if (const auto stream = network.find_as<Stream>(descriptor)) {
    if (name == SO_RCVTIMEO) stream->receive_timeout = timeout_of(value);
    if (name == SO_SNDTIMEO) stream->send_timeout = timeout_of(value);
    if (name == SO_LINGER) {
      const auto& linger_at_close = *static_cast<const linger*>(value);
      stream->resets_at_close = linger_at_close.l_onoff != 0 && linger_at_close.l_linger == 0;
    }
  }
  return 0;
}

// A run's descriptor and the run; empty outside of one and for descriptors of the system.
struct Use {
  explicit Use(int descriptor)
      : run(Scheduler::current()),
        network(run == nullptr ? nullptr : Network::current()),
        file(network == nullptr ? nullptr : network->find(descriptor)) {}
  explicit operator bool() const { return file != nullptr; }
  template <class Kind>
  [[nodiscard]] std::shared_ptr<Kind> as() const {
    return std::dynamic_pointer_cast<Kind>(file);
  }
  Spared spared;
  Scheduler* run;
  Network* network;
  std::shared_ptr<File> file;
};

// Whether all of these are the run's, or none at all. Apart from poll(), whose declaration says
// that it writes only.
[[gnu::noinline]] bool are_of_a_run(const pollfd* wanted, nfds_t count) {
  const Network* const network = Scheduler::current() == nullptr ? nullptr : Network::current();
  return network != nullptr && std::all_of(wanted, wanted + count, [&](const pollfd& each) {
           return each.fd < 0 || network->find(each.fd) != nullptr;
         });
}

}  // namespace
}  // namespace rr::sim

using rr::sim::Datagrams;
using rr::sim::Epoll;
using rr::sim::given;
using rr::sim::Listener;
using rr::sim::Nanoseconds;
using rr::sim::Network;
using rr::sim::never;
using rr::sim::Real;
using rr::sim::Scheduler;
using rr::sim::Stream;
using rr::sim::Unbound;
using rr::sim::Use;

#define RR_CALLER __builtin_return_address(0)

extern "C" {

int socket(int family, int type, int protocol) noexcept {
  const rr::sim::Spared spared;
  Network* const network = Scheduler::current() == nullptr ? nullptr : Network::current();
  const int kind = type & ~(SOCK_CLOEXEC | SOCK_NONBLOCK);
  if (network == nullptr || family == AF_NETLINK) {
    static constinit Real<int(int, int, int)> call{"socket"};
    return call(family, type, protocol);
  }
  if (family != AF_INET && family != AF_INET6) return given(-EAFNOSUPPORT);
  if (kind == SOCK_DGRAM) {
    auto datagrams = std::make_shared<Datagrams>(network->run());
    datagrams->family = static_cast<sa_family_t>(family);
    return network->open(std::move(datagrams));
  }
  if (kind != SOCK_STREAM) return given(-EPROTONOSUPPORT);
  auto socket = std::make_shared<Unbound>(network->run());
  socket->family = static_cast<sa_family_t>(family);
  socket->is_blocking = (type & SOCK_NONBLOCK) == 0;
  return network->open(std::move(socket));
}

int socketpair(int family, int type, int protocol, int* ends) noexcept {
  const rr::sim::Spared spared;
  Network* const network = Scheduler::current() == nullptr ? nullptr : Network::current();
  if (network == nullptr) {
    static constinit Real<int(int, int, int, int*)> call{"socketpair"};
    return call(family, type, protocol, ends);
  }
  auto first = std::make_shared<Stream>(network->run());
  auto second = std::make_shared<Stream>(network->run());
  first->family = second->family = AF_UNIX;
  Stream::join(first, second);
  ends[0] = network->open(std::move(first));
  ends[1] = network->open(std::move(second));
  return 0;
}

int bind(int descriptor, const sockaddr* address, socklen_t size) noexcept {
  const Use use(descriptor);
  if (!use) {
    static constinit Real<int(int, const sockaddr*, socklen_t)> call{"bind"};
    return call(descriptor, address, size);
  }
  if (const auto datagrams = use.as<Datagrams>()) {
    use.network->place(*datagrams, rr::sim::port_of(address));
    return 0;
  }
  const auto socket = use.as<Unbound>();
  return given(socket ? use.network->bind(*socket, rr::sim::port_of(address)) : -EINVAL);
}

int listen(int descriptor, int backlog) noexcept {
  const Use use(descriptor);
  if (!use) {
    static constinit Real<int(int, int)> call{"listen"};
    return call(descriptor, backlog);
  }
  return given(use.network->listen(descriptor));
}

int connect(int descriptor, const sockaddr* address, socklen_t size) {
  const Use use(descriptor);
  if (!use) {
    static constinit Real<int(int, const sockaddr*, socklen_t)> call{"connect"};
    return call(descriptor, address, size);
  }
  use.run->point("connect", nullptr, rr::sim::port_of(address), RR_CALLER);
  return given(use.network->connect(descriptor, rr::sim::port_of(address)));
}

int accept4(int descriptor, sockaddr* __restrict address, socklen_t* __restrict size, int flags) {
  const Use use(descriptor);
  if (!use) {
    static constinit Real<int(int, sockaddr*, socklen_t*, int)> call{"accept4"};
    return call(descriptor, address, size, flags);
  }
  use.run->point("accept", use.file.get(), descriptor, RR_CALLER);
  const auto listener = use.as<Listener>();
  if (!listener) return given(-EINVAL);
  auto stream = listener->take();
  if (!stream) return given(-EAGAIN);
  stream->is_blocking = (flags & SOCK_NONBLOCK) == 0;
  if (address != nullptr) {
    rr::sim::write_address(stream->family, stream->remote_port, address, size);
  }
  return use.network->open(std::move(stream));
}

ssize_t recv(int descriptor, void* room, size_t size, int flags) {
  const Use use(descriptor);
  if (!use) {
    static constinit Real<ssize_t(int, void*, size_t, int)> call{"recv"};
    return call(descriptor, room, size, flags);
  }
  if (const auto datagrams = use.as<Datagrams>()) {
    std::uint16_t sender = 0;
    return given(
        datagrams->receive({static_cast<std::byte*>(room), size}, (flags & MSG_PEEK) != 0, sender));
  }
  const auto stream = use.as<Stream>();
  if (!stream) return given<ssize_t>(-ENOTCONN);
  return given(
      rr::sim::receive(*use.run, *stream, {static_cast<std::byte*>(room), size}, flags, RR_CALLER));
}

ssize_t send(int descriptor, const void* bytes, size_t size, int flags) {
  const Use use(descriptor);
  if (!use) {
    static constinit Real<ssize_t(int, const void*, size_t, int)> call{"send"};
    return call(descriptor, bytes, size, flags);
  }
  const auto stream = use.as<Stream>();
  if (!stream) return given<ssize_t>(-ENOTCONN);
  return given(
      rr::sim::send(*use.run, *stream, {static_cast<const std::byte*>(bytes), size}, RR_CALLER));
}

ssize_t recvfrom(int descriptor, void* __restrict room, size_t size, int flags,
                 sockaddr* __restrict address, socklen_t* __restrict length) {
  const Use use(descriptor);
  if (!use) {
    static constinit Real<ssize_t(int, void*, size_t, int, sockaddr*, socklen_t*)> call{"recvfrom"};
    return call(descriptor, room, size, flags, address, length);
  }
  const auto datagrams = use.as<Datagrams>();
  if (!datagrams) return recv(descriptor, room, size, flags);
  use.run->point("receive", datagrams.get(), descriptor, RR_CALLER);
  std::uint16_t sender = 0;
  const auto received =
      datagrams->receive({static_cast<std::byte*>(room), size}, (flags & MSG_PEEK) != 0, sender);
  if (received >= 0 && address != nullptr) {
    rr::sim::write_address(datagrams->family, sender, address, length);
  }
  return given(received);
}

ssize_t sendto(int descriptor, const void* bytes, size_t size, int flags, const sockaddr* address,
               socklen_t length) {
  const Use use(descriptor);
  if (!use) {
    static constinit Real<ssize_t(int, const void*, size_t, int, const sockaddr*, socklen_t)> call{
        "sendto"};
    return call(descriptor, bytes, size, flags, address, length);
  }
  const auto datagrams = use.as<Datagrams>();
  if (!datagrams) return send(descriptor, bytes, size, flags);
  use.run->point("send", datagrams.get(), static_cast<std::int64_t>(size), RR_CALLER);
  if (datagrams->port == 0) use.network->place(*datagrams, 0);
  use.network->send_to_all(*datagrams, rr::sim::port_of(address),
                           {static_cast<const std::byte*>(bytes), size});
  return static_cast<ssize_t>(size);
}

ssize_t sendmsg(int descriptor, const msghdr* message, int flags) {
  const Use use(descriptor);
  if (!use) {
    static constinit Real<ssize_t(int, const msghdr*, int)> call{"sendmsg"};
    return call(descriptor, message, flags);
  }
  const auto stream = use.as<Stream>();
  if (!stream) return given<ssize_t>(-ENOTCONN);
  std::vector<std::byte> whole;
  for (std::size_t i = 0; i < message->msg_iovlen; ++i) {
    const auto* const first = static_cast<const std::byte*>(message->msg_iov[i].iov_base);
    whole.insert(whole.end(), first, first + message->msg_iov[i].iov_len);
  }
  return given(rr::sim::send(*use.run, *stream, whole, RR_CALLER));
}

int shutdown(int descriptor, int how) noexcept {
  const Use use(descriptor);
  if (!use) {
    static constinit Real<int(int, int)> call{"shutdown"};
    return call(descriptor, how);
  }
  use.run->point("shut down", use.file.get(), how, RR_CALLER);
  if (const auto stream = use.as<Stream>()) {
    stream->shut_down(how != SHUT_WR, how != SHUT_RD);
  }
  return 0;
}

int close(int descriptor) {
  const Use use(descriptor);
  if (!use) {
    static constinit Real<int(int)> call{"close"};
    return call(descriptor);
  }
  use.run->point("close", use.file.get(), descriptor, RR_CALLER);
  if (!use.network->close(descriptor)) use.run->fail("a descriptor is closed twice");
  return 0;
}

ssize_t read(int descriptor, void* room, size_t size) {
  const Use use(descriptor);
  if (!use) {
    static constinit Real<ssize_t(int, void*, size_t)> call{"read"};
    return call(descriptor, room, size);
  }
  if (const auto event = use.as<rr::sim::Event>()) {
    if (!event->take()) return given<ssize_t>(-EAGAIN);
    const std::uint64_t one = 1;
    std::memcpy(room, &one, sizeof one);
    return sizeof one;
  }
  return recv(descriptor, room, size, 0);
}

ssize_t write(int descriptor, const void* bytes, size_t size) {
  const Use use(descriptor);
  if (!use) {
    static constinit Real<ssize_t(int, const void*, size_t)> call{"write"};
    return call(descriptor, bytes, size);
  }
  if (const auto event = use.as<rr::sim::Event>()) {
    event->set();
    use.run->point("ring", event.get(), descriptor, RR_CALLER);
    return static_cast<ssize_t>(size);
  }
  return send(descriptor, bytes, size, 0);
}

int eventfd(unsigned int value, int flags) noexcept {
  const rr::sim::Spared spared;
  Network* const network = Scheduler::current() == nullptr ? nullptr : Network::current();
  if (network == nullptr) {
    static constinit Real<int(unsigned int, int)> call{"eventfd"};
    return call(value, flags);
  }
  return network->open(std::make_shared<rr::sim::Event>(network->run()));
}

int eventfd_write(int descriptor, eventfd_t value) {
  return write(descriptor, &value, sizeof value) == sizeof value ? 0 : -1;
}

int epoll_create1(int flags) noexcept {
  const rr::sim::Spared spared;
  Network* const network = Scheduler::current() == nullptr ? nullptr : Network::current();
  if (network == nullptr) {
    static constinit Real<int(int)> call{"epoll_create1"};
    return call(flags);
  }
  return network->open(std::make_shared<Epoll>(network->run()));
}

int epoll_ctl(int descriptor, int operation, int watched, epoll_event* event) noexcept {
  const Use use(descriptor);
  if (!use) {
    static constinit Real<int(int, int, int, epoll_event*)> call{"epoll_ctl"};
    return call(descriptor, operation, watched, event);
  }
  const auto epoll = use.as<Epoll>();
  const auto file = use.network->find(watched);
  if (!epoll || !file) return given(-EBADF);
  return given(epoll->change(operation, file, event));
}

int epoll_wait(int descriptor, epoll_event* events, int most, int timeout) {
  const Use use(descriptor);
  if (!use) {
    static constinit Real<int(int, epoll_event*, int, int)> call{"epoll_wait"};
    return call(descriptor, events, most, timeout);
  }
  const Nanoseconds deadline =
      timeout < 0 ? never : use.run->now() + Nanoseconds{timeout} * 1'000'000;
  return use.as<Epoll>()->wait({events, static_cast<std::size_t>(most)}, deadline, RR_CALLER);
}

int poll(pollfd* wanted, nfds_t count, int timeout) {
  const rr::sim::Spared spared;
  if (!rr::sim::are_of_a_run(wanted, count)) {
    static constinit Real<int(pollfd*, nfds_t, int)> call{"poll"};
    return call(wanted, count, timeout);
  }
  Scheduler& run = *Scheduler::current();
  const Nanoseconds deadline = timeout < 0 ? never : run.now() + Nanoseconds{timeout} * 1'000'000;
  return rr::sim::poll(run, *Network::current(), {wanted, count}, deadline, RR_CALLER);
}

int setsockopt(int descriptor, int level, int name, const void* value, socklen_t size) noexcept {
  const Use use(descriptor);
  if (!use) {
    static constinit Real<int(int, int, int, const void*, socklen_t)> call{"setsockopt"};
    return call(descriptor, level, name, value, size);
  }
  return rr::sim::set_option(*use.network, descriptor, level, name, value);
}

int getsockopt(int descriptor, int level, int name, void* __restrict value,
               socklen_t* __restrict size) noexcept {
  const Use use(descriptor);
  if (!use) {
    static constinit Real<int(int, int, int, void*, socklen_t*)> call{"getsockopt"};
    return call(descriptor, level, name, value, size);
  }
  const auto stream = use.as<Stream>();
  if (level != SOL_SOCKET || name != SO_ERROR || !stream) return given(-ENOPROTOOPT);
  const int error = stream->take_error();
  std::memcpy(value, &error, sizeof error);
  return 0;
}

int getsockname(int descriptor, sockaddr* __restrict address, socklen_t* __restrict size) noexcept {
  const Use use(descriptor);
  if (!use) {
    static constinit Real<int(int, sockaddr*, socklen_t*)> call{"getsockname"};
    return call(descriptor, address, size);
  }
  if (const auto stream = use.as<Stream>()) {
    rr::sim::write_address(stream->family, stream->local_port, address, size);
  } else if (const auto listener = use.as<Listener>()) {
    rr::sim::write_address(listener->family, listener->port, address, size);
  } else if (const auto datagrams = use.as<Datagrams>()) {
    rr::sim::write_address(datagrams->family, datagrams->port, address, size);
  } else if (const auto socket = use.as<Unbound>()) {
    rr::sim::write_address(socket->family, socket->port, address, size);
  }
  return 0;
}

int getpeername(int descriptor, sockaddr* __restrict address, socklen_t* __restrict size) noexcept {
  const Use use(descriptor);
  if (!use) {
    static constinit Real<int(int, sockaddr*, socklen_t*)> call{"getpeername"};
    return call(descriptor, address, size);
  }
  const auto stream = use.as<Stream>();
  if (!stream || stream->is_connecting()) return given(-ENOTCONN);
  rr::sim::write_address(stream->family, stream->remote_port, address, size);
  return 0;
}
}
