// SPDX-License-Identifier: Apache-2.0
// A client that has everything that a service can keep for it, and does nothing more.
#include <iostream>
#include <string>

#include "rr/locks.hpp"
#include "rr/node.hpp"
#include "runtime/cpp/stress/everybody.hpp"
#include "runtime/cpp/stress/faults.hpp"
#include "runtime/cpp/stress/roles.hpp"
#include "test/stress.hpp"

namespace rr::stress {

int hold(const Options& options) {
  Lines lines;
  Node node;
  const auto bench = node.connect<test::stress::BenchStub>(
      "rr+tcp://" + options.host + ':' + std::to_string(options.port) + "/?service=bench",
      {.username = "holder", .credentials = {{"password", Everybody::password_of("holder")}}});
  bench->question().set([](std::uint64_t value) { return value; });
  const Subscription ticks = bench->ticked().connect([](std::uint64_t) {});
  const auto broadcast = bench->broadcast().connect();
  const auto echo = bench->echo().connect();
  const auto level = bench->level().connect();
  const auto mirror = bench->mirror().connect();
  auto counting = bench->count(1, 1000);
  counting.next();
  const auto locked = bench->get_parts(0);
  lock(*locked, LockOwner::session);
  const auto entered = bench->get_parts(1);
  const MonitorLock inside(*entered);
  lines.write("ready");
  std::string line;
  std::getline(std::cin, line);
  return 0;
}

}  // namespace rr::stress
