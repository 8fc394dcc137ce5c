// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <set>
#include <string>

#include "gateway/carrier.hpp"
#include "gateway/exporter.hpp"
#include "gateway/worker.hpp"
#include "rr/function.hpp"

namespace rr::gateway {

/// What the connection for values says, for a gateway's worker. Writes to the log whether it is
/// there; whether robots can be reached is said of the connection for messages alone.
class ValueHandler final : public CarrierHandler {
 public:
  /// Called on the worker's thread.
  struct Actions {
    Function<void(const Message&)> message;
    Function<void()> connected;
    Function<void()> disconnected;
    Function<void()> room;
  };

  /// Worker and carrier outlive it.
  ValueHandler(Worker& worker, const Carrier& carrier, Log log, Actions actions);

  void on_message(Message message) override;
  void on_connected() override;
  void on_disconnected(const std::string& reason) override;
  void on_room() override;
  void on_refused(const Refusal& refusal) override;

 private:
  Worker& worker_;
  const Carrier& carrier_;
  const Log log_;
  const Actions actions_;
  // Of the worker's thread.
  std::string reason_;              // why it is not connected, as was reported
  std::set<std::string> refusals_;  // topics that were reported for this connection
};

}  // namespace rr::gateway
