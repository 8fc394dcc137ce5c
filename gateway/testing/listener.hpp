// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>

#include "gateway/carrier.hpp"
#include "gateway/testing/waiting.hpp"

namespace rr::gateway::testing {

/// Keeps what a carrier says.
struct Listener final : CarrierHandler {
  void on_message(Message message) override { messages.add(std::move(message)); }
  void on_connected() override { connected.add(1); }
  void on_disconnected(const std::string& reason) override { reasons.add(reason); }
  void on_room() override { rooms.add(1); }
  void on_refused(const Refusal& refusal) override { refused.add(refusal.text()); }
  Kept<Message> messages;
  Kept<int> connected;
  Kept<std::string> reasons;
  Kept<int> rooms;
  Kept<std::string> refused;
};

}  // namespace rr::gateway::testing
