// SPDX-License-Identifier: Apache-2.0
#include "conformance/harness/far_nodes.hpp"

#include <map>
#include <set>
#include <string>
#include <utility>

#include "conformance/harness/client_replay.hpp"
#include "conformance/harness/runner_client.hpp"
#include "conformance/harness/scenario_service.hpp"

namespace rr::conformance {
namespace {

// A serving gateway numbers services in the order in which their definitions come. They get the
// numbers of the recording, if these are the ones that came.
void sort_as_recorded(const Json& recorded, Json& outcome) {
  if (!outcome.contains("result")) return;
  Json& came = outcome["result"];
  std::set<Json> numbers;
  std::map<std::string, Json> by_name;
  for (const Json& service : came) {
    numbers.insert(service.at("index"));
    by_name[service.at("name")] = service;
  }
  Json sorted = Json::array();
  for (const Json& service : recorded) {
    const auto found = by_name.find(service.at("name"));
    if (found == by_name.end() || numbers.erase(service.at("index")) == 0) return;
    sorted.push_back(found->second);
    sorted.back()["index"] = service.at("index");
  }
  if (numbers.empty()) came = std::move(sorted);
}

}  // namespace

void FarNodes::begin(const Scenario& scenario) {
  scenario_ = &scenario;
  const Json started = service_.order(serve_request(captures_, scenario));
  gateways_.emplace(broker_, gateway_, captures_, scenario, started.at("port").get<int>());
  client_.order(call_request(scenario, 0, nullptr));
}

Json FarNodes::play(const Step& step) {
  Json outcome =
      client_.ask({{"do", "step"}, {"step", told(step, *scenario_, gateways_->place())}});
  if (step.plan.at("op") == "local_services") sort_as_recorded(step.plan.at("result"), outcome);
  return outcome;
}

void FarNodes::close_service(const std::string& name) {
  service_.order({{"do", "close_service"}, {"service", name}});
}

}  // namespace rr::conformance
