// SPDX-License-Identifier: Apache-2.0
#include "packet_channel.hpp"

#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <condition_variable>
#include <cstddef>
#include <cstring>
#include <mutex>
#include <rr/error.hpp>
#include <thread>
#include <vector>

namespace {

struct Place {
  sockaddr_un address{};
  socklen_t size = 0;
};

// A name without a file.
Place place_of(const std::string& name) {
  Place place;
  const std::string whole = "packets." + name;
  if (name.empty() || whole.size() + 1 > sizeof place.address.sun_path) {
    throw rr::Error(rr::ErrorCode::invalid_argument, "`" + name + "` is no name for packets");
  }
  place.address.sun_family = AF_UNIX;
  std::memcpy(place.address.sun_path + 1, whole.data(), whole.size());
  place.size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + whole.size());
  return place;
}

const sockaddr* as_sockaddr(const Place& place) {
  return reinterpret_cast<const sockaddr*>(&place.address);
}

[[noreturn]] void fail(const std::string& what) {
  throw rr::Error(rr::ErrorCode::connection_error, what + ": " + std::strerror(errno));
}

// One socket, and a thread that waits for it. The thread has a share of what it uses, so that the
// link may go at any time, in the thread too.
class PacketLink final : public rr::MessageLink {
 public:
  explicit PacketLink(int socket) : shared_(std::make_shared<Shared>(socket)) {}
  ~PacketLink() override { PacketLink::close(); }

  void start(std::shared_ptr<rr::LinkUser> user) override {
    std::thread([shared = shared_, user = std::move(user)] { shared->run(*user); }).detach();
  }
  bool send(rr::MemoryRef /*owner*/, std::span<const std::byte> message) override {
    const ssize_t sent =
        ::send(shared_->socket, message.data(), message.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
    if (sent >= 0 || (errno != EAGAIN && errno != EWOULDBLOCK)) return true;
    shared_->wants_room = true;
    shared_->wake();
    return false;
  }
  void resume() override {
    shared_->is_refused = false;
    shared_->wake();
  }
  void close() override {
    shared_->has_ended = true;
    ::shutdown(shared_->socket, SHUT_RDWR);
    shared_->wake();
  }

 private:
  struct Shared {
    explicit Shared(int given) : socket(given), bell(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {}
    ~Shared() {
      ::close(socket);
      ::close(bell);
    }
    void wake() const {
      const std::uint64_t one = 1;
      [[maybe_unused]] const ssize_t written = ::write(bell, &one, sizeof one);
    }

    void run(rr::LinkUser& user) {
      std::vector<std::byte> packet(PacketChannel::limit);
      std::size_t held = 0;  // the size of a packet that the node could not take
      while (!has_ended) {
        pollfd wanted[2] = {{socket, 0, 0}, {bell, POLLIN, 0}};
        if (held == 0) wanted[0].events |= POLLIN;
        if (wants_room) wanted[0].events |= POLLOUT;
        if (::poll(wanted, 2, -1) < 0 && errno != EINTR) break;
        std::uint64_t rings = 0;
        [[maybe_unused]] const ssize_t drained = ::read(bell, &rings, sizeof rings);
        if ((wanted[0].revents & POLLOUT) != 0 && wants_room.exchange(false)) user.has_room();
        if (held == 0 && (wanted[0].revents & (POLLIN | POLLHUP | POLLERR)) != 0) {
          const ssize_t size = ::recv(socket, packet.data(), packet.size(), MSG_DONTWAIT);
          if (size < 0 && (errno == EAGAIN || errno == EINTR)) continue;
          if (size <= 0) break;
          held = static_cast<std::size_t>(size);
        }
        if (held == 0 || is_refused) continue;
        is_refused = true;  // before it is asked, so that resume() is not missed
        if (user.received(std::span(packet).first(held))) {
          is_refused = false;
          held = 0;
        }
      }
      user.ended();
    }

    const int socket;
    const int bell;
    std::atomic<bool> wants_room{false};
    std::atomic<bool> is_refused{false};
    std::atomic<bool> has_ended{false};
  };

  const std::shared_ptr<Shared> shared_;
};

class PacketListener final : public rr::LinkListener {
 public:
  PacketListener(int socket, std::string url,
                 std::function<void(std::unique_ptr<rr::MessageLink>)> accept)
      : socket_(socket), url_(std::move(url)), thread_([this, accept = std::move(accept)] {
          while (true) {
            const int accepted = ::accept4(socket_, nullptr, nullptr, SOCK_CLOEXEC);
            if (accepted < 0) return;
            accept(std::make_unique<PacketLink>(accepted));
          }
        }) {}
  ~PacketListener() override {
    ::shutdown(socket_, SHUT_RDWR);
    thread_.join();
    ::close(socket_);
  }
  std::vector<std::string> urls() const override { return {url_}; }

 private:
  const int socket_;
  const std::string url_;
  std::thread thread_;
};

}  // namespace

std::unique_ptr<rr::MessageLink> PacketChannel::connect(
    const rr::Url& url, std::chrono::steady_clock::time_point /*deadline*/) {
  const Place place = place_of(url.host);
  const int socket = ::socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0);
  if (socket < 0) fail("a socket");
  if (::connect(socket, as_sockaddr(place), place.size) != 0) {
    const int error = errno;
    ::close(socket);
    errno = error;
    fail("cannot connect to `" + url.host + "`");
  }
  return std::make_unique<PacketLink>(socket);
}

std::unique_ptr<rr::LinkListener> PacketChannel::listen(
    const rr::Url& url, std::function<void(std::unique_ptr<rr::MessageLink>)> accept) {
  const Place place = place_of(url.host);
  const int socket = ::socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0);
  if (socket < 0) fail("a socket");
  if (::bind(socket, as_sockaddr(place), place.size) != 0 || ::listen(socket, 16) != 0) {
    const int error = errno;
    ::close(socket);
    errno = error;
    fail("cannot listen at `" + url.host + "`");
  }
  return std::make_unique<PacketListener>(socket, "packets://" + url.host, std::move(accept));
}
