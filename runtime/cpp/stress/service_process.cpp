// SPDX-License-Identifier: Apache-2.0
// The process with the service. Commands: `census` says what is left of the clients, `end`.
#include <atomic>
#include <iostream>
#include <memory>
#include <random>
#include <string>
#include <thread>

#include "rr/node.hpp"
#include "runtime/cpp/src/node/testing/process_state.hpp"
#include "runtime/cpp/stress/bench.hpp"
#include "runtime/cpp/stress/everybody.hpp"
#include "runtime/cpp/stress/roles.hpp"
#include "runtime/cpp/stress/watchdog.hpp"

namespace rr::stress {
namespace {

/// Sends to all clients until it ends.
class Producer {
 public:
  Producer(Lines& lines, Bench& bench, std::uint32_t seed)
      : watchdog_(lines, hang_limit()), bench_(bench), thread_([this, seed] { run(seed); }) {}
  ~Producer() {
    is_ending_ = true;
    thread_.join();
  }
  Producer(const Producer&) = delete;
  Producer& operator=(const Producer&) = delete;

 private:
  void run(std::uint32_t seed) {
    const Watchdog::Entry entry(watchdog_, "the producer");
    std::minstd_rand random(seed);
    while (!is_ending_) {
      {
        const Doing doing(entry.watched(), "sending to all");
        bench_.produce(random());
      }
      std::this_thread::sleep_for(std::chrono::microseconds(random() % 20'000) *
                                  testing::slowness());
    }
  }

  Watchdog watchdog_;
  Bench& bench_;
  std::atomic<bool> is_ending_{false};
  std::thread thread_;
};

}  // namespace

int serve(const Options& options) {
  Lines lines;
  Shared shared(lines);
  const auto bench = std::make_shared<Bench>(shared, options.clients);
  std::atomic<int> clients{0};
  Node node({.request_timeout = hang_limit(), .receive_timeout = hang_limit()});
  const Service service =
      node.register_service("bench", bench,
                            {.users = std::make_shared<Everybody>(),
                             .on_client_connected =
                                 [&clients, bench](const ServiceClient& client) {
                                   bench->remember(client.endpoint);
                                   ++clients;
                                 },
                             .on_client_disconnected =
                                 [&clients, bench](const ServiceClient& client) {
                                   bench->forget(client.endpoint);
                                   --clients;
                                 }});
  lines.write("port " + std::to_string(node.listen_tcp(0, options.host)));
  {
    const Producer producer(lines, *bench, options.seed);
    for (std::string command; std::getline(std::cin, command) && command != "end";) {
      if (command != "census") continue;
      const std::size_t left =
          service->clients().size() + static_cast<std::size_t>(clients.load()) + bench->left();
      lines.write("census left " + std::to_string(left) + ' ' +
                  testing::ProcessState::now().text() + " clients " +
                  std::to_string(service->clients().size()) + '/' + std::to_string(clients.load()) +
                  ", " + bench->text());
    }
  }
  node.shutdown();
  return 0;
}

}  // namespace rr::stress
