// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

#include "conformance/harness/comparison.hpp"
#include "conformance/harness/result.hpp"
#include "conformance/harness/runner.hpp"

namespace rr::conformance {

/// Where the service that is tested listens.
struct Address {
  std::string host;
  int port = 0;
};

/// What a runner's `serve` is told so that it is the service of a recording, but for its services.
Json serve_request(const Captures& captures, const Scenario& scenario);

/// Plays the client of a recording, byte for byte, and compares what the service answers.
class ServiceReplay {
 public:
  /// `close_service` is called in a step that holds a ServiceClosed, with the name of the service.
  ServiceReplay(const Comparison& comparison, const Deviations& deviations, Address address,
                std::function<void(const std::string&)> close_service);

  /// With `until_fault`, nothing more is played once something went otherwise than recorded.
  Result play(const Scenario& scenario, bool until_fault = false);

 private:
  struct Line;  // one connection while it is played
  class Play;

  const Comparison& comparison_;
  const Deviations& deviations_;
  Address address_;
  std::function<void(const std::string&)> close_service_;
};

}  // namespace rr::conformance
