// SPDX-License-Identifier: Apache-2.0
#include "conformance/harness/in_process_nodes.hpp"

#include "conformance/harness/client_replay.hpp"
#include "conformance/harness/runner_client.hpp"
#include "conformance/harness/scenario_service.hpp"

namespace rr::conformance {

void InProcessNodes::begin(const Scenario& scenario) {
  scenario_ = &scenario;
  const Json settings = channel_.settings(scenario.service);
  runner_.order({{"do", "start"},
                 {"service", serve_request(captures_, scenario, settings)},
                 {"client", call_request(scenario, 0, settings)}});
}

// In a process there is no place but nodes: a client that names none means that of the scenario.
Json InProcessNodes::play(const Step& step) {
  Step named = step;
  Json& plan = named.plan;
  if (plan.at("op") == "connect" && !plan.contains("nodeid") && !plan.contains("nodename")) {
    plan["nodeid"] = scenario_->service.id;
  }
  return runner_.ask(
      {{"do", "step"}, {"step", told(named, *scenario_, channel_.place(*scenario_, 0))}});
}

void InProcessNodes::close_service(const std::string& name) {
  runner_.order({{"do", "close_service"}, {"service", name}});
}

}  // namespace rr::conformance
