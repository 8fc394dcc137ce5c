// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <random>
#include <span>
#include <vector>

#include "rr/realtime/cyclic_loop.hpp"
#include "rr/realtime/udp_socket.hpp"

namespace rr::realtime::testing {

/// What a line does to packets. Parts of all packets, from 0 to 1.
struct LineFaults {
  double loss = 0;
  double duplicates = 0;
  double reordered = 0;  ///< leave up to `longest_delay` packets later
  int longest_delay = 5;
  Nanoseconds stall_begin{0};   ///< from here on nothing leaves,
  Nanoseconds stall_length{0};  ///< until so long after, when all of it leaves at once
};

/// A line of packets with faults, the same for the same seed.
class BadLine {
 public:
  using Packet = std::vector<std::byte>;

  BadLine(const LineFaults& faults, std::uint32_t seed) : faults_(faults), random_(seed) {}

  void push(std::span<const std::byte> packet) {
    ++pushed_;
    if (chance() < faults_.loss) return;
    const int copies = chance() < faults_.duplicates ? 2 : 1;
    for (int i = 0; i < copies; ++i) {
      std::uint64_t leaves = pushed_;
      if (chance() < faults_.reordered) {
        leaves += 1 + random_() % static_cast<std::uint32_t>(faults_.longest_delay);
      }
      waiting_.push_back({leaves, Packet(packet.begin(), packet.end())});
    }
  }
  /// What leaves now, in its order.
  std::vector<Packet> pull(Nanoseconds now) {
    std::vector<Packet> out;
    const bool is_stalled =
        now >= faults_.stall_begin && now < faults_.stall_begin + faults_.stall_length;
    if (is_stalled) return out;
    std::erase_if(waiting_, [&](Waiting& one) {
      if (one.leaves > pushed_) return false;
      out.push_back(std::move(one.packet));
      return true;
    });
    return out;
  }

 private:
  struct Waiting {
    std::uint64_t leaves;
    Packet packet;
  };

  double chance() { return static_cast<double>(random_()) / 4294967296.0; }

  LineFaults faults_;
  std::mt19937 random_;
  std::uint64_t pushed_ = 0;
  std::deque<Waiting> waiting_;
};

/// The same between UDP sockets: what is sent to port() goes on to a receiver. Moves packets when
/// it is told to, so that on a simulated clock each run is the same.
class UdpProxy {
 public:
  UdpProxy(const LineFaults& faults, std::uint32_t seed, std::uint16_t receiver)
      : line_(faults, seed), in_("127.0.0.1", 0), out_("127.0.0.1", 0) {
    out_.connect("127.0.0.1", receiver);
  }
  [[nodiscard]] std::uint16_t port() const { return in_.port(); }
  void move(Nanoseconds now) {
    std::vector<std::byte> bytes(2048);
    while (const auto size = in_.receive(bytes)) line_.push(std::span(bytes).first(*size));
    for (const BadLine::Packet& packet : line_.pull(now)) out_.send(packet);
  }

 private:
  BadLine line_;
  UdpSocket in_;
  UdpSocket out_;
};

}  // namespace rr::realtime::testing
