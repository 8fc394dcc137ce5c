// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "rr/call.hpp"
#include "rr/service_filter.hpp"
#include "runtime/cpp/src/channel/interruption.hpp"
#include "runtime/cpp/src/discovery/node_table.hpp"
#include "runtime/cpp/src/subscription/host.hpp"

namespace rr::discovery {

/// One question to the service index of a node.
struct Question {
  channel::Interruption interruption;
  std::stop_source cancellation;

  /// Brings it to its end soon. Not under a lock.
  void give_up() {
    interruption.interrupt();
    cancellation.request_stop();
  }
};

/// The services of a node, each with all URLs by which it may be reached: those that the index
/// names, and the announced ones. Tries one URL after the other. Blocks. Throws rr::Error when none
/// of them leads to the node, or its answer is too large.
std::vector<FoundService> ask_index(const subscription::Host& host, const KnownNode& node,
                                    Question& question);

/// Adds what the announced URLs of its node make of those of a service; whether there was a new
/// one.
bool add_urls(FoundService& service, const DetectedNode& node);

}  // namespace rr::discovery
