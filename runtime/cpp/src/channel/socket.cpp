// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/channel/socket.hpp"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <memory>
#include <set>

#include "rr/error.hpp"

namespace rr::channel {
namespace {

sockaddr_in& as_v4(sockaddr_storage& storage) { return reinterpret_cast<sockaddr_in&>(storage); }
sockaddr_in6& as_v6(sockaddr_storage& storage) { return reinterpret_cast<sockaddr_in6&>(storage); }
const sockaddr_in& as_v4(const sockaddr_storage& storage) {
  return reinterpret_cast<const sockaddr_in&>(storage);
}
const sockaddr_in6& as_v6(const sockaddr_storage& storage) {
  return reinterpret_cast<const sockaddr_in6&>(storage);
}

std::vector<Address> look_up(const std::string& host, int flags) {
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  hints.ai_flags = flags;
  addrinfo* found = nullptr;
  const int status = getaddrinfo(host.empty() ? nullptr : host.c_str(), "0", &hints, &found);
  if (status != 0) return {};
  const std::unique_ptr<addrinfo, decltype(&freeaddrinfo)> owner(found, &freeaddrinfo);
  std::vector<Address> addresses;
  for (const addrinfo* item = found; item != nullptr; item = item->ai_next) {
    if (item->ai_family != AF_INET && item->ai_family != AF_INET6) continue;
    Address address;
    std::memcpy(&address.storage, item->ai_addr, item->ai_addrlen);
    address.size = item->ai_addrlen;
    addresses.push_back(address);
  }
  return addresses;
}

// One address for each interface that is up, for a link-local address that names none.
std::vector<Address> with_each_scope(const Address& address) {
  ifaddrs* found = nullptr;
  if (getifaddrs(&found) != 0) return {address};
  const std::unique_ptr<ifaddrs, decltype(&freeifaddrs)> owner(found, &freeifaddrs);
  std::set<unsigned> scopes;
  for (const ifaddrs* item = found; item != nullptr; item = item->ifa_next) {
    if (item->ifa_addr != nullptr && item->ifa_addr->sa_family == AF_INET6 &&
        (item->ifa_flags & IFF_UP) != 0) {
      scopes.insert(if_nametoindex(item->ifa_name));
    }
  }
  std::vector<Address> addresses;
  for (const unsigned scope : scopes) {
    addresses.push_back(address);
    as_v6(addresses.back().storage).sin6_scope_id = scope;
  }
  return addresses;
}

bool lacks_scope(const Address& address) {
  if (address.family() != AF_INET6) return false;
  const sockaddr_in6& v6 = as_v6(address.storage);
  return IN6_IS_ADDR_LINKLOCAL(&v6.sin6_addr) && v6.sin6_scope_id == 0;
}

}  // namespace

Descriptor::~Descriptor() {
  if (number_ >= 0) ::close(number_);
}

std::uint16_t Address::port() const {
  return ntohs(family() == AF_INET6 ? as_v6(storage).sin6_port : as_v4(storage).sin_port);
}

void Address::set_port(std::uint16_t port) {
  if (family() == AF_INET6) {
    as_v6(storage).sin6_port = htons(port);
  } else {
    as_v4(storage).sin_port = htons(port);
  }
}

std::string Address::text() const {
  if (family() == AF_UNIX) return reinterpret_cast<const sockaddr_un&>(storage).sun_path;
  std::array<char, NI_MAXHOST> host{};
  if (getnameinfo(reinterpret_cast<const sockaddr*>(&storage), size, host.data(), host.size(),
                  nullptr, 0, NI_NUMERICHOST) != 0) {
    return {};
  }
  const std::string port_text = ":" + std::to_string(port());
  if (family() == AF_INET6) return "[" + std::string(host.data()) + "]" + port_text;
  return host.data() + port_text;
}

std::vector<Address> resolve(const std::string& host, std::uint16_t port) {
  // Digits first: they need no name server, whose configuration would be read otherwise.
  std::vector<Address> found = look_up(host, AI_NUMERICHOST);
  if (found.empty()) found = look_up(host, AI_ADDRCONFIG);
  // Without any interface but the loopback there is no configured family for `localhost`.
  if (found.empty()) found = look_up(host, 0);
  if (found.empty()) {
    throw Error(ErrorCode::connection_error, "cannot find the host `" + host + "`");
  }
  std::vector<Address> addresses;
  for (Address& address : found) {
    address.set_port(port);
    if (lacks_scope(address)) {
      const std::vector<Address> scoped = with_each_scope(address);
      addresses.insert(addresses.end(), scoped.begin(), scoped.end());
    } else {
      addresses.push_back(address);
    }
  }
  return addresses;
}

std::vector<Address> resolve_for_listening(const std::string& host, std::uint16_t port) {
  const bool is_any = host.empty() || host == "*";
  const bool is_own = host == "localhost";  // which needs nobody to look it up
  std::vector<Address> addresses = is_any || is_own
                                       ? look_up({}, AI_NUMERICHOST | (is_any ? AI_PASSIVE : 0))
                                       : resolve(host, port);
  for (Address& address : addresses) address.set_port(port);
  return addresses;
}

std::string url_of(const Address& address, std::string_view scheme) {
  if (address.size == 0 || address.family() == AF_UNIX) return {};
  return std::string(scheme) + "://" + address.text();
}

namespace {

// `ask` is getsockname or getpeername.
Address address_of(int descriptor, int (*ask)(int, sockaddr*, socklen_t*)) {
  Address address;
  address.size = sizeof address.storage;
  if (ask(descriptor, reinterpret_cast<sockaddr*>(&address.storage), &address.size) != 0) {
    address.size = 0;
  }
  return address;
}

}  // namespace

std::optional<uid_t> peer_user(int descriptor) {
  ucred peer{};
  socklen_t size = sizeof peer;
  if (getsockopt(descriptor, SOL_SOCKET, SO_PEERCRED, &peer, &size) != 0) return std::nullopt;
  return peer.uid;
}

Address local_address(int descriptor) {
  return address_of(descriptor, [](int each, sockaddr* address, socklen_t* size) {
    return getsockname(each, address, size);
  });
}

Address remote_address(int descriptor) {
  return address_of(descriptor, [](int each, sockaddr* address, socklen_t* size) {
    return getpeername(each, address, size);
  });
}

void set_stream_options(int descriptor) {
  const int on = 1;
  setsockopt(descriptor, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
  // No SO_LINGER: without it the kernel delivers what is left by itself, with it close() would
  // block.
}

int poll_milliseconds(Time deadline) {
  if (deadline == never) return -1;
  const auto left = std::chrono::ceil<Milliseconds>(deadline - Clock::now()).count();
  return static_cast<int>(std::clamp<std::int64_t>(left, 0, 1'000'000'000));
}

bool wait_for(int descriptor, short events, Time deadline) {
  pollfd wait{descriptor, events, 0};
  while (true) {
    const int found = poll(&wait, 1, poll_milliseconds(deadline));
    if (found > 0) return true;
    if (found == 0 || errno != EINTR) return false;
  }
}

void set_receive_timeout(int descriptor, Milliseconds time) {
  timeval pause{};
  pause.tv_sec = time.count() / 1000;
  pause.tv_usec = std::chrono::microseconds(time % std::chrono::seconds(1)).count();
  setsockopt(descriptor, SOL_SOCKET, SO_RCVTIMEO, &pause, sizeof pause);
}

void acknowledge_with_next_segment(int descriptor) {
  const int at_once = 0;
  setsockopt(descriptor, IPPROTO_TCP, TCP_QUICKACK, &at_once, sizeof at_once);
}

}  // namespace rr::channel
