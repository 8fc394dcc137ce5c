// SPDX-License-Identifier: Apache-2.0
#include "conformance/harness/far_nodes.hpp"

#include "conformance/harness/client_replay.hpp"
#include "conformance/harness/runner_client.hpp"
#include "conformance/harness/scenario_service.hpp"

namespace rr::conformance {

void FarNodes::begin(const Scenario& scenario) {
  scenario_ = &scenario;
  const Json started = service_.order(serve_request(captures_, scenario));
  gateways_.emplace(broker_, gateway_, captures_, scenario, started.at("port").get<int>());
  client_.order(call_request(scenario, 0, nullptr));
}

Json FarNodes::play(const Step& step) {
  const Step far = gateways_->without_login(step);
  return client_.ask({{"do", "step"}, {"step", told(far, *scenario_, gateways_->place_for(step))}});
}

void FarNodes::close_service(const std::string& name) {
  service_.order({{"do", "close_service"}, {"service", name}});
}

}  // namespace rr::conformance
