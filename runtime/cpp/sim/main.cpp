// SPDX-License-Identifier: Apache-2.0
#include <malloc.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/personality.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <string_view>
#include <thread>

#include "runtime/cpp/sim/faults.hpp"
#include "runtime/cpp/sim/network.hpp"
#include "runtime/cpp/sim/scenario.hpp"
#include "runtime/cpp/sim/scheduler.hpp"

namespace rr::sim {
namespace {

constexpr const char* usage =
    "usage: rr_sim [--scenario NAME] [--seed N | --from N --count N | --seconds S] [--repeat]\n"
    "  --seed N     one run, and its last steps (RR_SIM_STEPS of them) when it fails\n"
    "  --count N    so many seeds, from 1 or --from on; stops at none\n"
    "  --seconds S  as many seeds as there is time for\n"
    "  --repeat     each seed twice: both runs must be the same\n";

struct Options {
  const Scenario* scenario = nullptr;  // null: each seed has one
  std::uint64_t from = 1;
  std::uint64_t count = 1;
  std::chrono::seconds time{0};
  bool repeats = false;
};

/// What a run leaves.
struct Result {
  Nanoseconds simulated;
  std::uint64_t steps;
  std::uint64_t hash;
};

std::uint64_t one_of(Random& random, std::initializer_list<std::uint64_t> values) {
  return *(values.begin() + random.below(values.size()));
}

Turns draw_turns(Random& random) {
  Turns turns;
  turns.has_ranks = random.once_in(3);
  turns.switches_once_in =
      turns.has_ranks ? one_of(random, {10, 50, 300}) : one_of(random, {0, 2, 5, 20, 200});
  turns.stalls_once_in = one_of(random, {0, 0, 500, 5'000});
  turns.longest_stall = static_cast<Nanoseconds>(one_of(random, {1, 20, 400})) * 1'000'000;
  return turns;
}

void draw_faults(Random& random, Faults& faults) {
  faults.spurious_wake_ups = one_of(random, {0, 0, 10, 100});
  faults.longest_delay = static_cast<Nanoseconds>(one_of(random, {1, 50, 1'000, 30'000})) * 1'000;
  faults.split_segments = one_of(random, {0, 0, 2, 10});
  faults.smallest_window = one_of(random, {16'000, 100'000});
  faults.largest_window = faults.smallest_window + one_of(random, {0, 10'000, 200'000});
}

void simulate(const Scenario& scenario, std::uint64_t seed, Result& result) {
  Random random(seed);
  const Turns turns = draw_turns(random);
  draw_faults(random, Faults::current());
  Scheduler run(random.next(), turns);
  Network network(run);
  scenario.run(run);
  // Threads that nobody joins have their last steps to do.
  std::this_thread::sleep_for(std::chrono::seconds(2));
  if (run.alive() != 1) run.fail("threads are left");
  if (network.open_count() != 0) run.fail("descriptors are left");
  result = {run.now(), run.trace().count(), run.trace().hash()};
}

const Scenario& scenario_of(const Options& options, std::uint64_t seed) {
  if (options.scenario != nullptr) return *options.scenario;
  return scenarios()[seed % scenarios().size()];
}

// In a process of its own: a run ends where it fails, and nothing of it reaches the next one.
bool simulate_aside(const Options& options, std::uint64_t seed, Result& result) {
  static auto* const shared = static_cast<Result*>(
      ::mmap(nullptr, sizeof(Result), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0));
  std::fflush(stdout);
  const pid_t child = ::fork();
  if (child == 0) {
    ::alarm(20);
    simulate(scenario_of(options, seed), seed, *shared);
    _exit(0);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  result = *shared;
  if (WIFSIGNALED(status)) {
    std::printf("FAILED: ended by signal %d (%s)\n", WTERMSIG(status), strsignal(WTERMSIG(status)));
  }
  return status == 0;
}

std::string again(const Options& options, std::uint64_t seed) {
  return std::string("rr_sim --scenario ") + scenario_of(options, seed).name + " --seed " +
         std::to_string(seed);
}

int sweep(const Options& options) {
  using Clock = std::chrono::steady_clock;
  const auto begin = Clock::now();
  std::uint64_t runs = 0;
  std::uint64_t failures = 0;
  std::uint64_t steps = 0;
  Nanoseconds simulated = 0;
  const auto goes_on = [&] {
    return options.time.count() == 0 ? runs < options.count : Clock::now() - begin < options.time;
  };
  for (std::uint64_t seed = options.from; goes_on(); ++seed, ++runs) {
    Result result{};
    bool is_good = simulate_aside(options, seed, result);
    if (is_good && options.repeats) {
      const Result first = result;
      is_good = simulate_aside(options, seed, result);
      if (is_good && first.hash != result.hash) {
        std::printf("FAILED: two runs differ: %llu and %llu steps\n",
                    static_cast<unsigned long long>(first.steps),
                    static_cast<unsigned long long>(result.steps));
        is_good = false;
      }
    }
    if (!is_good) {
      ++failures;
      std::printf("  again: %s\n", again(options, seed).c_str());
    }
    simulated += result.simulated;
    steps += result.steps;
  }
  const std::chrono::duration<double> took = Clock::now() - begin;
  const double hours = static_cast<double>(simulated) / 3.6e12;
  std::printf(
      "%llu seeds, %llu failed; %.2f hours simulated in %.1f s (%.0f per hour), %.1f "
      "million steps\n",
      static_cast<unsigned long long>(runs), static_cast<unsigned long long>(failures), hours,
      took.count(), hours * 3600 / took.count(), static_cast<double>(steps) / 1e6);
  return failures == 0 ? 0 : 1;
}

bool read_options(int count, char** words, Options& options) {
  for (int i = 1; i < count; ++i) {
    const std::string_view word = words[i];
    if (word == "--repeat") {
      options.repeats = true;
      continue;
    }
    if (i + 1 == count) return false;
    const char* const value = words[++i];
    const std::uint64_t number = std::strtoull(value, nullptr, 10);
    if (word == "--scenario") {
      for (const Scenario& each : scenarios()) {
        if (std::strcmp(each.name, value) == 0) options.scenario = &each;
      }
      if (options.scenario == nullptr) return false;
    } else if (word == "--seed" || word == "--from") {
      options.from = number;
    } else if (word == "--count") {
      options.count = number;
    } else if (word == "--seconds") {
      options.time = std::chrono::seconds(number);
    } else {
      return false;
    }
  }
  return true;
}

// Addresses are the same in each process, and memory is given out in one order. One processor:
// threads take turns anyway, and pass them on faster there.
void settle(char** words) {
  cpu_set_t allowed;
  CPU_ZERO(&allowed);
  CPU_SET(::sched_getcpu(), &allowed);
  ::sched_setaffinity(0, sizeof allowed, &allowed);
  const int kind = ::personality(0xffffffff);
  if ((kind & ADDR_NO_RANDOMIZE) != 0 || std::getenv("RR_SIM_SETTLED") != nullptr) return;
  ::setenv("RR_SIM_SETTLED", "1", 1);
  ::setenv("GLIBC_TUNABLES", "glibc.malloc.arena_max=1:glibc.malloc.tcache_count=0", 1);
  ::personality(static_cast<unsigned long>(kind) | ADDR_NO_RANDOMIZE);
  ::execv("/proc/self/exe", words);
}

}  // namespace

std::span<const Scenario> scenarios() {
  static constexpr std::array<Scenario, 3> all{{
      {"sessions", "clients that use all members of a service", run_sessions},
      {"links", "links that break and hosts that start anew", run_links},
      {"scarce", "links that break, and memory and threads that are refused", run_scarce},
  }};
  return all;
}

}  // namespace rr::sim

int main(int count, char** words) {
  rr::sim::Options options;
  if (!rr::sim::read_options(count, words, options)) {
    std::fputs(rr::sim::usage, stderr);
    return 2;
  }
  rr::sim::settle(words);
  return rr::sim::sweep(options);
}
