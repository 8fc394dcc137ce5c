// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/platform/sockets.hpp"

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <sys/uio.h>
#include <unistd.h>

#include <array>
#include <cerrno>

#include "runtime/cpp/src/platform/linux/system_calls.hpp"

namespace rr::platform {
namespace {

constexpr int backlog = 1024;

// Buffers are given to the kernel as they are.
static_assert(sizeof(Buffer) == sizeof(iovec) &&
              offsetof(Buffer, data) == offsetof(iovec, iov_base) &&
              offsetof(Buffer, size) == offsetof(iovec, iov_len));

template <class Value>
bool set(int socket, int level, int name, const Value& value) {
  return setsockopt(socket, level, name, &value, sizeof value) == 0;
}

// `ask` is getsockname or getpeername.
Address address_of(int socket, int (*ask)(int, sockaddr*, socklen_t*)) {
  Address address;
  socklen_t size = sizeof address.bytes;
  if (ask(socket, reinterpret_cast<sockaddr*>(address.bytes.data()), &size) == 0) {
    address.size = size;
  }
  return address;
}

}  // namespace

Descriptor::~Descriptor() {
  if (number_ >= 0) ::close(number_);
}

void close_socket(int socket) { ::close(socket); }

[[gnu::hot]] std::ptrdiff_t receive(int socket, std::span<std::byte> room, Wait wait) {
  int flags = wait == Wait::none ? MSG_DONTWAIT : 0;
  if (wait == Wait::all) flags = MSG_WAITALL;
  while (true) {
    const ssize_t size = ::recv(socket, room.data(), room.size(), flags);
    if (size >= 0) return size;
    if (errno != EINTR) return failed_transfer();
    if (wait != Wait::none) return nothing_now;
  }
}

[[gnu::hot]] std::ptrdiff_t send(int socket, std::span<const std::byte> bytes) {
  while (true) {
    const ssize_t size = ::send(socket, bytes.data(), bytes.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
    if (size >= 0) return size;
    if (errno != EINTR) return failed_transfer();
  }
}

std::ptrdiff_t send_gathered(int socket, std::span<const Buffer> buffers) {
  msghdr message{};
  message.msg_iov = reinterpret_cast<iovec*>(const_cast<Buffer*>(buffers.data()));
  message.msg_iovlen = buffers.size();
  while (true) {
    const ssize_t size = ::sendmsg(socket, &message, MSG_DONTWAIT | MSG_NOSIGNAL);
    if (size >= 0) return size;
    if (errno != EINTR) return failed_transfer();
  }
}

Connecting begin_connect(const Address& address, Descriptor& socket, std::error_code& error) {
  const int family = system(address)->sa_family;
  socket = Descriptor(::socket(family, SOCK_STREAM | SOCK_CLOEXEC, 0));
  if (!socket) {
    error = last_error();
    return Connecting::failed;
  }
  // The socket blocks, which connecting must not. Sending never does, so this may stay.
  set(socket.get(), SOL_SOCKET, SO_SNDTIMEO, timeval{0, 1});
  if (::connect(socket.get(), system(address), address.size) == 0) return Connecting::done;
  if (errno == EINPROGRESS || errno == EAGAIN || errno == EINTR) return Connecting::begun;
  error = last_error();
  return Connecting::failed;
}

std::error_code connect_result(int socket) {
  int error = 0;
  socklen_t size = sizeof error;
  getsockopt(socket, SOL_SOCKET, SO_ERROR, &error, &size);
  return {error, std::generic_category()};
}

Descriptor listen_at(const Address& address, std::error_code& error) {
  const int family = system(address)->sa_family;
  Descriptor socket(::socket(family, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  const int on = 1;
  bool is_listening = static_cast<bool>(socket);
  if (is_listening) set(socket.get(), SOL_SOCKET, SO_REUSEADDR, on);
  if (is_listening && family == AF_INET6) set(socket.get(), IPPROTO_IPV6, IPV6_V6ONLY, on);
  is_listening = is_listening && ::bind(socket.get(), system(address), address.size) == 0 &&
                 ::listen(socket.get(), backlog) == 0;
  if (is_listening) return socket;
  error = last_error();
  return {};
}

Descriptor accept_one(int listening, std::error_code& error) {
  while (true) {
    Descriptor accepted(::accept4(listening, nullptr, nullptr, SOCK_CLOEXEC));
    if (accepted) return accepted;
    if (errno == EINTR || errno == ECONNABORTED) continue;
    error = last_error();
    return {};
  }
}

std::error_code make_pair(Descriptor& first, Descriptor& second) {
  std::array<int, 2> ends{-1, -1};
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) return last_error();
  first = Descriptor(ends[0]);
  second = Descriptor(ends[1]);
  return {};
}

void shut_down(int socket) { ::shutdown(socket, SHUT_RDWR); }
void shut_down_sending(int socket) { ::shutdown(socket, SHUT_WR); }

std::optional<UserId> peer_user(int socket) {
  ucred peer{};
  socklen_t size = sizeof peer;
  if (getsockopt(socket, SOL_SOCKET, SO_PEERCRED, &peer, &size) != 0) return std::nullopt;
  return peer.uid;
}

Address local_address(int socket) { return address_of(socket, ::getsockname); }
Address remote_address(int socket) { return address_of(socket, ::getpeername); }

// No SO_LINGER: without it the kernel delivers what is left by itself, with it close() would block.
void set_stream_options(int socket) { set(socket, IPPROTO_TCP, TCP_NODELAY, 1); }

void set_receive_timeout(int socket, std::chrono::milliseconds time) {
  timeval pause{};
  pause.tv_sec = time.count() / 1000;
  pause.tv_usec = std::chrono::microseconds(time % std::chrono::seconds(1)).count();
  set(socket, SOL_SOCKET, SO_RCVTIMEO, pause);
}

void acknowledge_with_next_segment(int socket) { set(socket, IPPROTO_TCP, TCP_QUICKACK, 0); }

}  // namespace rr::platform
