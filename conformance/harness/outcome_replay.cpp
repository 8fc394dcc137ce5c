// SPDX-License-Identifier: Apache-2.0
#include "conformance/harness/outcome_replay.hpp"

#include <thread>

#include "conformance/harness/client_replay.hpp"
#include "conformance/harness/entry_types.hpp"
#include "conformance/harness/service_replay.hpp"

namespace rr::conformance {

class OutcomeReplay::Play {
 public:
  Play(OutcomeReplay& replay, const Scenario& scenario, PlayedNodes& nodes)
      : replay_(replay), scenario_(scenario), nodes_(nodes) {
    result_.run = {scenario.name, scenario.version, Role::client, replay.channel_};
  }

  Result whole(bool until_fault) {
    nodes_.begin(scenario_);
    for (const Step& step : scenario_.steps) {
      play(step);
      ++result_.checked;
      if (until_fault && !result_.faults.empty()) break;
    }
    nodes_.end();
    return std::move(result_);
  }

 private:
  void play(const Step& step) {
    for_each_frame(step, [&](const Frame& frame) {
      if (!is(frame, EntryType::service_closed)) return;
      nodes_.close_service(service_of(scenario_, frame.connection));
    });
    if (step.plan.at("op") == "sleep") return sleep(step);
    const Json outcome = nodes_.play(step);
    if (const ListEntry* listed = deviation_of(step))
      return judge_deviation(step, *listed, outcome);
    const auto text = fault_of_outcome(replay_.comparison_, scenario_.steps, step, outcome);
    if (text) result_.fail(step_place(step.index), step.label, *text);
  }

  void sleep(const Step& step) {
    bool ends = false;  // the recorded client's node, which says goodbye
    for_each_frame(step, [&](const Frame& frame) {
      ends = ends || (frame.from_client && is(frame, EntryType::disconnect_client));
    });
    if (ends) nodes_.stop_client();
    std::this_thread::sleep_for(Milliseconds(step.plan.value("ms", 0)));
  }

  // Ours differs as client in a step, or as service in the answer that it gets.
  [[nodiscard]] const ListEntry* deviation_of(const Step& step) const {
    const ListEntry* found = replay_.deviations_.find(result_.run, step_place(step.index));
    Run as_service = result_.run;
    as_service.role = Role::service;
    for_each_frame(step, [&](const Frame& frame) {
      const std::string error = host_error_of(frame, replay_.comparison_);
      if (found != nullptr || error.empty()) return;
      found = replay_.deviations_.find(as_service, host_error_place(error));
    });
    return found;
  }

  void judge_deviation(const Step& step, const ListEntry& listed, const Json& outcome) {
    const std::string& instead = listed.instead();  // `raises 17`, `error 18`
    const std::string code = outcome.value("raised", Json::object()).value("code", Json()).dump();
    if (instead != "raises " + code && instead != "error " + code) {
      return result_.fail(step_place(step.index), step.label,
                          "raised " + code + ", not what is listed");
    }
    result_.deviations.push_back(&listed);
  }

  template <class Look>
  void for_each_frame(const Step& step, Look look) const {
    for (int i = 0; i < step.frame_count; ++i) {
      look(scenario_.frames[static_cast<std::size_t>(step.first_frame + i)]);
    }
  }

  OutcomeReplay& replay_;
  const Scenario& scenario_;
  PlayedNodes& nodes_;
  Result result_;
};

Result OutcomeReplay::play(const Scenario& scenario, PlayedNodes& nodes, bool until_fault) {
  return Play(*this, scenario, nodes).whole(until_fault);
}

}  // namespace rr::conformance
