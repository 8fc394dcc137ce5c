// SPDX-License-Identifier: Apache-2.0
// The other side of the C# benchmark, in C++:
//   csharp_bench_peer serve              serves the arm, and blocks over a plain socket; prints URL
//                                        and port
//   csharp_bench_peer measure URL PORT   measures itself as the C# program does; prints seconds: a
//                                        get, an array there and back, to the service, from it, and
//                                        the same three over the plain socket
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <iostream>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "experimental/arm.hpp"
#include "rr/node.hpp"

namespace {

namespace a = experimental::arm;
using Clock = std::chrono::steady_clock;

constexpr int get_count = 3000;
constexpr int array_count = 10;
constexpr std::size_t array_bytes = 10'000'000;

void check(bool holds) {
  if (!holds) throw std::runtime_error(std::strerror(errno));
}

void read_all(int socket, void* to, std::size_t size) {
  for (auto* at = static_cast<char*>(to); size != 0;) {
    const ssize_t got = recv(socket, at, size, 0);
    check(got > 0);
    at += got;
    size -= static_cast<std::size_t>(got);
  }
}
void write_all(int socket, const void* from, std::size_t size) {
  for (const auto* at = static_cast<const char*>(from); size != 0;) {
    const ssize_t put = send(socket, at, size, MSG_NOSIGNAL);
    check(put > 0);
    at += put;
    size -= static_cast<std::size_t>(put);
  }
}

sockaddr_in loopback(std::uint16_t port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  return address;
}

/// What a client of RawBlocks says first: how much it sends, and how much it wants.
struct Sizes {
  std::uint64_t sent;
  std::uint64_t wanted;
};

/// Takes blocks and gives blocks, to one client after the other.
class RawBlocks {
 public:
  RawBlocks() : listener_(socket(AF_INET, SOCK_STREAM, 0)) {
    if (listener_ < 0) throw std::runtime_error(std::strerror(errno));
    sockaddr_in address = loopback(0);
    socklen_t size = sizeof address;
    check(bind(listener_, reinterpret_cast<sockaddr*>(&address), size) == 0);
    check(listen(listener_, 4) == 0);
    check(getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size) == 0);
    port_ = ntohs(address.sin_port);
    thread_ = std::thread([this] { serve(); });
  }
  RawBlocks(const RawBlocks&) = delete;
  RawBlocks& operator=(const RawBlocks&) = delete;
  ~RawBlocks() {
    shutdown(listener_, SHUT_RDWR);
    thread_.join();
    close(listener_);
  }
  [[nodiscard]] std::uint16_t port() const { return port_; }

 private:
  void serve() {
    std::vector<char> block(array_bytes);
    for (int client; (client = accept(listener_, nullptr, nullptr)) >= 0; close(client)) {
      try {
        for (Sizes sizes{};;) {
          read_all(client, &sizes, sizeof sizes);
          if (std::max(sizes.sent, sizes.wanted) > block.size()) break;
          read_all(client, block.data(), sizes.sent);
          write_all(client, block.data(), sizes.wanted);
        }
      } catch (const std::exception&) {
        // It has left.
      }
    }
  }
  int listener_;
  std::uint16_t port_ = 0;
  std::thread thread_;
};

class Arm final : public a::ArmDefault {
 public:
  rr::Array<double> numbers(const rr::Array<double>& values) override { return values; }
};

int serve() {
  const RawBlocks raw;
  rr::Node node;
  const rr::Service service = node.register_service("arm", std::make_shared<Arm>());
  std::printf("rr+tcp://127.0.0.1:%d/?service=arm %d\n",
              static_cast<int>(node.listen_tcp(0, "127.0.0.1")), static_cast<int>(raw.port()));
  std::fflush(stdout);
  for (std::string line; std::getline(std::cin, line);) {
  }
  return 0;
}

/// The median time of a call, in seconds.
template <class Call>
double median(int count, const Call& call) {
  std::vector<double> times;
  for (int i = 0; i < count; ++i) {
    const auto begin = Clock::now();
    call();
    times.push_back(std::chrono::duration<double>(Clock::now() - begin).count());
  }
  std::nth_element(times.begin(), times.begin() + count / 2, times.end());
  return times[static_cast<std::size_t>(count / 2)];
}

int measure(const char* url, std::uint16_t port) {
  rr::Node node;
  const auto arm = node.connect<a::ArmStub>(url);
  for (int i = 0; i < 300; ++i) arm->get_speed();
  const double get = median(get_count, [&] { arm->get_speed(); });
  const rr::Array<double> values(array_bytes / sizeof(double));
  const double both = median(array_count, [&] { arm->numbers(values); });
  const double to = median(array_count, [&] { arm->set_trace(values); });
  const double from = median(array_count, [&] { arm->get_trace(); });

  const int raw = socket(AF_INET, SOCK_STREAM, 0);
  const sockaddr_in address = loopback(port);
  check(connect(raw, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0);
  const int on = 1;
  check(setsockopt(raw, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on) == 0);
  std::vector<char> block(array_bytes);
  const auto move = [&](std::size_t sent, std::size_t wanted) {
    return median(array_count, [&] {
      const Sizes sizes{sent, wanted};
      write_all(raw, &sizes, sizeof sizes);
      write_all(raw, block.data(), sent);
      read_all(raw, block.data(), wanted);
    });
  };
  const double raw_both = move(array_bytes, array_bytes);
  const double raw_to = move(array_bytes, 1);
  const double raw_from = move(1, array_bytes);
  close(raw);
  std::printf("%.9f %.9f %.9f %.9f %.9f %.9f %.9f\n", get, both, to, from, raw_both, raw_to,
              raw_from);
  return 0;
}

}  // namespace

int main(int argc, char** argv) try {
  const std::string verb = argc > 1 ? argv[1] : "";
  if (verb == "serve") return serve();
  if (verb == "measure" && argc == 4) {
    return measure(argv[2], static_cast<std::uint16_t>(std::atoi(argv[3])));
  }
  std::fputs("usage: csharp_bench_peer serve | measure URL PORT\n", stderr);
  return 2;
} catch (const std::exception& error) {
  std::fprintf(stderr, "csharp_bench_peer: %s\n", error.what());
  return 1;
}
