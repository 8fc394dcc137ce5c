// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <thread>
#include <vector>

#include "runtime/arduino/bench/bad_line.hpp"

/// For tests: what stands between a host and a board over TCP, and harms what passes.
namespace rr::serial::testing {

class Between {
 public:
  /// Listens at a free port of the loopback interface and passes all on to `board`.
  Between(std::uint16_t board, const BadLine::Rates& rates, unsigned seed);
  ~Between();
  Between(const Between&) = delete;
  Between& operator=(const Between&) = delete;

  [[nodiscard]] std::uint16_t port() const { return port_; }
  /// Closes the connections that there are.
  void cut() { cuts_ = true; }
  /// Those that there are carry nothing from now on, and stay open.
  void swallow() { swallows_ = true; }
  /// So many connections were made by hosts.
  [[nodiscard]] int connections() const { return connections_; }

 private:
  struct Pair {
    int host;
    int board;
  };

  void run();
  void accept();
  static void close_all(std::vector<Pair>& pairs);
  static bool pass(int from, int to, BadLine& line);

  const std::uint16_t board_;
  int listener_ = -1;
  std::uint16_t port_ = 0;
  BadLine there_;
  BadLine back_;
  std::vector<Pair> pairs_;
  std::vector<Pair> dead_;
  std::atomic<int> connections_ = 0;
  std::atomic<bool> cuts_ = false;
  std::atomic<bool> swallows_ = false;
  std::atomic<bool> stops_ = false;
  std::thread thread_;
};

}  // namespace rr::serial::testing
