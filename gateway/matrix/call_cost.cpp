// SPDX-License-Identifier: Apache-2.0
// What a call through two gateways costs, beside a direct call and a hop over the broker alone, all
// on this machine and in turns.
//   gateway_call_cost [ROUNDS [CALLS]]
// Prints the median times of each round, and the last line of all rounds: a call through gateways,
// as parts of four direct calls and two hops.
#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "gateway/carriers.hpp"
#include "gateway/matrix/probe_broker.hpp"
#include "gateway/testing/mosquitto_broker.hpp"
#include "gateway/testing/rig.hpp"
#include "gateway/testing/waiting.hpp"
#include "rr/dynamic.hpp"

namespace rr::gateway::matrix {
namespace {

using Clock = std::chrono::steady_clock;

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Microseconds that `once` takes, so many times.
template <class Once>
std::vector<double> times_of(int count, Once once) {
  std::vector<double> times;
  for (int i = 0; i < count; ++i) {
    const auto begun = Clock::now();
    once();
    times.push_back(std::chrono::duration<double, std::micro>(Clock::now() - begun).count());
  }
  return times;
}

/// A message from one connection of the broker's library to another, which is waited for.
class Hop {
 public:
  explicit Hop(const ProbeOptions& options)
      : sender_(make_mqtt_probe(options)), reader_(make_mqtt_probe(options)) {
    reader_->subscribe([this](const std::string&) { arrived_.add(1); });
  }
  void operator()() {
    sender_->publish("hop", payload_);
    if (!arrived_.wait_for(++sent_)) throw std::runtime_error("a message has not arrived");
  }

 private:
  const std::string payload_ = std::string(32, 'x');  // about as the arguments of the call
  testing::Kept<int> arrived_;
  std::size_t sent_ = 0;
  std::unique_ptr<ProbeBroker> sender_;
  std::unique_ptr<ProbeBroker> reader_;
};

void run(int rounds, int calls) {
  testing::MosquittoBroker broker;
  broker.configure({});
  broker.start();
  BrokerOptions options;
  options.url = broker.url(false);
  testing::Rig rig([&] { return make_carriers(options); });
  Node node;
  const auto near = dynamic::connect(node, rig.robot.url(), testing::Rig::login());
  const auto far = rig.connect();
  ProbeOptions probe;
  probe.url = broker.url(false);
  Hop hop(probe);
  std::vector<double> direct;
  std::vector<double> through;
  std::vector<double> hops;
  for (int round = 0; round < rounds; ++round) {
    const auto add = [](std::vector<double>& all, const std::vector<double>& times) {
      all.insert(all.end(), times.begin(), times.end());
      return median(times);
    };
    const double one = add(direct, times_of(calls, [&] { near->call("add", {1, 2}); }));
    const double two = add(hops, times_of(calls, [&] { hop(); }));
    const double three = add(through, times_of(calls, [&] { far->call("add", {1, 2}); }));
    std::cout << "direct " << one << " us, hop " << two << " us, through gateways " << three
              << " us\n";
  }
  const double allowed = 4 * median(direct) + 2 * median(hops);
  std::cout << "all: direct " << median(direct) << " us, hop " << median(hops)
            << " us, through gateways " << median(through) << " us, " << median(through) / allowed
            << " of four direct calls and two hops\n";
}

}  // namespace
}  // namespace rr::gateway::matrix

int main(int count, char** words) {
  const int rounds = count > 1 ? std::atoi(words[1]) : 5;
  const int calls = count > 2 ? std::atoi(words[2]) : 500;
  if (rounds < 1 || calls < 1) {
    std::cerr << "usage: gateway_call_cost [ROUNDS [CALLS]]\n";
    return 2;
  }
  try {
    if (rr::gateway::testing::MosquittoBroker::program().empty()) {
      throw std::runtime_error("mosquitto is not installed");
    }
    rr::gateway::matrix::run(rounds, calls);
  } catch (const std::exception& error) {
    std::cerr << "gateway_call_cost: " << error.what() << "\n";
    return 1;
  }
}
