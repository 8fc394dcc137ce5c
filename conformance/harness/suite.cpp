// SPDX-License-Identifier: Apache-2.0
#include "conformance/harness/suite.hpp"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <iostream>
#include <regex>
#include <set>
#include <thread>

#include "conformance/harness/channels.hpp"
#include "conformance/harness/client_replay.hpp"
#include "conformance/harness/codec_check.hpp"
#include "conformance/harness/far_nodes.hpp"
#include "conformance/harness/in_process_nodes.hpp"
#include "conformance/harness/malformed.hpp"
#include "conformance/harness/plays.hpp"
#include "conformance/harness/runner_client.hpp"

namespace rr::conformance {
namespace {

// A client that somebody else starts and drives: it is told on the terminal what is expected.
class ForeignClient final : public TestedClient {
 public:
  void begin(const Scenario& scenario, int port, const Json& /*channel*/) override {
    std::cout << "\n== " << scenario.name << " " << scenario.version << ": " << scenario.about
              << "\n   client node " << scenario.client.id << " " << scenario.client.name
              << ", message version " << scenario.message_version
              << (scenario.string_table ? " with the string table" : "") << ", service at port "
              << port << std::endl;
  }
  void start(const Json& step) override {
    std::cout << "   " << (step.is_null() ? "take the node down" : step.dump()) << std::endl;
  }
  std::optional<Json> outcome(Milliseconds) override { return std::nullopt; }
  [[nodiscard]] bool tells_outcomes() const override { return false; }
  [[nodiscard]] Milliseconds patience() const override { return Milliseconds(60000); }
};

class Suite {
 public:
  explicit Suite(const Options& options)
      : options_(options),
        captures_(read_captures(options.captures)),
        comparison_(captures_),
        elsewhere_(captures_),
        expected_(options.expected ? ExpectedFailures(*options.expected, options.language)
                                   : ExpectedFailures()),
        deviations_(options.deviations
                        ? Deviations(*options.deviations, options.deviations_are_borrowed)
                        : Deviations()),
        report_(options.language, expected_, deviations_,
                options.only.empty() && options.roles.empty() && !options.connect &&
                    !options.listen && options.channels.front() == "tcp") {
    elsewhere_.expect_other_urls(true);
  }

  bool run() {
    if (captures_.scenarios.empty()) {
      throw std::runtime_error("no scenarios in " + options_.captures.string());
    }
    if (options_.connect) {
      play_foreign_service();
    } else if (options_.listen) {
      play_foreign_client();
    } else {
      play_runner();
    }
    report_.print(std::cout);
    if (!report_.holds()) print_guide();
    if (options_.json) {
      std::ofstream stream(*options_.json);
      stream << report_.json().dump(1, ' ', false, Json::error_handler_t::replace) << "\n";
    }
    return report_.holds();
  }

 private:
  // For those who have not made the folder.
  void print_guide() const {
    const std::string folder = options_.captures.string();
    std::cout << "\n`recorded` is what the folder says, `came` what the tested program did: as "
                 "service it\n"
                 "answered the recorded requests, as client it took the steps of the plan.\n"
                 "  frame N  `n` of "
              << folder << "/scenarios/SCENARIO.VERSION.json\n  step N   the N-th, from 0, of "
              << folder << "/plans/SCENARIO.json\n  case     `name` in " << folder
              << "/values-VERSION.json or malformed.json\n"
                 "One scenario alone is played with --only SCENARIO.\n";
  }

  [[nodiscard]] bool is_wanted(const std::string& name) const {
    return options_.only.empty() || std::regex_match(name, std::regex(options_.only));
  }

  [[nodiscard]] bool has(Role role) const {
    return options_.roles.empty() ||
           std::find(options_.roles.begin(), options_.roles.end(), role) != options_.roles.end();
  }

  template <class Play>
  void for_each_scenario(Play play) {
    for (const Scenario& scenario : captures_.scenarios) {
      if (is_wanted(scenario.name)) play(scenario);
    }
  }

  [[nodiscard]] std::set<int> versions_of_values() const {
    std::set<int> versions;
    for (const Value& value : captures_.values) versions.insert(value.message_version);
    return versions;
  }
  [[nodiscard]] std::set<int> versions_of_malformed() const {
    std::set<int> versions;
    for (const MalformedCase& one : captures_.malformed) versions.insert(one.message_version);
    return versions;
  }

  // What a recording is compared with depends on whether services are where they were.
  [[nodiscard]] const Comparison& comparison_for(const Channel& channel) const {
    return channel.plays_as_recorded() ? comparison_ : elsewhere_;
  }

  void play_runner() {
    const bool has_codec = is_played_over("tcp") && has(Role::decode) && has(Role::encode);
    std::vector<Result> codec;
    std::vector<Result> results;
    {
      std::jthread other;
      if (has_codec) other = std::jthread([&] { codec = check_codec(); });
      std::vector<Play> plays;
      for (const std::string& channel : options_.channels) plan(plays, channel);
      results = play_all(plays, options_.jobs);
    }
    for (Result& result : codec) report_.add(std::move(result));
    for (Result& result : results) report_.add(std::move(result));
  }

  [[nodiscard]] bool is_played_over(const std::string& channel) const {
    return std::ranges::find(options_.channels, channel) != options_.channels.end();
  }

  void plan(std::vector<Play>& plays, const std::string& channel) {
    if (channel == in_process) return plan_in_process(plays);
    if (is_over_broker(channel)) return plan_over_broker(plays, channel);
    if (has(Role::service)) {
      for_each_scenario([&](const Scenario& scenario) {
        plays.push_back({run_of(scenario, Role::service, channel),
                         [&](Channel& over) { return serve(scenario, over); }});
      });
    }
    if (has(Role::client)) {
      for_each_scenario([&](const Scenario& scenario) {
        if (scenario.hand_made) return;
        plays.push_back({run_of(scenario, Role::client, channel),
                         [&](Channel& over) { return call(scenario, over); }});
      });
    }
    if (!has(Role::service) || !is_wanted("malformed")) return;
    for (const int version : versions_of_malformed()) {
      plays.push_back({{"malformed", "v" + std::to_string(version), Role::service, channel},
                       [this, version](Channel& over) { return serve_malformed(version, over); }});
    }
  }

  // The runner's client and its service in one process, where there are no bytes to look at.
  void plan_in_process(std::vector<Play>& plays) {
    plan_outcomes(plays, std::string(in_process), [this](const Scenario& scenario, Channel& over) {
      InProcessNodes nodes(captures_, over, options_.runner);
      return OutcomeReplay(comparison_for(over), deviations_, over.name()).play(scenario, nodes);
    });
  }

  // A client that is a runner, and a service that is one, on both sides of the broker.
  void plan_over_broker(std::vector<Play>& plays, const std::string& channel) {
    plan_outcomes(plays, channel, [this](const Scenario& scenario, Channel& over) {
      FarNodes nodes(captures_, over.broker(), options_.gateway, options_.runner);
      return OutcomeReplay(comparison_for(over), deviations_, over.name())
          .play(scenario, nodes, is_expected_to_fail(scenario, Role::client, over));
    });
  }

  using PlayOutcomes = std::function<Result(const Scenario&, Channel&)>;
  void plan_outcomes(std::vector<Play>& plays, const std::string& channel,
                     const PlayOutcomes& play) {
    if (!has(Role::service) || !has(Role::client)) return;
    for_each_scenario([&](const Scenario& scenario) {
      if (scenario.hand_made) return;
      plays.push_back({run_of(scenario, Role::client, channel),
                       [&scenario, play](Channel& over) { return play(scenario, over); }});
    });
  }

  [[nodiscard]] static Run run_of(const Scenario& scenario, Role role, const std::string& channel) {
    return {scenario.name, scenario.version, role, channel};
  }

  // What messages and values mean is the same over all channels. One program decodes all, and one
  // encodes.
  std::vector<Result> check_codec() {
    std::vector<Result> results;
    Runner decoder(options_.runner, "decode");
    Runner encoder(options_.runner, "encode");
    const auto add = [&](const Run& run, const std::function<Result()>& play) {
      results.push_back(result_of(run, play));
    };
    for (const int version : versions_of_values()) {
      if (!is_wanted("values")) continue;
      const std::string name = "v" + std::to_string(version);
      add({"values", name, Role::decode},
          [&] { return check_unpacking(captures_, version, decoder); });
      add({"values", name, Role::encode},
          [&] { return check_packing(captures_, version, decoder, encoder); });
    }
    for_each_scenario([&](const Scenario& scenario) {
      add({scenario.name, scenario.version, Role::decode},
          [&] { return check_decoding(scenario, decoder); });
      add({scenario.name, scenario.version, Role::encode},
          [&] { return check_encoding(scenario, encoder); });
    });
    return results;
  }

  Result serve(const Scenario& scenario, Channel& channel) const {
    Runner runner(options_.runner, "serve");
    const Json started =
        runner.order(serve_request(captures_, scenario, channel.settings(scenario.service)));
    ServiceReplay replay(comparison_for(channel), deviations_,
                         connect_to(scenario, channel, started), [&](const std::string& service) {
                           runner.order({{"do", "close_service"}, {"service", service}});
                         });
    return replay.play(scenario, is_expected_to_fail(scenario, Role::service, channel));
  }

  static Connect connect_to(const Scenario& scenario, Channel& channel, const Json& started) {
    const int port = started.value("port", 0);
    return {channel.name(),
            [&scenario, &channel, port] { return channel.connect(scenario, "127.0.0.1", port); }};
  }

  Result call(const Scenario& scenario, Channel& channel) const {
    RunnerClient client(options_.runner);
    Listener listener = channel.listen();
    Entrance entrance(channel, scenario, listener);
    return ClientReplay(comparison_for(channel), deviations_, entrance, client)
        .play(scenario, is_expected_to_fail(scenario, Role::client, channel));
  }

  // One fault is enough to know that it still does.
  [[nodiscard]] bool is_expected_to_fail(const Scenario& scenario, Role role,
                                         const Channel& channel) const {
    return expected_.find(run_of(scenario, role, channel.name()), whole_run) != nullptr;
  }

  Result serve_malformed(int version, Channel& channel) const {
    const Scenario* scenario = captures_.find("connect", "v" + std::to_string(version));
    if (scenario == nullptr) throw std::runtime_error("no scenario connect to connect with");
    Runner runner(options_.runner, "serve");
    const Json started =
        runner.order(serve_request(captures_, *scenario, channel.settings(scenario->service)));
    return check_malformed(captures_, version, deviations_,
                           connect_to(*scenario, channel, started));
  }

  void reset_foreign_service(const std::string& scenario, const std::string& version) {
    if (options_.before.empty()) return;
    ::setenv("CONFORMANCE_SCENARIO", scenario.c_str(), 1);
    ::setenv("CONFORMANCE_VERSION", version.c_str(), 1);
    if (std::system(options_.before.c_str()) != 0) {
      throw std::runtime_error("failed: " + options_.before);
    }
  }

  // One after the other: there is one service, or one client.
  void add(const Run& run, const std::function<Result()>& play) {
    report_.add(result_of(run, play));
  }

  void play_foreign_service() {
    Channel channel("tcp");
    const Address& address = *options_.connect;
    const auto connect_as = [&](const Scenario& scenario) -> Connect {
      return {channel.name(),
              [&] { return channel.connect(scenario, address.host, address.port); }};
    };
    for_each_scenario([&](const Scenario& scenario) {
      add(run_of(scenario, Role::service, channel.name()), [&] {
        reset_foreign_service(scenario.name, scenario.version);
        ServiceReplay replay(comparison_, deviations_, connect_as(scenario),
                             [](const std::string& service) {
                               std::cout << "close the service " << service << " now" << std::endl;
                             });
        return replay.play(scenario);
      });
    });
    for (const int version : versions_of_malformed()) {
      const std::string name = "v" + std::to_string(version);
      if (!is_wanted("malformed")) continue;
      add({"malformed", name, Role::service, channel.name()}, [&] {
        const Scenario* const scenario = captures_.find("connect", name);
        if (scenario == nullptr) throw std::runtime_error("no scenario connect to connect with");
        reset_foreign_service("malformed", name);
        return check_malformed(captures_, version, deviations_, connect_as(*scenario));
      });
    }
  }

  void play_foreign_client() {
    Channel channel("tcp");
    Listener listener(*options_.listen, true);
    for_each_scenario([&](const Scenario& scenario) {
      if (scenario.hand_made) return;
      add(run_of(scenario, Role::client, channel.name()), [&] {
        ForeignClient client;
        Entrance entrance(channel, scenario, listener);
        return ClientReplay(comparison_, deviations_, entrance, client).play(scenario);
      });
    });
  }

  const Options& options_;
  Captures captures_;
  Comparison comparison_;
  Comparison elsewhere_;  // with other URLs than the recorded ones
  ExpectedFailures expected_;
  Deviations deviations_;
  Report report_;
};

}  // namespace

bool run_suite(const Options& options) { return Suite(options).run(); }

}  // namespace rr::conformance
