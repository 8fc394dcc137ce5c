// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "conformance/harness/gateways.hpp"
#include "conformance/harness/outcome_replay.hpp"
#include "conformance/harness/runner.hpp"

namespace rr::conformance {

/// A client and its service, each a runner, with gateways and a broker between them.
class FarNodes final : public PlayedNodes {
 public:
  /// `gateway` is the program.
  FarNodes(const Captures& captures, Broker& broker, std::string gateway,
           const std::vector<std::string>& command)
      : captures_(captures),
        broker_(broker),
        gateway_(std::move(gateway)),
        service_(command, "serve"),
        client_(command, "call") {}

  void begin(const Scenario& scenario) override;
  Json play(const Step& step) override;
  void close_service(const std::string& name) override;
  void stop_client() override { client_.order({{"do", "stop_node"}}); }
  void end() override { gateways_->end(); }

 private:
  const Captures& captures_;
  Broker& broker_;
  const std::string gateway_;
  Runner service_;
  std::optional<Gateways> gateways_;
  Runner client_;
  const Scenario* scenario_ = nullptr;
};

}  // namespace rr::conformance
