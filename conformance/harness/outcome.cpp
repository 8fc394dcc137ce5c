// SPDX-License-Identifier: Apache-2.0
// Compares what a client got in a step with what the plan says that the recorded one got.
#include "conformance/harness/client_replay.hpp"
#include "conformance/harness/values.hpp"

namespace rr::conformance {
namespace {

// The value of the last set of the property that this step gets; what others have got from it if
// no set was accepted.
Json value_set_before(const std::vector<Step>& steps, const Step& step) {
  Json got;
  std::optional<Json> set;  // which may be a null that was set
  for (const Step& earlier : steps) {
    if (earlier.index >= step.index) break;
    const Json& plan = earlier.plan;
    const bool is_accepted = !plan.contains("raised");
    if (!is_accepted || plan.value("member", Json()) != step.plan.at("member")) continue;
    if (plan.at("op") == "set" && plan.at("obj") == step.plan.at("obj")) set = plan.at("value");
    if (plan.at("op") == "get" && plan.contains("result")) got = plan.at("result");
  }
  return set.value_or(got);
}

std::optional<std::string> fault_of_error(const Comparison& comparison, const Step& step,
                                          const Json& recorded, const Json& raised) {
  // An exception of the recorded client's own language: that there is one is all it says.
  if (!recorded.contains("code")) return std::nullopt;
  std::string both = said(recorded) + " recorded, " + said(raised) + " raised";
  if (recorded.at("code") != raised.value("code", Json())) return both;
  const std::string name = recorded.at("name");
  if (!comparison.is_host_specific(name) && name != raised.value("name", "")) return both;
  const std::string message = recorded.at("message");
  const Json arguments = step.plan.value("args", Json::array());
  if (comparison.is_scripted(message, arguments) && message != raised.value("message", "")) {
    return both;
  }
  if (recorded.value("subname", "") != raised.value("subname", "")) return both;
  if (!same_value(recorded.value("param", Json()), raised.value("param", Json()))) return both;
  return std::nullopt;
}

}  // namespace

std::optional<std::string> fault_of_outcome(const Comparison& comparison,
                                            const std::vector<Step>& steps, const Step& step,
                                            const Json& outcome) {
  if (outcome.contains("unsupported")) {
    return "not supported: " + outcome["unsupported"].get<std::string>();
  }
  if (outcome.contains("error")) {
    return "the runner says: " + outcome["error"].get<std::string>();
  }
  const Json& plan = step.plan;
  if (plan.contains("raised")) {
    if (outcome.contains("raised")) {
      return fault_of_error(comparison, step, plan["raised"], outcome["raised"]);
    }
    return said(plan["raised"]) + " was not raised, but " + said(outcome);
  }
  if (outcome.contains("raised")) return "raised " + said(outcome["raised"]);
  const Json got = outcome.value("result", Json());
  if (plan.value("result_as_set", false)) {
    const Json set = value_set_before(steps, step);
    if (same_value(set, got)) return std::nullopt;
    return said(set) + " was set, " + said(got) + " came back";
  }
  const Json recorded = plan.value("result", Json());
  const bool same =
      plan.at("op") == "wait" ? same_things(recorded, got) : same_value(recorded, got);
  if (same) return std::nullopt;
  return said(recorded) + " recorded, " + said(got) + " came";
}

}  // namespace rr::conformance
