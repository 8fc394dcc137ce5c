// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>

#include "conformance/harness/channels.hpp"
#include "conformance/harness/comparison.hpp"
#include "conformance/harness/result.hpp"
#include "conformance/harness/stream.hpp"

namespace rr::conformance {

/// A client that is tested: it is told the steps of a plan one by one.
class TestedClient {
 public:
  virtual ~TestedClient() = default;
  /// Begins a scenario, whose service listens at this port. `channel` is what the client's node
  /// needs to come there, null for TCP.
  virtual void begin(const Scenario& scenario, int port, const Json& channel) = 0;
  /// Begins a step, or with null takes its node down.
  virtual void start(const Json& step) = 0;
  /// What the step gave: {result} or {raised} or {unsupported}; nothing when it is not done in
  /// time.
  virtual std::optional<Json> outcome(Milliseconds limit) = 0;
  /// False for a client that shows nothing but its frames.
  [[nodiscard]] virtual bool tells_outcomes() const = 0;
  /// How long to wait for a frame of it.
  [[nodiscard]] virtual Milliseconds patience() const = 0;
};

/// Plays the service of a recording, byte for byte, and compares what the client sends and got.
class ClientReplay {
 public:
  ClientReplay(const Comparison& comparison, const Deviations& deviations, Entrance& entrance,
               TestedClient& client);

  /// With `until_fault`, nothing more is played once something went otherwise than recorded.
  Result play(const Scenario& scenario, bool until_fault = false);

 private:
  struct Line;
  class Play;

  const Comparison& comparison_;
  const Deviations& deviations_;
  Entrance& entrance_;
  TestedClient& client_;
};

/// What a client is told of a step: the plan without what the recorded client got, and with the URL
/// of a service at this place (Entrance::place).
Json told(const Step& step, const Scenario& scenario, const std::string& place);

/// What is wrong with the outcome of a step; nothing when it is the recorded one. `steps` are all
/// of the scenario: a step may refer to an earlier one.
std::optional<std::string> fault_of_outcome(const Comparison& comparison,
                                            const std::vector<Step>& steps, const Step& step,
                                            const Json& outcome);

}  // namespace rr::conformance
