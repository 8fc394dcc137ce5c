// SPDX-License-Identifier: Apache-2.0
#include "conformance/harness/in_process_replay.hpp"

#include <thread>

#include "conformance/harness/client_replay.hpp"
#include "conformance/harness/entry_types.hpp"
#include "conformance/harness/runner_client.hpp"
#include "conformance/harness/service_replay.hpp"

namespace rr::conformance {

class InProcessReplay::Play {
 public:
  Play(InProcessReplay& replay, const Scenario& scenario, Runner& runner)
      : replay_(replay), scenario_(scenario), runner_(runner) {
    result_.run = {scenario.name, scenario.version, Role::client, replay.channel_.name()};
  }

  Result whole() {
    const Json settings = replay_.channel_.settings(scenario_.service);
    runner_.order({{"do", "start"},
                   {"service", serve_request(replay_.captures_, scenario_, settings)},
                   {"client", call_request(scenario_, 0, settings)}});
    for (const Step& step : scenario_.steps) {
      play(step);
      ++result_.checked;
    }
    return std::move(result_);
  }

 private:
  void play(const Step& step) {
    for_each_frame(step, [&](const Frame& frame) {
      if (!is(frame, EntryType::service_closed)) return;
      const std::string service = service_of(scenario_, frame.connection);
      runner_.order({{"do", "close_service"}, {"service", service}});
    });
    if (step.plan.at("op") == "sleep") return sleep(step);
    const std::string place = replay_.channel_.place(scenario_, 0);
    const Json outcome =
        runner_.ask({{"do", "step"}, {"step", told(located(step), scenario_, place)}});
    if (const ListEntry* listed = deviation_of(step))
      return judge_deviation(step, *listed, outcome);
    const auto text = fault_of_outcome(replay_.comparison_, scenario_.steps, step, outcome);
    if (text) result_.fail(step_place(step.index), step.label, *text);
  }

  // In a process there is no place but nodes: who names none means that of the scenario.
  [[nodiscard]] Step located(const Step& step) const {
    Step named = step;
    Json& plan = named.plan;
    if (plan.at("op") == "connect" && !plan.contains("nodeid") && !plan.contains("nodename")) {
      plan["nodeid"] = scenario_.service.id;
    }
    return named;
  }

  void sleep(const Step& step) {
    bool ends = false;  // the recorded client's node, which says goodbye
    for_each_frame(step, [&](const Frame& frame) {
      ends = ends || (frame.from_client && is(frame, EntryType::disconnect_client));
    });
    if (ends) runner_.order({{"do", "stop_node"}});
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
    const std::string code = outcome.value("raised", Json()).value("code", Json()).dump();
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

  InProcessReplay& replay_;
  const Scenario& scenario_;
  Runner& runner_;
  Result result_;
};

Result InProcessReplay::play(const Scenario& scenario, const std::vector<std::string>& command) {
  Runner runner(command, "both");
  return Play(*this, scenario, runner).whole();
}

}  // namespace rr::conformance
