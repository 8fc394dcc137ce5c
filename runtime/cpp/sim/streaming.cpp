// SPDX-License-Identifier: Apache-2.0
// Packets that come faster than they are handled.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "rr/node.hpp"
#include "runtime/cpp/sim/host.hpp"
#include "runtime/cpp/sim/scenario.hpp"
#include "runtime/cpp/sim/visitor.hpp"
#include "runtime/cpp/stress/faults.hpp"
#include "test/stress.hpp"

namespace rr::sim {
namespace {

using std::chrono::milliseconds;
using test::stress::Stamp;
using Packet = std::optional<Stamp>;

/// Takes the packets of each client in order, and is long over some of them.
class Taker final : public test::stress::BenchDefault {
 public:
  Taker(stress::Lines& lines, std::uint64_t seed, std::uint64_t rests_once_in)
      : lines_(lines), random_(seed), rests_once_in_(rests_once_in) {}

  [[nodiscard]] std::uint64_t taken() const { return taken_; }

  void rr_attached(ServiceContext& /*context*/, const std::string& /*path*/) override {
    echo().on_connect([this](PipeEndpoint<Packet> end) {
      auto numbers = std::make_shared<stress::Consecutive>(lines_, "a stream");
      end.on_packet([this, numbers](const Packet& packet) {
           expect_no_lock("a packet");
           numbers->take(packet->number);
           const milliseconds pause = draw_pause();
           if (pause.count() != 0) std::this_thread::sleep_for(pause);
           ++taken_;
         })
          .detach();
    });
  }

 private:
  milliseconds draw_pause() {
    const std::lock_guard lock(mutex_);
    return milliseconds(random_.once_in(rests_once_in_) ? random_.below(80) : 0);
  }

  stress::Lines& lines_;
  std::mutex mutex_;
  Random random_;
  const std::uint64_t rests_once_in_;
  std::atomic<std::uint64_t> taken_{0};
};

// Small packets, in bursts or one by one.
void stream(const std::string& url, std::uint64_t packets, std::uint64_t seed,
            const std::function<bool()>& are_taken) {
  Random random(seed);
  Node node(impatient_options());
  const auto client = node.connect<test::stress::BenchStub>(url);
  auto end = client->echo().connect();
  const std::uint64_t pauses_once_in = random.once_in(2) ? 1 : 1 + random.below(200);
  for (std::uint64_t number = 1; number <= packets; ++number) {
    end.send(Stamp{1, number, Array<double>(3)});
    if (random.once_in(pauses_once_in)) {
      std::this_thread::sleep_for(std::chrono::microseconds(random.below(400)));
    }
  }
  // Packets that are still under way would go with the session.
  while (!are_taken()) std::this_thread::sleep_for(milliseconds(20));
}

}  // namespace

void run_streaming(Scheduler& run) {
  stress::Lines lines;
  Random random(run.random().next());
  NodeOptions options = impatient_options();
  options.request_queue_limit = std::size_t{1'000} << random.below(11);
  const std::uint64_t rests_once_in = 1 + random.below(400);
  const auto taker = std::make_shared<Taker>(lines, random.next(), rests_once_in);
  Node node(options);
  const auto service = node.register_service("bench", taker);
  const std::uint16_t port = node.listen_tcp(0, "127.0.0.1");
  const std::string url = "rr+tcp://127.0.0.1:" + std::to_string(port) + "/?service=bench";

  const std::uint64_t packets = 100 + random.below(500);
  const std::uint64_t clients = 1 + random.below(2);
  // Each packet may take a rest, and the threads of a run may be held up at any time.
  const auto limit =
      milliseconds(80 * packets * clients) + 20 * longest_delay() + milliseconds(5'000);
  const auto deadline = std::chrono::steady_clock::now() + limit;
  const auto are_taken = [&] {
    if (taker->taken() == clients * packets) return true;
    if (std::chrono::steady_clock::now() > deadline) {
      lines.fault("a stream stands still: " + std::to_string(taker->taken()) + " of " +
                  std::to_string(clients * packets) + " packets are taken");
    }
    return false;
  };
  std::vector<std::thread> threads;
  for (std::uint64_t i = 0; i < clients; ++i) {
    threads.emplace_back([&, seed = random.next()] { stream(url, packets, seed, are_taken); });
  }
  for (std::thread& each : threads) each.join();
}

}  // namespace rr::sim
