// SPDX-License-Identifier: Apache-2.0
// The bench as a program, for tests in which service and command line run on different systems:
// prints `ready: URL`, and ends with its standard input.
#include <atomic>
#include <chrono>
#include <cstdio>
#include <exception>
#include <thread>

#include "cli/live/testing/bench_service.hpp"
#include "rr/node.hpp"

int main() {
  try {
    const auto bench = std::make_shared<robdef::testing::Bench>();
    rr::Node node;
    const auto service = node.register_service("bench", bench);
    const auto port = node.listen_tcp(0, "127.0.0.1");
    std::printf("ready: rr+tcp://127.0.0.1:%u/?service=bench\n", unsigned{port});
    std::fflush(stdout);
    std::atomic<bool> is_over = false;
    std::thread values([&] {
      for (int number = 0; !is_over; ++number) {
        bench->level().set_in(number);
        bench->ticked(number, "a tick");
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
      }
    });
    while (std::getchar() != EOF) continue;
    is_over = true;
    values.join();
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench: %s\n", error.what());
    return 1;
  }
}
