// SPDX-License-Identifier: Apache-2.0
// Winsock has no flag for a single call that must not wait: all sockets here never wait, and a
// receive that may waits first. A socket is a handle of Windows, of which 32 bits count.
#include "runtime/cpp/src/platform/sockets.hpp"

#include "system_sockets.hpp"
// After it:
#include <windows.h>

#include <algorithm>
#include <array>

#include "errors.hpp"
#include "opened_socket.hpp"
#include "sids.hpp"

namespace rr::platform {
namespace {

constexpr int backlog = 1024;

// Begins the library, for as long as the process lives.
struct Winsock {
  Winsock() {
    WSADATA data{};
    WSAStartup(MAKEWORD(2, 2), &data);
  }
};
const Winsock winsock;

SOCKET system(int socket) { return static_cast<SOCKET>(socket); }
const sockaddr* system(const Address& address) {
  return reinterpret_cast<const sockaddr*>(address.bytes.data());
}
int size_of(const Address& address) { return static_cast<int>(address.size); }

template <class Value>
void set(int socket, int level, int name, Value value) {
  setsockopt(system(socket), level, name, reinterpret_cast<const char*>(&value), sizeof value);
}

// What a call that has failed means.
std::ptrdiff_t failure() { return WSAGetLastError() == WSAEWOULDBLOCK ? nothing_now : broken; }

// Of set_receive_timeout(); -1 for ever.
int patience_of(int socket) {
  DWORD milliseconds = 0;
  int size = sizeof milliseconds;
  getsockopt(system(socket), SOL_SOCKET, SO_RCVTIMEO, reinterpret_cast<char*>(&milliseconds),
             &size);
  return milliseconds == 0 ? -1 : static_cast<int>(milliseconds);
}

bool wait_for_input(int socket) {
  WSAPOLLFD wanted{system(socket), POLLRDNORM, 0};
  return WSAPoll(&wanted, 1, patience_of(socket)) != 0;
}

std::ptrdiff_t receive_now(int socket, std::span<std::byte> room) {
  constexpr std::size_t at_once = 1U << 30;
  const int size = ::recv(system(socket), reinterpret_cast<char*>(room.data()),
                          static_cast<int>(std::min(room.size(), at_once)), 0);
  return size >= 0 ? size : failure();
}

// `ask` is getsockname or getpeername.
template <class Ask>
Address address_of(int socket, Ask ask) {
  Address address;
  int size = sizeof address.bytes;
  if (ask(system(socket), reinterpret_cast<sockaddr*>(address.bytes.data()), &size) == 0) {
    address.size = static_cast<std::uint32_t>(size);
  }
  return address;
}

void never_wait(int socket) {
  u_long on = 1;
  ioctlsocket(system(socket), FIONBIO, &on);
}

}  // namespace

Descriptor open_socket(int family, int kind) {
  const SOCKET socket =
      WSASocketW(family, kind, 0, nullptr, 0, WSA_FLAG_OVERLAPPED | WSA_FLAG_NO_HANDLE_INHERIT);
  if (socket == INVALID_SOCKET) return {};
  Descriptor opened(static_cast<int>(socket));
  never_wait(opened.get());
  return opened;
}

Descriptor::~Descriptor() {
  if (number_ >= 0) closesocket(system(number_));
}

void close_socket(int socket) { closesocket(system(socket)); }

std::ptrdiff_t receive(int socket, std::span<std::byte> room, Wait wait) {
  std::size_t have = 0;
  while (true) {
    const std::ptrdiff_t size = receive_now(socket, room.subspan(have));
    if (size > 0) have += static_cast<std::size_t>(size);
    const bool is_done = have == room.size() || (have != 0 && wait != Wait::all);
    if (is_done || size == 0 || size == broken) {
      return have != 0 ? static_cast<std::ptrdiff_t>(have) : size;
    }
    if (size > 0) continue;
    if (wait == Wait::none || !wait_for_input(socket)) {
      return have != 0 ? static_cast<std::ptrdiff_t>(have) : nothing_now;
    }
  }
}

std::ptrdiff_t send(int socket, std::span<const std::byte> bytes) {
  const Buffer all{bytes.data(), bytes.size()};
  return send_gathered(socket, {&all, 1});
}

// Until there is no room: the poller tells of room only after a call that found none.
std::ptrdiff_t send_gathered(int socket, std::span<const Buffer> buffers) {
  std::array<WSABUF, 64> pieces;
  std::size_t count = 0;
  for (const Buffer& buffer : buffers.first(std::min(buffers.size(), pieces.size()))) {
    auto* const bytes = reinterpret_cast<char*>(const_cast<std::byte*>(buffer.data));
    pieces[count++] = {static_cast<ULONG>(buffer.size), bytes};
  }
  std::ptrdiff_t sent = 0;
  for (std::size_t first = 0; first != count;) {
    DWORD size = 0;
    if (WSASend(system(socket), &pieces[first], static_cast<DWORD>(count - first), &size, 0,
                nullptr, nullptr) != 0) {
      const std::ptrdiff_t result = failure();
      return result == nothing_now && sent != 0 ? sent : result;
    }
    sent += static_cast<std::ptrdiff_t>(size);
    while (first != count && size >= pieces[first].len) size -= pieces[first++].len;
    if (first == count) break;
    pieces[first].buf += size;
    pieces[first].len -= size;
  }
  return sent;
}

Connecting begin_connect(const Address& address, Descriptor& socket, std::error_code& error) {
  socket = open_socket(system(address)->sa_family, SOCK_STREAM);
  if (socket) {
    if (::connect(system(socket.get()), system(address), size_of(address)) == 0) {
      return Connecting::done;
    }
    if (WSAGetLastError() == WSAEWOULDBLOCK) return Connecting::begun;
  }
  error = last_socket_error();
  return Connecting::failed;
}

std::error_code connect_result(int socket) {
  int error = 0;
  int size = sizeof error;
  getsockopt(system(socket), SOL_SOCKET, SO_ERROR, reinterpret_cast<char*>(&error), &size);
  return error == 0 ? std::error_code() : system_error(static_cast<unsigned long>(error));
}

Descriptor listen_at(const Address& address, std::error_code& error) {
  const int family = system(address)->sa_family;
  Descriptor socket = open_socket(family, SOCK_STREAM);
  if (socket) {
    // A port that was used a moment ago is free by itself; this keeps others from sharing it.
    set(socket.get(), SOL_SOCKET, SO_EXCLUSIVEADDRUSE, BOOL{TRUE});
    if (family == AF_INET6) set(socket.get(), IPPROTO_IPV6, IPV6_V6ONLY, DWORD{1});
    if (::bind(system(socket.get()), system(address), size_of(address)) == 0 &&
        ::listen(system(socket.get()), backlog) == 0) {
      return socket;
    }
  }
  error = last_socket_error();
  return {};
}

Descriptor accept_one(int listening, std::error_code& error) {
  while (true) {
    const SOCKET accepted = ::accept(system(listening), nullptr, nullptr);
    if (accepted != INVALID_SOCKET) {
      // It has what the listening one had: the poller's interest, too.
      WSAEventSelect(accepted, nullptr, 0);
      never_wait(static_cast<int>(accepted));
      SetHandleInformation(reinterpret_cast<HANDLE>(accepted), HANDLE_FLAG_INHERIT, 0);
      return Descriptor(static_cast<int>(accepted));
    }
    if (WSAGetLastError() == WSAECONNRESET) continue;
    error = last_socket_error();
    return {};
  }
}

// Over the loopback interface. Somebody else's connection is not taken for the own one.
std::error_code make_pair(Descriptor& first, Descriptor& second) {
  std::error_code error;
  const IpAddress loopback = parse_ip("127.0.0.1").value();
  const Descriptor listener = listen_at(platform::address_of(loopback, 0), error);
  if (!listener) return error;
  if (begin_connect(local_address(listener.get()), first, error) == Connecting::failed) {
    return error;
  }
  constexpr int longest = 10'000;
  while (true) {
    WSAPOLLFD wanted{system(listener.get()), POLLRDNORM, 0};
    if (WSAPoll(&wanted, 1, longest) <= 0) return std::make_error_code(std::errc::timed_out);
    second = accept_one(listener.get(), error);
    if (!second) return error;
    if (remote_address(second.get()).port() == local_address(first.get()).port()) break;
  }
  set_stream_options(first.get());
  set_stream_options(second.get());
  return {};
}

void shut_down(int socket) { ::shutdown(system(socket), SD_BOTH); }
void shut_down_sending(int socket) { ::shutdown(system(socket), SD_SEND); }

std::optional<UserId> peer_user(int socket) {
  ULONG id = 0;
  DWORD size = 0;
  if (WSAIoctl(system(socket), SIO_AF_UNIX_GETPEERPID, nullptr, 0, &id, sizeof id, &size, nullptr,
               nullptr) != 0) {
    return std::nullopt;
  }
  const HANDLE process = OpenProcess(PROCESS_QUERY_LIMITED_INFORMATION, FALSE, id);
  if (process == nullptr) return std::nullopt;
  const auto user = user_of_process(process);
  CloseHandle(process);
  return user;
}

Address local_address(int socket) { return address_of(socket, ::getsockname); }
Address remote_address(int socket) { return address_of(socket, ::getpeername); }

void set_stream_options(int socket) { set(socket, IPPROTO_TCP, TCP_NODELAY, BOOL{TRUE}); }

void set_receive_timeout(int socket, std::chrono::milliseconds time) {
  set(socket, SOL_SOCKET, SO_RCVTIMEO, static_cast<DWORD>(time.count()));
}

// Windows delays acknowledgements by itself.
void acknowledge_with_next_segment(int /*socket*/) {}

}  // namespace rr::platform
