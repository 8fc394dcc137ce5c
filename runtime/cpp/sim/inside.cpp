// SPDX-License-Identifier: Apache-2.0
// Clients in the process of their service: no socket is between them, and all holds.
#include <chrono>
#include <string>
#include <thread>
#include <vector>

#include "runtime/cpp/sim/faults.hpp"
#include "runtime/cpp/sim/host.hpp"
#include "runtime/cpp/sim/scenario.hpp"
#include "runtime/cpp/sim/visitor.hpp"

namespace rr::sim {

using std::chrono::milliseconds;
using std::chrono::seconds;

void run_inside(Scheduler& run) {
  Faults::spare_this_thread();
  stress::Lines lines;
  Random random(run.random().next());
  Host host(lines, 1, impatient_options());
  const Producer producer(host.bench(), random.next(), milliseconds(200));
  const std::string url = host.listen_inside();
  {
    std::vector<std::thread> threads;
    for (std::uint64_t i = 0, count = 1 + random.below(2); i < count; ++i) {
      threads.emplace_back([&lines, &url, i, seed = random.next()] {
        Random own(seed);
        Visitor visitor(lines, url, "visitor" + std::to_string(i), own.next(),
                        {.links_hold = true, .own_part = 12 + static_cast<std::int32_t>(i)});
        std::uint64_t left = own.below(60);
        visitor.visit([&left] { return left == 0 || --left == 0; });
      });
    }
    for (std::thread& each : threads) each.join();
    Visitor(lines, url, "inspector", random.next(), {}).expect_all_well();
  }
  host.expect_nothing_left(seconds(60));
}

}  // namespace rr::sim
