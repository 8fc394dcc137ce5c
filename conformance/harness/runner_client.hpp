// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "conformance/harness/client_replay.hpp"
#include "conformance/harness/runner.hpp"

namespace rr::conformance {

/// What a runner's `call` is told before the steps.
Json call_request(const Scenario& scenario, int port, const Json& channel);

/// A client that is a runner of this suite: a process of its own for each scenario.
class RunnerClient final : public TestedClient {
 public:
  explicit RunnerClient(std::vector<std::string> command) : command_(std::move(command)) {}

  void begin(const Scenario& scenario, int port, const Json& channel) override;
  void start(const Json& step) override;
  std::optional<Json> outcome(Milliseconds limit) override { return runner_->answer(limit); }
  [[nodiscard]] bool tells_outcomes() const override { return true; }
  [[nodiscard]] Milliseconds patience() const override { return Milliseconds(3000); }

 private:
  std::vector<std::string> command_;
  std::unique_ptr<Runner> runner_;
};

}  // namespace rr::conformance
