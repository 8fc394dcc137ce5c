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

/// A scenario with a fault, which runs have to find.
struct Planted {
  Scenario scenario;
  const char* found;  ///< is in what the failure says
};

/// Clients with sessions that use all members of a service, each with its end.
void run_sessions(Scheduler& run);
/// Links that break or fall silent, and hosts that start anew, under clients and subscriptions.
void run_links(Scheduler& run);
/// The same with one host, whose node and clients are refused memory and threads.
void run_scarce(Scheduler& run);
/// Nodes that find each other by datagrams, and hosts that come and go.
void run_finding(Scheduler& run);
/// Clients in the process of their service, by intra-process connections.
void run_inside(Scheduler& run);
/// Packets that come faster than a service handles them.
void run_streaming(Scheduler& run);

/// All of them.
std::span<const Scenario> scenarios();
/// All faults that are there to be found.
std::span<const Planted> planted_faults();

}  // namespace rr::sim
