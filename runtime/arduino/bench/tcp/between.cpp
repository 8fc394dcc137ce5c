// SPDX-License-Identifier: Apache-2.0
#include "runtime/arduino/bench/tcp/between.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <stdexcept>

namespace rr::serial::testing {
namespace {

sockaddr_in loopback(std::uint16_t port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  return address;
}

}  // namespace

Between::Between(std::uint16_t board, const BadLine::Rates& rates, unsigned seed)
    : board_(board), there_(rates, seed), back_(rates, seed + 1) {
  listener_ = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address = loopback(0);
  socklen_t size = sizeof address;
  if (::bind(listener_, reinterpret_cast<sockaddr*>(&address), size) != 0 ||
      ::listen(listener_, 8) != 0 ||
      ::getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size) != 0) {
    throw std::runtime_error("no port to listen at");
  }
  port_ = ntohs(address.sin_port);
  thread_ = std::thread([this] { run(); });
}

Between::~Between() {
  stops_ = true;
  thread_.join();
  close_all(pairs_);
  close_all(dead_);
  ::close(listener_);
}

void Between::close_all(std::vector<Pair>& pairs) {
  for (const Pair& pair : pairs) {
    ::close(pair.host);
    ::close(pair.board);
  }
  pairs.clear();
}

void Between::accept() {
  const int host = ::accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
  if (host < 0) return;
  ++connections_;
  const int board = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const sockaddr_in address = loopback(board_);
  if (::connect(board, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    ::close(host);
    ::close(board);
    return;
  }
  const int on = 1;
  for (const int file : {host, board}) {
    (void)::setsockopt(file, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
  }
  pairs_.push_back({host, board});
}

bool Between::pass(int from, int to, BadLine& line) {
  std::vector<std::uint8_t> bytes(512);
  const ssize_t got = ::recv(from, bytes.data(), bytes.size(), 0);
  if (got <= 0) return false;
  bytes.resize(static_cast<std::size_t>(got));
  const std::vector<std::uint8_t> harmed = line.pass(bytes);
  return harmed.empty() || ::send(to, harmed.data(), harmed.size(), MSG_NOSIGNAL) ==
                               static_cast<ssize_t>(harmed.size());
}

void Between::run() {
  while (!stops_) {
    if (cuts_.exchange(false)) {
      close_all(pairs_);
    }
    if (swallows_.exchange(false)) {
      dead_.insert(dead_.end(), pairs_.begin(), pairs_.end());
      pairs_.clear();
    }
    std::vector<pollfd> waits{{listener_, POLLIN, 0}};
    for (const Pair& pair : pairs_) {
      waits.push_back({pair.host, POLLIN, 0});
      waits.push_back({pair.board, POLLIN, 0});
    }
    if (::poll(waits.data(), waits.size(), 20) <= 0) continue;
    std::vector<Pair> kept;
    for (std::size_t at = 0; at < pairs_.size(); ++at) {
      const Pair pair = pairs_[at];
      const bool goes_on =
          (waits[2 * at + 1].revents == 0 || pass(pair.host, pair.board, there_)) &&
          (waits[2 * at + 2].revents == 0 || pass(pair.board, pair.host, back_));
      if (goes_on) {
        kept.push_back(pair);
      } else {
        ::close(pair.host);
        ::close(pair.board);
      }
    }
    pairs_ = std::move(kept);
    if (waits[0].revents != 0) accept();
  }
}

}  // namespace rr::serial::testing
