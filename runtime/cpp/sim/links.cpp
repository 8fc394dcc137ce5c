// SPDX-License-Identifier: Apache-2.0
// Links that break or fall silent, and hosts that start anew, with clients and subscriptions.
#include <atomic>
#include <chrono>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

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
using test::stress::Stamp;
using Packet = std::optional<Stamp>;

/// A host that can be replaced by a new one at the same port.
class Place {
 public:
  Place(stress::Lines& lines, std::uint64_t seed, NodeOptions options)
      : lines_(lines), seed_(seed), options_(std::move(options)) {
    begin(0);
  }
  ~Place() { end(); }
  Place(const Place&) = delete;
  Place& operator=(const Place&) = delete;

  void restart(milliseconds pause) {
    const std::uint16_t port = host_->port();
    Scheduler::current()->note("the host ends");
    end();
    std::this_thread::sleep_for(pause);
    Scheduler::current()->note("the host starts anew");
    begin(port);
  }
  Host& host() { return *host_; }

 private:
  void begin(std::uint16_t port) {
    host_ = std::make_unique<Host>(lines_, 1, options_, port);
    producer_ = std::make_unique<Producer>(host_->bench(), ++seed_, milliseconds(500));
  }
  void end() {
    producer_.reset();
    host_.reset();
  }

  stress::Lines& lines_;
  std::uint64_t seed_;
  const NodeOptions options_;
  std::unique_ptr<Host> host_;
  std::unique_ptr<Producer> producer_;
};

/// A subscription with a wire and a pipe, which come back by themselves.
class Subscriber {
 public:
  Subscriber(stress::Lines& lines, const std::string& url)
      : lines_(lines), node_(impatient_options()) {
    services_ = node_.subscribe(
        url, {.username = "subscriber",
              .credentials = {{"password", stress::Everybody::password_of("subscriber")}},
              .retry_delay = milliseconds(300)});
    services_.use_types<test::stress::BenchStub>();
    level_ = services_.subscribe_wire<Packet>("level");
    broadcast_ = services_.subscribe_pipe<Packet>("broadcast", {}, 1'000);
    subscriptions_.push_back(services_.on_connected(
        [](const SubscriptionClientId&) { expect_no_lock("a subscription's function"); }));
    subscriptions_.push_back(
        level_.on_in([](const Packet&, const TimeSpec&, const SubscriptionClientId&) {
          expect_no_lock("a subscription's value");
        }));
  }

  // A value that is sent from now on arrives.
  void expect_values(Host& host) {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(30);
    const std::uint64_t number = host.bench().level_number();
    while (true) {
      const auto value = level_.try_in();
      if (value && value->value && value->value->number > number) return;
      if (std::chrono::steady_clock::now() > deadline) {
        lines_.fault("a subscription brings no value, though all links hold");
      }
      std::this_thread::sleep_for(milliseconds(20));
    }
  }

 private:
  stress::Lines& lines_;
  Node node_;
  ServiceSubscription services_;
  WireSubscription<Packet> level_;
  PipeSubscription<Packet> broadcast_;
  std::vector<Subscription> subscriptions_;
};

void break_something(Network& network, Place& place, Random& random, bool is_scarce) {
  if (!is_scarce && random.once_in(4)) return place.restart(milliseconds(random.below(2'000)));
  const auto streams = network.streams();
  if (streams.empty()) return;
  Stream& one = *streams[random.below(streams.size())];
  const std::string name =
      "connection " + std::to_string(one.local_port) + " to " + std::to_string(one.remote_port);
  Scheduler& run = *Scheduler::current();
  switch (random.below(3)) {
    case 0:
      run.note(name + " is reset");
      return one.reset();
    case 1:
      run.note(name + " falls silent");
      return one.fall_silent();
    default:
      run.note(name + " is shut down");
      return one.shut_down(true, true);
  }
}

void run_with_visitors(Scheduler& run, bool is_scarce) {
  Faults::spare_this_thread();
  stress::Lines lines;
  Random random(run.random().next());
  NodeOptions options = impatient_options();
  const Visitor::Terms terms{is_scarce, random.once_in(2)};
  if (terms.generators_stay) options.generator_timeout = milliseconds::max();
  Place place(lines, random.next(), options);
  const std::string url = place.host().url();
  {
    std::atomic<bool> is_over{false};
    const auto visitors_count = 1 + random.below(2);
    std::vector<std::unique_ptr<Visitor>> visitors;
    for (std::uint64_t i = 0; i < visitors_count; ++i) {
      Visitor::Terms own = terms;
      own.own_part += static_cast<std::int32_t>(i);
      visitors.push_back(
          std::make_unique<Visitor>(lines, url, "visitor" + std::to_string(i), random.next(), own));
    }
    std::unique_ptr<Subscriber> subscriber;
    if (random.once_in(2)) subscriber = std::make_unique<Subscriber>(lines, url);
    std::vector<std::thread> threads;
    for (const auto& each : visitors) {
      threads.emplace_back(
          [&is_over, &each] { each->visit([&is_over] { return is_over.load(); }); });
    }
    if (is_scarce) {
      const std::uint64_t kind = random.below(3);
      if (kind != 0) Faults::current().refused_memory = 2 + random.below(500);
      if (kind != 1) Faults::current().refused_threads = 2 + random.below(10);
      run.note("memory is refused once in " + std::to_string(Faults::current().refused_memory) +
               ", threads once in " + std::to_string(Faults::current().refused_threads));
    }
    for (std::uint64_t left = 1 + random.below(6); left != 0; --left) {
      std::this_thread::sleep_for(milliseconds(random.below(random.once_in(4) ? 60'000 : 3'000)));
      break_something(*Network::current(), place, random, is_scarce);
    }
    Faults::current().refused_memory = 0;
    Faults::current().refused_threads = 0;
    is_over = true;
    for (std::thread& each : threads) each.join();
    visitors.clear();
    // A user of its own: a lock lasts as long as its user has a session.
    Visitor(lines, url, "inspector", random.next(), {}).expect_all_well();
    if (subscriber) subscriber->expect_values(place.host());
  }
  place.host().expect_nothing_left(std::chrono::seconds(60));
}

}  // namespace

void run_links(Scheduler& run) { run_with_visitors(run, false); }
void run_scarce(Scheduler& run) { run_with_visitors(run, true); }

}  // namespace rr::sim
