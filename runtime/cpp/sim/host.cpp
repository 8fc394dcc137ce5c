// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/sim/host.hpp"

#include <utility>

#include "runtime/cpp/sim/faults.hpp"
#include "runtime/cpp/sim/scheduler.hpp"
#include "runtime/cpp/stress/everybody.hpp"

namespace rr::sim {
namespace {

/// Those of the stress program; their code runs under no lock of the runtime.
class Visitors final : public Users {
 public:
  [[nodiscard]] User authenticate(const std::string& name,
                                  const std::map<std::string, VarValue>& credentials,
                                  const NodeId& node) const override {
    expect_no_lock("authenticate");
    return everybody_.authenticate(name, credentials, node);
  }

 private:
  stress::Everybody everybody_;
};

}  // namespace

void expect_no_lock(const char* where) {
  if (Scheduler::self().held.empty()) return;
  Scheduler::current()->fail(std::string("user code runs under a lock: ") + where);
}

std::chrono::milliseconds longest_delay() {
  return std::chrono::ceil<std::chrono::milliseconds>(
      std::chrono::nanoseconds(Scheduler::current()->longest_delay()));
}

Host::Host(stress::Lines& lines, std::uint32_t clients, NodeOptions options, std::uint16_t port)
    : shared_(lines),
      bench_(std::make_shared<stress::Bench>(shared_, clients)),
      node_(std::move(options)),
      service_(node_.register_service("bench", bench_,
                                      {.users = std::make_shared<Visitors>(),
                                       .on_client_connected =
                                           [this](const ServiceClient& client) {
                                             expect_no_lock("on_client_connected");
                                             bench_->remember(client.endpoint);
                                             ++clients_;
                                           },
                                       .on_client_disconnected =
                                           [this](const ServiceClient& client) {
                                             expect_no_lock("on_client_disconnected");
                                             bench_->forget(client.endpoint);
                                             --clients_;
                                           }})),
      port_(node_.listen_tcp(port, "127.0.0.1")) {
  shared_.longest_delay = longest_delay() + std::chrono::milliseconds(600);
}

std::string Host::url() const {
  return "rr+tcp://127.0.0.1:" + std::to_string(port_) + "/?service=bench";
}

std::string Host::listen_inside() {
  node_.listen("rr+intra://");
  return "rr+intra:///?nodeid=" + node_.id().text() + "&service=bench";
}

void Host::announce(const DiscoveryNetwork& network) {
  const Discovery discovery = node_.discovery();
  discovery.listen({.network = network, .local = false});
  discovery.announce({.network = network, .period = std::chrono::seconds(2)});
}

// Clients, their ends of pipes and wires, and generators.
std::size_t Host::left() const {
  return service_->clients().size() + static_cast<std::size_t>(clients_.load()) + bench_->left();
}

void Host::expect_nothing_left(std::chrono::seconds limit) const {
  const auto deadline = std::chrono::steady_clock::now() + limit;
  while (left() != 0) {
    if (std::chrono::steady_clock::now() > deadline) {
      Scheduler::current()->fail(
          "the service keeps what its clients had: " + std::to_string(service_->clients().size()) +
          " clients, " + bench_->text());
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
}

void Producer::produce(std::uint64_t seed) {
  Faults::spare_this_thread();
  Random random(seed);
  const auto pauses = static_cast<std::uint64_t>(longest_pause_.count());
  while (!is_ending_) {
    bench_.produce(random.next());
    std::this_thread::sleep_for(std::chrono::microseconds(random.below(pauses)));
  }
}

}  // namespace rr::sim
