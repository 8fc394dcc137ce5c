// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <thread>

#include "rr/discovery.hpp"
#include "rr/node.hpp"
#include "runtime/cpp/sim/random.hpp"
#include "runtime/cpp/stress/bench.hpp"

namespace rr::sim {

/// Ends the run when the calling thread, which runs user code, holds a mutex: `where` says which
/// code.
void expect_no_lock(const char* where);

/// How long threads of the run may be held up in all.
std::chrono::milliseconds longest_delay();

/// A node with the service of the stress program.
class Host {
 public:
  /// Listens at a port; 0: any.
  Host(stress::Lines& lines, std::uint32_t clients, NodeOptions options, std::uint16_t port = 0);

  [[nodiscard]] std::uint16_t port() const { return port_; }
  [[nodiscard]] std::string url() const;
  /// Listens for clients of this process, too: their URL, of connections without sockets.
  [[nodiscard]] std::string listen_inside();
  [[nodiscard]] const NodeId& id() const { return node_.id(); }
  /// Makes the node known there, and lets it answer nodes that ask.
  void announce(const DiscoveryNetwork& network);
  stress::Bench& bench() { return *bench_; }
  /// Ends the run when the service still has something of its clients after a time.
  void expect_nothing_left(std::chrono::seconds limit) const;

 private:
  [[nodiscard]] std::size_t left() const;

  stress::Shared shared_;
  std::atomic<int> clients_{0};
  std::shared_ptr<stress::Bench> bench_;
  Node node_;
  Service service_;
  std::uint16_t port_;
};

/// Sends to all clients of a service while it exists.
class Producer {
 public:
  /// Wires have a value at once.
  Producer(stress::Bench& bench, std::uint64_t seed, std::chrono::microseconds longest_pause)
      : bench_(bench), longest_pause_(longest_pause) {
    bench_.produce(seed);
    thread_ = std::thread([this, seed] { produce(seed); });
  }
  ~Producer() {
    is_ending_ = true;
    thread_.join();
  }
  Producer(const Producer&) = delete;
  Producer& operator=(const Producer&) = delete;

 private:
  void produce(std::uint64_t seed);

  stress::Bench& bench_;
  const std::chrono::microseconds longest_pause_;
  std::atomic<bool> is_ending_{false};
  std::thread thread_;
};

}  // namespace rr::sim
