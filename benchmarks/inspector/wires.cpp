// SPDX-License-Identifier: Apache-2.0
// Serves 20 wires to a page:
//   inspector_wires RATE [FLAGS]   sends so many values a second on each, at a free port, until a
//                                  signal ends it; prints `ready: URL`
#include "experimental/wires.hpp"

#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <memory>
#include <thread>

#include "rr/node.hpp"
#include "rr/setup.hpp"

namespace {

using std::chrono_literals::operator""ms;
using experimental::wires::BenchSkeleton;

constexpr auto channels = std::to_array({
    &BenchSkeleton::channel_0,  &BenchSkeleton::channel_1,  &BenchSkeleton::channel_2,
    &BenchSkeleton::channel_3,  &BenchSkeleton::channel_4,  &BenchSkeleton::channel_5,
    &BenchSkeleton::channel_6,  &BenchSkeleton::channel_7,  &BenchSkeleton::channel_8,
    &BenchSkeleton::channel_9,  &BenchSkeleton::channel_10, &BenchSkeleton::channel_11,
    &BenchSkeleton::channel_12, &BenchSkeleton::channel_13, &BenchSkeleton::channel_14,
    &BenchSkeleton::channel_15, &BenchSkeleton::channel_16, &BenchSkeleton::channel_17,
    &BenchSkeleton::channel_18, &BenchSkeleton::channel_19,
});

[[noreturn]] void serve(int argc, char** argv) {
  const double rate = std::atof(argv[1]);
  rr::SetupOptions options = rr::SetupOptions::server("experimental.wires", 0);
  options.tcp_ws_allow_local_pages = true;
  const rr::NodeSetup setup(options, argc - 1, argv + 1);
  const auto bench = std::make_shared<BenchSkeleton>();
  setup->register_service("bench", bench);
  std::printf("ready: rr+ws://127.0.0.1:%u/?service=bench\n", unsigned{setup.port()});
  std::fflush(stdout);
  const auto begin = std::chrono::steady_clock::now();
  for (double sent = 0;; std::this_thread::sleep_for(1ms)) {
    // As many as the time says: sleeping is late at times.
    const std::chrono::duration<double> time = std::chrono::steady_clock::now() - begin;
    for (; sent < time.count() * rate; ++sent) {
      const double at = sent / rate;
      bench->position().set_in(std::sin(at));
      for (std::size_t i = 0; i < channels.size(); ++i) {
        const auto number = static_cast<double>(i);
        (bench.get()->*channels[i])().set_in(std::sin(at * (1 + number / 10)) + number);
      }
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fputs("usage: inspector_wires RATE [FLAGS]\n", stderr);
    return EXIT_FAILURE;
  }
  try {
    serve(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "inspector_wires: %s\n", error.what());
    return EXIT_FAILURE;
  }
}
