// SPDX-License-Identifier: Apache-2.0
#include "conformance/harness/runner_client.hpp"

namespace rr::conformance {

Json call_request(const Scenario& scenario, int port, const Json& channel) {
  Json request = {{"do", "start"},
                  {"node", {{"id", scenario.client.id}, {"name", scenario.client.name}}},
                  {"message_version", scenario.message_version},
                  {"string_table", scenario.string_table},
                  {"node_options", scenario.node_options},
                  {"host", "127.0.0.1"},
                  {"port", port}};
  if (scenario.heartbeat_ms.is_object()) {
    request["heartbeat_ms"] = scenario.heartbeat_ms.at("client");
  }
  if (!channel.is_null()) request["channel"] = channel;
  return request;
}

void RunnerClient::begin(const Scenario& scenario, int port, const Json& channel) {
  runner_ = std::make_unique<Runner>(command_, "call");
  runner_->order(call_request(scenario, port, channel));
}

void RunnerClient::start(const Json& step) {
  runner_->tell(step.is_null() ? Json{{"do", "stop_node"}} : Json{{"do", "step"}, {"step", step}});
}

}  // namespace rr::conformance
