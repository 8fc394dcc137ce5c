// SPDX-License-Identifier: Apache-2.0
// Nodes that find each other by datagrams, of which some get lost, and hosts that come and go.
#include <chrono>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "rr/discovery.hpp"
#include "rr/subscription.hpp"
#include "runtime/cpp/sim/faults.hpp"
#include "runtime/cpp/sim/host.hpp"
#include "runtime/cpp/sim/network.hpp"
#include "runtime/cpp/sim/scenario.hpp"
#include "runtime/cpp/sim/visitor.hpp"
#include "runtime/cpp/stress/everybody.hpp"

namespace rr::sim {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using Clock = std::chrono::steady_clock;

constexpr seconds lifetime{10};

DiscoveryNetwork network_of_run() {
  return {.link_local = false, .ipv4_broadcast = true, .interfaces = {"lo"}, .port = 40'000};
}

/// A node that looks for services, and keeps a connection to each.
class Seeker {
 public:
  explicit Seeker(stress::Lines& lines) : lines_(lines), node_(impatient_options()) {
    const Discovery discovery = node_.discovery();
    discovery.listen({.network = network_of_run(), .lifetime = lifetime, .local = false});
    functions_.push_back(discovery.on_detected([this](const DetectedNode& found) {
      expect_no_lock("on_detected");
      const std::lock_guard lock(mutex_);
      if (++known_[found.id] != 1) lines_.fault("a node is detected that is known");
    }));
    functions_.push_back(discovery.on_lost([this](const DetectedNode& lost) {
      expect_no_lock("on_lost");
      const std::lock_guard lock(mutex_);
      if (--known_[lost.id] != 0) lines_.fault("a node is lost that is not known");
    }));
    services_ = node_.subscribe_type(
        "test.stress.Bench",
        {.username = "seeker",
         .credentials = {{"password", stress::Everybody::password_of("seeker")}},
         .allow_clear_credentials = true,
         .retry_delay = milliseconds(300)});
    services_.use_types<test::stress::BenchStub>();
  }

  /// Sooner or later the node knows these hosts and no others, and is connected to each.
  void expect(const std::vector<std::unique_ptr<Host>>& hosts) {
    const auto deadline = Clock::now() + seconds(90);
    while (!knows(hosts) || services_.connected_clients().size() != hosts.size()) {
      if (Clock::now() > deadline) {
        lines_.fault("of " + std::to_string(hosts.size()) + " hosts " +
                     std::to_string(services_.connected_clients().size()) + " are connected, " +
                     std::to_string(node_.discovery().detected_nodes().size()) + " detected");
      }
      std::this_thread::sleep_for(milliseconds(100));
    }
  }
  /// Asks for all services of the type.
  void find() {
    const auto begin = Clock::now();
    (void)node_.discovery().find_services("test.stress.Bench",
                                          {.wait = seconds(1), .timeout = seconds(3)});
    if (Clock::now() - begin > seconds(6) + longest_delay()) {
      lines_.fault("looking for services takes too long");
    }
  }

 private:
  bool knows(const std::vector<std::unique_ptr<Host>>& hosts) {
    const std::lock_guard lock(mutex_);
    std::size_t present = 0;
    for (const auto& [id, count] : known_) present += static_cast<std::size_t>(count);
    if (present != hosts.size()) return false;
    for (const auto& host : hosts) {
      if (known_[host->id()] != 1) return false;
    }
    return true;
  }

  stress::Lines& lines_;
  std::mutex mutex_;
  std::map<NodeId, int> known_;
  Node node_;
  ServiceSubscription services_;
  std::vector<Subscription> functions_;
};

std::unique_ptr<Host> new_host(stress::Lines& lines) {
  auto host = std::make_unique<Host>(lines, 1, impatient_options());
  host->announce(network_of_run());
  return host;
}

}  // namespace

void run_finding(Scheduler& run) {
  Faults::spare_this_thread();
  stress::Lines lines;
  Random random(run.random().next());
  std::vector<std::unique_ptr<Host>> hosts;
  for (std::uint64_t left = 1 + random.below(3); left != 0; --left)
    hosts.push_back(new_host(lines));
  {
    Seeker seeker(lines);
    for (std::uint64_t left = random.below(4); left != 0; --left) {
      std::this_thread::sleep_for(milliseconds(random.below(10'000)));
      auto& one = hosts[random.below(hosts.size())];
      switch (random.below(3)) {
        case 0:
          one.reset();
          std::this_thread::sleep_for(milliseconds(random.below(15'000)));
          one = new_host(lines);
          break;
        case 1:
          seeker.find();
          break;
        default:
          for (const auto& stream : Network::current()->streams()) stream->reset();
      }
    }
    seeker.expect(hosts);
    hosts.clear();
    seeker.expect(hosts);
  }
}

}  // namespace rr::sim
