// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "conformance/harness/channels.hpp"
#include "conformance/harness/comparison.hpp"
#include "conformance/harness/result.hpp"

namespace rr::conformance {

/// A client and its service that are both played by runners.
class PlayedNodes {
 public:
  virtual ~PlayedNodes() = default;
  /// Starts both. Throws std::runtime_error.
  virtual void begin(const Scenario& scenario) = 0;
  /// The client does a step of the plan: {result} or {raised} or {unsupported}.
  virtual Json play(const Step& step) = 0;
  /// The service ends.
  virtual void close_service(const std::string& name) = 0;
  /// The client's node ends.
  virtual void stop_client() = 0;
  /// After the last step. Throws std::runtime_error when something has not lasted until now.
  virtual void end() = 0;
};

/// Plays the plan of a recording where no message can be compared: what each step got must be what
/// the recorded client got.
class OutcomeReplay {
 public:
  OutcomeReplay(const Comparison& comparison, const Deviations& deviations, std::string channel)
      : comparison_(comparison), deviations_(deviations), channel_(std::move(channel)) {}

  /// With `until_fault`, nothing more is played once something went otherwise than recorded.
  Result play(const Scenario& scenario, PlayedNodes& nodes, bool until_fault = false);

 private:
  class Play;

  const Comparison& comparison_;
  const Deviations& deviations_;
  const std::string channel_;
};

}  // namespace rr::conformance
