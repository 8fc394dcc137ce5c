// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "conformance/harness/channels.hpp"
#include "conformance/harness/comparison.hpp"
#include "conformance/harness/result.hpp"

namespace rr::conformance {

/// Plays the plan of a recording with a runner that is client and service at once: what each step
/// got is compared with what the recorded client got. No message can be seen.
class InProcessReplay {
 public:
  InProcessReplay(const Captures& captures, const Comparison& comparison,
                  const Deviations& deviations, Channel& channel)
      : captures_(captures), comparison_(comparison), deviations_(deviations), channel_(channel) {}

  Result play(const Scenario& scenario, const std::vector<std::string>& command);

 private:
  class Play;

  const Captures& captures_;
  const Comparison& comparison_;
  const Deviations& deviations_;
  Channel& channel_;
};

}  // namespace rr::conformance
