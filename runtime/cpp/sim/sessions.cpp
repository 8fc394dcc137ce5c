// SPDX-License-Identifier: Apache-2.0
// The sessions of the stress program, in a run: its clients know what must hold for each member.
#include <atomic>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "rr/node.hpp"
#include "runtime/cpp/sim/host.hpp"
#include "runtime/cpp/sim/network.hpp"
#include "runtime/cpp/sim/scenario.hpp"
#include "runtime/cpp/stress/roles.hpp"
#include "runtime/cpp/stress/session.hpp"

namespace rr::stress {

std::chrono::seconds hang_limit() { return std::chrono::seconds(60); }
std::chrono::seconds patience() { return std::chrono::seconds(30); }

void Lines::write(const std::string& line) {
  if (line.starts_with("fault ")) sim::Scheduler::current()->fail(line.substr(6));
}

// Sockets are named by the port of the client's side.

void SocketCutter::connect(const std::function<void()>& connecting) {
  const std::shared_lock lock(mutex_);
  connecting();
}

SocketCutter::Socket SocketCutter::connect_and_find(const std::function<void()>& connecting) {
  const std::unique_lock lock(mutex_);
  const std::set<Socket> before = sockets();
  connecting();
  for (const Socket& one : sockets()) {
    if (!before.contains(one)) return one;
  }
  return {};
}

void SocketCutter::cut(const Socket& socket, bool resets) {
  for (const auto& stream : sim::Network::current()->streams()) {
    if (std::to_string(stream->local_port) != socket) continue;
    if (resets) {
      stream->reset();
    } else {
      stream->shut_down(true, true);
    }
  }
}

std::set<SocketCutter::Socket> SocketCutter::sockets() {
  std::set<Socket> found;
  for (const auto& stream : sim::Network::current()->streams()) {
    if (stream->remote_port != 0 && stream->local_port > stream->remote_port) {
      found.insert(std::to_string(stream->local_port));
    }
  }
  return found;
}

}  // namespace rr::stress

namespace rr::sim {
namespace {

void use(stress::ChannelContext& context, Node& node, std::uint32_t client, std::uint64_t seed) {
  const stress::Watchdog::Entry entry(context.watchdog, "client " + std::to_string(client));
  Random random(seed);
  const auto sessions = static_cast<std::uint32_t>(1 + random.below(3));
  for (std::uint32_t serial = 0; serial < sessions; ++serial) {
    std::uint64_t left = random.below(12);
    stress::Session session(context, entry.watched(), client, serial,
                            static_cast<std::uint32_t>(1 + random.below(2'000'000'000)));
    session.use(node, [&left] { return left-- == 0; });
  }
}

}  // namespace

void run_sessions(Scheduler& run) {
  stress::Lines lines;
  Random random(run.random().next());
  const auto clients = static_cast<std::uint32_t>(1 + random.below(3));
  Host host(lines, clients,
            {.request_timeout = stress::hang_limit(), .receive_timeout = stress::hang_limit()});
  {
    stress::Watchdog watchdog(lines, 2 * stress::hang_limit());
    stress::SocketCutter cutter;
    stress::ChannelContext context{lines, watchdog, cutter, host.url()};
    const Producer producer(host.bench(), random.next(), std::chrono::milliseconds(20));
    Node node({.request_timeout = stress::hang_limit(),
               .connect_timeout = stress::hang_limit(),
               .receive_timeout = stress::hang_limit()});
    std::vector<std::thread> threads;
    for (std::uint32_t i = 0; i < clients; ++i) {
      threads.emplace_back([&, i, seed = random.next()] { use(context, node, i, seed); });
    }
    for (std::thread& each : threads) each.join();
  }
  // What clients had goes with them.
  host.expect_nothing_left(std::chrono::seconds(60));
}

}  // namespace rr::sim
