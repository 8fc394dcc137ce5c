// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "runtime/cpp/sim/scheduler.hpp"

namespace rr::sim {

/// What nodes do in a run. It returns when all its nodes have ended; a rule that is broken ends the
/// run by Scheduler::fail.
struct Scenario {
  const char* name;
  const char* what;  ///< one line for the help
  void (*run)(Scheduler& run);
};

/// Clients with sessions that use all members of a service, each with its end.
void run_sessions(Scheduler& run);
/// Links that break or fall silent, and hosts that start anew, under clients and subscriptions.
void run_links(Scheduler& run);
/// The same with one host, whose node and clients are refused memory and threads.
void run_scarce(Scheduler& run);

/// All of them.
std::span<const Scenario> scenarios();

}  // namespace rr::sim
