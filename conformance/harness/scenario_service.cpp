// SPDX-License-Identifier: Apache-2.0
#include "conformance/harness/scenario_service.hpp"

#include <cstdint>
#include <rr/error.hpp>
#include <vector>

#include "conformance/harness/comparison.hpp"
#include "conformance/harness/entry_types.hpp"

namespace rr::conformance {
namespace {

// What the recorded service left out of the capabilities that its client offered: it was told to.
Json withheld_capabilities(const Scenario& scenario) {
  constexpr std::uint32_t page = 0xFFF00000;
  Json withheld = Json::array();
  if (scenario.frames.size() < 2) return withheld;
  const auto capabilities = [](const Frame& frame) {
    for (const Json& element : frame.entries().at(0).at("elements")) {
      if (element.value("name", "") == "capabilities" && element.contains("value")) {
        return element["value"].get<std::vector<std::uint32_t>>();
      }
    }
    return std::vector<std::uint32_t>();
  };
  for (const std::uint32_t offered : capabilities(scenario.frames[0])) {
    for (const std::uint32_t answered : capabilities(scenario.frames[1])) {
      const std::uint32_t missing = offered & ~answered;
      if ((offered & page) == (answered & page) && missing != 0) {
        withheld.push_back((offered & page) | missing);
      }
    }
  }
  return withheld;
}

}  // namespace

std::string host_error_of(const Frame& frame, const Comparison& comparison) {
  if (frame.from_client || frame.entries().empty()) return {};
  const Json& entry = frame.entries().front();
  if (entry.at("error") != static_cast<int>(ErrorCode::remote_error)) return {};
  for (const Json& element : entry.at("elements")) {
    if (element.value("name", "") != "errorname") continue;
    const std::string name = element.at("value");
    return comparison.is_host_specific(name) ? name : std::string();
  }
  return {};
}

std::string service_of(const Scenario& scenario, int connection) {
  for (const Frame& frame : scenario.frames) {
    const bool asks =
        is(frame, EntryType::connect_client) || is(frame, EntryType::connect_client_combined);
    if (frame.connection == connection && frame.from_client && asks) {
      return frame.entries().front().at("service_path");
    }
  }
  return {};
}

Json serve_request(const Captures& captures, const Scenario& scenario, const Json& channel) {
  Json request = {{"do", "start"},
                  {"node", {{"id", scenario.service.id}, {"name", scenario.service.name}}},
                  {"message_version", scenario.message_version},
                  {"string_table", scenario.string_table},
                  {"node_options", scenario.node_options},
                  {"withheld_capabilities", withheld_capabilities(scenario)},
                  {"services", captures.service.value("services", Json::array())},
                  {"port", 0}};
  if (scenario.heartbeat_ms.is_object()) {
    request["heartbeat_ms"] = scenario.heartbeat_ms.at("service");
  }
  if (!channel.is_null()) request["channel"] = channel;
  return request;
}

}  // namespace rr::conformance
