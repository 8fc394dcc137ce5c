// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

#include "conformance/harness/comparison.hpp"
#include "conformance/harness/result.hpp"
#include "conformance/harness/runner.hpp"
#include "conformance/harness/scenario_service.hpp"
#include "conformance/harness/stream.hpp"

namespace rr::conformance {

/// How to come to the service that is tested.
struct Connect {
  std::string channel;
  std::function<Stream()> make;
  /// A new connection. Throws std::runtime_error.
  Stream operator()() const { return make(); }
};

/// Plays the client of a recording, byte for byte, and compares what the service answers.
class ServiceReplay {
 public:
  /// `close_service` is called in a step that holds a ServiceClosed, with the name of the service.
  ServiceReplay(const Comparison& comparison, const Deviations& deviations, Connect connect,
                std::function<void(const std::string&)> close_service);

  /// With `until_fault`, nothing more is played once something went otherwise than recorded.
  Result play(const Scenario& scenario, bool until_fault = false);

 private:
  struct Line;  // one connection while it is played
  class Play;

  const Comparison& comparison_;
  const Deviations& deviations_;
  Connect connect_;
  std::function<void(const std::string&)> close_service_;
};

}  // namespace rr::conformance
