// SPDX-License-Identifier: Apache-2.0
#include "conformance/harness/plays.hpp"

#include <atomic>
#include <chrono>
#include <iostream>
#include <map>
#include <memory>
#include <sstream>
#include <string>
#include <thread>

namespace rr::conformance {

Result result_of(const Run& run, const std::function<Result()>& play) {
  const auto begun = std::chrono::steady_clock::now();
  Result result;
  try {
    result = play();
  } catch (const std::exception& error) {
    result.run = run;
    result.fail(std::string(whole_run), "", error.what());
  }
  const auto spent = std::chrono::steady_clock::now() - begun;
  std::ostringstream line;  // written at once: others write theirs
  line << name_of(run.role) << " " << run.channel << " " << run.scenario << " " << run.version
       << ": "
       << (result.faults.empty() ? "as recorded" : std::to_string(result.faults.size()) + " faults")
       << ", " << std::chrono::duration_cast<Milliseconds>(spent).count() << " ms\n";
  std::clog << line.str();
  return result;
}

std::vector<Result> play_all(const std::vector<Play>& plays, std::size_t at_once) {
  std::vector<Result> results(plays.size());
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    std::map<std::string, std::unique_ptr<Channel>> channels;
    for (std::size_t i = next++; i < plays.size(); i = next++) {
      const Play& one = plays[i];
      results[i] = result_of(one.run, [&] {
        std::unique_ptr<Channel>& channel = channels[one.run.channel];
        if (!channel) channel = std::make_unique<Channel>(one.run.channel);
        channel->renew();
        return one.play(*channel);
      });
    }
  };
  std::vector<std::jthread> workers;
  for (std::size_t i = 1; i < at_once; ++i) workers.emplace_back(work);
  work();
  workers.clear();
  return results;
}

}  // namespace rr::conformance
