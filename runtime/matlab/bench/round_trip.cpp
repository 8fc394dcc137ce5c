// SPDX-License-Identifier: Apache-2.0
// The same property, or image of 10 MB, read by generated C++: prints the median in microseconds.
// Usage: matlab_round_trip PORT property|image COUNT
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "experimental/bench.hpp"
#include "rr/node.hpp"

int main(int argc, char** argv) try {
  const std::string kind = argc == 4 ? argv[2] : "";
  if (kind != "property" && kind != "image") {
    std::fputs("usage: matlab_round_trip PORT property|image COUNT\n", stderr);
    return 2;
  }
  using Clock = std::chrono::steady_clock;
  rr::Node node;
  const auto bench = node.connect<experimental::bench::BenchStub>(
      "rr+tcp://127.0.0.1:" + std::string(argv[1]) + "/?service=bench");
  std::vector<double> times(static_cast<std::size_t>(std::max(1, std::atoi(argv[3]))));
  for (double& time : times) {
    const auto start = Clock::now();
    if (kind == "property") {
      (void)bench->get_v_double();
    } else {
      (void)bench->image(10'000'000);
    }
    time = std::chrono::duration<double, std::micro>(Clock::now() - start).count();
  }
  std::nth_element(times.begin(), times.begin() + static_cast<std::ptrdiff_t>(times.size() / 2),
                   times.end());
  std::printf("%.1f\n", times[times.size() / 2]);
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "matlab_round_trip: %s\n", error.what());
  return 1;
}
