// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "conformance/harness/outcome_replay.hpp"
#include "conformance/harness/runner.hpp"

namespace rr::conformance {

/// Both nodes in the process of one runner.
class InProcessNodes final : public PlayedNodes {
 public:
  InProcessNodes(const Captures& captures, Channel& channel,
                 const std::vector<std::string>& command)
      : captures_(captures), channel_(channel), runner_(command, "both") {}

  void begin(const Scenario& scenario) override;
  Json play(const Step& step) override;
  void close_service(const std::string& name) override;
  void stop_client() override { runner_.order({{"do", "stop_node"}}); }
  void end() override {}

 private:
  const Captures& captures_;
  Channel& channel_;
  Runner runner_;
  const Scenario* scenario_ = nullptr;
};

}  // namespace rr::conformance
