// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/stress/hostile_attack.hpp"

#include <sched.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "rr/node.hpp"
#include "runtime/cpp/src/node/testing/child.hpp"
#include "runtime/cpp/src/node/testing/counter.hpp"

namespace rr::stress {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono_literals::operator""ms;
using std::chrono_literals::operator""s;

constexpr auto idle_time = 300ms;
constexpr auto time_to_give_back = 5s;

// Long enough for what an attack takes to be taken; figures want more.
std::chrono::seconds attack_time() {
  const char* const seconds = std::getenv("ROBDEF_ATTACK_SECONDS");
  return seconds != nullptr ? std::chrono::seconds(std::atoi(seconds)) : 1s;
}

std::size_t resident(pid_t process) {
  std::ifstream file("/proc/" + std::to_string(process) + "/statm");
  std::size_t total = 0;
  std::size_t pages = 0;
  file >> total >> pages;
  return pages * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
}

enum class Side : std::uint8_t { service, attackers };

// The calling thread, and what it starts. The service and its well-behaved client have one
// processor, the attackers the others: the time that attackers take of their own ones says nothing
// about the service.
void choose_processors(Side side) {
  static const cpu_set_t all = [] {
    cpu_set_t processors;
    CPU_ZERO(&processors);
    ::sched_getaffinity(0, sizeof processors, &processors);
    return processors;
  }();
  if (CPU_COUNT(&all) < 2) return;
  std::size_t first = 0;
  while (!CPU_ISSET(first, &all)) ++first;
  cpu_set_t chosen = all;
  CPU_CLR(first, &chosen);
  if (side == Side::service) {
    CPU_ZERO(&chosen);
    CPU_SET(first, &chosen);
  }
  ::sched_setaffinity(0, sizeof chosen, &chosen);
}

/// A client that calls every 2 ms, and takes the times: so that a hundredth of them is more than
/// one call.
class Caller {
 public:
  explicit Caller(std::uint16_t port)
      : counter_(node_.connect<testing::CounterStub>("rr+tcp://127.0.0.1:" + std::to_string(port) +
                                                     "/?service=counter")),
        thread_([this](const std::stop_token& stop) { run(stop); }) {}

  struct Times {
    double p99 = 0;
    std::size_t calls = 0;
    std::size_t failures = 0;
  };
  /// Since it was asked last.
  Times take() {
    std::vector<double> times;
    Times result;
    {
      const std::lock_guard lock(mutex_);
      times.swap(times_);
      result.failures = std::exchange(failures_, 0);
      // A call that has no answer yet counts with its time so far.
      if (is_calling_) times.push_back(since(begin_));
    }
    result.calls = times.size();
    std::sort(times.begin(), times.end());
    if (!times.empty()) result.p99 = times[times.size() * 99 / 100];
    return result;
  }

 private:
  static double since(Clock::time_point begin) {
    return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
  }
  void run(const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      {
        const std::lock_guard lock(mutex_);
        begin_ = Clock::now();
        is_calling_ = true;
      }
      bool has_failed = false;
      try {
        counter_->get_value();
      } catch (const std::exception& error) {
        std::printf("the well-behaved client: %s\n", error.what());
        has_failed = true;
      }
      {
        const std::lock_guard lock(mutex_);
        is_calling_ = false;
        times_.push_back(since(begin_));
        failures_ += has_failed ? 1 : 0;
      }
      std::this_thread::sleep_for(2ms);
    }
  }

  Node node_;
  Client<testing::CounterStub> counter_;
  std::mutex mutex_;
  std::vector<double> times_;
  Clock::time_point begin_{};
  bool is_calling_ = false;
  std::size_t failures_ = 0;
  std::jthread thread_;
};

/// The attackers, each with a thread.
class Attackers {
 public:
  Attackers(int count, std::uint16_t port, const NodeId& server, const Attack& attack) {
    for (int i = 0; i < count; ++i) {
      threads_.emplace_back([this, i, port, server, &attack] {
        choose_processors(Side::attackers);
        attack({port, server, i, sent_, is_over_});
      });
    }
  }
  void leave() {
    is_over_ = true;
    threads_.clear();
  }
  [[nodiscard]] std::size_t sent() const { return sent_; }

 private:
  std::atomic<std::size_t> sent_{0};
  std::atomic<bool> is_over_{false};
  std::vector<std::jthread> threads_;
};

}  // namespace

void Attacker::stay() const {
  while (!is_over) std::this_thread::sleep_for(10ms);
}

std::string Outcome::text() const {
  constexpr double mib = 1024 * 1024;
  char line[200];
  std::snprintf(line, sizeof line,
                "sent %.2f MiB, held %.1f MiB, kept %.1f MiB, p99 idle %.3f ms, attacked %.3f ms, "
                "%zu calls, %zu failed",
                static_cast<double>(sent) / mib, static_cast<double>(held) / mib,
                static_cast<double>(kept) / mib, idle_p99, attacked_p99, calls, failures);
  return line;
}

Outcome play(int count, const Attack& attack) {
  choose_processors(Side::service);
  testing::Child service({}, RR_HOSTILE_SERVICE);
  const auto port = static_cast<std::uint16_t>(std::stoul(service.wait_for("port")));
  const NodeId id = NodeId::parse(service.wait_for("id")).value();
  Caller caller(port);
  Outcome outcome;
  std::this_thread::sleep_for(idle_time);
  outcome.idle_p99 = caller.take().p99;
  const std::size_t idle = resident(service.id());
  const auto over = [idle](std::size_t bytes) { return bytes > idle ? bytes - idle : 0; };
  {
    Attackers attackers(count, port, id, attack);
    const Clock::time_point end = Clock::now() + attack_time();
    while (Clock::now() < end) {
      outcome.held = std::max(outcome.held, over(resident(service.id())));
      std::this_thread::sleep_for(5ms);
    }
    const Caller::Times times = caller.take();
    outcome.attacked_p99 = times.p99;
    outcome.calls = times.calls;
    outcome.failures = times.failures;
    attackers.leave();
    outcome.sent = attackers.sent();
  }
  const Clock::time_point end = Clock::now() + time_to_give_back;
  do {
    std::this_thread::sleep_for(50ms);
    const std::size_t now = over(resident(service.id()));
    outcome.held = std::max(outcome.held, now);
    outcome.kept = now;
  } while (outcome.kept > tolerance && Clock::now() < end);
  return outcome;
}

}  // namespace rr::stress
