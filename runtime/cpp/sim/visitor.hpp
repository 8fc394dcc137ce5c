// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "rr/node.hpp"
#include "runtime/cpp/sim/random.hpp"
#include "runtime/cpp/stress/faults.hpp"
#include "test/stress.hpp"

namespace rr::sim {

/// Times of the nodes of scenarios in which links break: short, so that a run sees them pass.
NodeOptions impatient_options();

/// A client of a service whose links break and whose host starts anew. Its calls may fail, but end
/// in time and once; its streams may end, but have no gap.
class Visitor {
 public:
  /// What is true of the run.
  struct Terms {
    bool is_scarce = false;        ///< memory and threads may be refused to nodes
    bool generators_stay = false;  ///< the service drops none that is not used
    bool links_hold = false;       ///< all the time
    std::int32_t own_part = 12;    ///< which no other visitor uses
  };
  Visitor(stress::Lines& lines, std::string url, std::string user, std::uint64_t seed, Terms terms);

  /// Connects, does `actions` things, closes or is closed; so again until `is_over`.
  void visit(const std::function<bool()>& is_over);
  /// With links that hold: connects and has each kind of member answer.
  void expect_all_well();

 private:
  struct Streams;
  using Bench = test::stress::BenchStub;
  using Packet = std::optional<test::stress::Stamp>;

  bool connect();
  void connect_streams();
  void act();
  void use_generator();
  void keep_generator();
  void replace_part();
  void connect_while_released();
  void send_much();
  void be_asked();
  void reach_part_twice();
  void wait_in_two_threads();
  void use_part();
  void call_aside();
  void attempt(const char* what, const std::function<void()>& action,
               std::chrono::milliseconds limit);
  void settle_calls();
  void fault(const std::string& what);

  stress::Lines& lines_;
  const std::string url_;
  const std::string user_;
  Random random_;
  const Terms terms_;
  Node node_;
  Client<Bench> client_;
  std::shared_ptr<Streams> streams_;
  std::vector<Subscription> subscriptions_;
  PipeEndpoint<Packet> echo_;
  PipeEndpoint<Packet> broadcast_;
  WireConnection<Packet> level_;
  std::uint64_t sent_ = 0;
  bool holds_ = false;  // links do, and the host
};

}  // namespace rr::sim
