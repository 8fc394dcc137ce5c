// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>

#include "runtime/cpp/stress/hostile_link.hpp"

namespace rr::stress {

/// What an attacker knows while it attacks.
struct Attacker {
  std::uint16_t port = 0;
  NodeId server{};
  int number = 0;
  std::atomic<std::size_t>& sent;  ///< bytes, of all attackers
  const std::atomic<bool>& is_over;

  [[nodiscard]] HostileLink link() const { return {port, server, number}; }
  /// Keeps its connections until all leave.
  void stay() const;
};
using Attack = std::function<void(const Attacker&)>;

/// What an attack has done.
struct Outcome {
  std::size_t sent = 0;      ///< bytes, by all attackers
  std::size_t held = 0;      ///< bytes of memory over those of the idle service, at most
  std::size_t kept = 0;      ///< the same five seconds after the attackers have left, or earlier
  double idle_p99 = 0;       ///< of a well-behaved client's calls, in milliseconds
  double attacked_p99 = 0;   ///< the same during the attack
  std::size_t calls = 0;     ///< of that client during the attack
  std::size_t failures = 0;  ///< of its calls

  [[nodiscard]] std::string text() const;
};

/// What is left after five seconds may be so much more than in the idle service: threads that have
/// not ended, each with its stack and its share of the allocator, and pages that are in use in
/// part.
inline constexpr std::size_t tolerance = std::size_t{12} * 1024 * 1024;

/// Starts a service in a process of its own, lets so many attack it for some seconds while a
/// well-behaved client calls it every 20 ms, and lets them leave.
Outcome play(int attackers, const Attack& attack);

}  // namespace rr::stress
