// SPDX-License-Identifier: Apache-2.0
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
#include <initializer_list>
#include <string>
#include <thread>

#include "runtime/cpp/sim/context.hpp"
#include "runtime/cpp/sim/faults.hpp"
#include "runtime/cpp/sim/network.hpp"
#include "runtime/cpp/sim/options.hpp"
#include "runtime/cpp/sim/scenario.hpp"
#include "runtime/cpp/sim/scheduler.hpp"

namespace rr::sim {
namespace {

using Number = unsigned long long;

// Of the system's time: a run that takes longer goes round in circles.
constexpr unsigned longest_run = 60;
// A planted fault must be found by one of so many seeds.
constexpr std::uint64_t planted_seeds = 300;

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
  faults.lost_datagrams = one_of(random, {0, 3, 20});
  faults.doubled_datagrams = one_of(random, {0, 5});
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

// In a process of its own: a run ends where it fails, and nothing of it reaches the next one.
// `output`, if any, gets what a failure prints.
bool simulate_aside(const Wanted& wanted, Result& result, std::string* output = nullptr) {
  static auto* const shared = static_cast<Result*>(
      ::mmap(nullptr, sizeof(Result), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0));
  *shared = {};
  std::array<int, 2> ends{-1, -1};
  if (output != nullptr && ::pipe(ends.data()) != 0) return false;
  std::fflush(stdout);
  const pid_t child = ::fork();
  if (child == 0) {
    if (output != nullptr) ::dup2(ends[1], STDOUT_FILENO);
    ::alarm(longest_run);
    simulate(*wanted.scenario, wanted.seed, *shared);
    _exit(0);
  }
  if (output != nullptr) {
    ::close(ends[1]);
    std::array<char, 4096> part{};
    for (ssize_t size = 0; (size = ::read(ends[0], part.data(), part.size())) > 0;) {
      output->append(part.data(), static_cast<std::size_t>(size));
    }
    ::close(ends[0]);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  result = *shared;
  if (WIFSIGNALED(status)) {
    std::printf("FAILED: ended by signal %d (%s)\n", WTERMSIG(status), strsignal(WTERMSIG(status)));
  }
  return status == 0;
}

/// Runs, and what they come to.
class Sweep {
 public:
  explicit Sweep(bool repeats) : repeats_(repeats) {}

  void run(const Wanted& wanted) {
    ++runs_;
    Result result{};
    if (!is_good(wanted, result)) {
      ++failures_;
      std::printf("  again: rr_sim --scenario %s --seed %llu\n", wanted.scenario->name,
                  static_cast<Number>(wanted.seed));
    }
    simulated_ += result.simulated;
    steps_ += result.steps;
  }
  [[nodiscard]] std::uint64_t runs() const { return runs_; }
  [[nodiscard]] bool has_failed() const { return failures_ != 0; }
  [[nodiscard]] std::chrono::duration<double> took() const { return Clock::now() - begin_; }

  /// Says what was done; the exit code.
  [[nodiscard]] int finish() const {
    const double hours = static_cast<double>(simulated_) / 3.6e12;
    std::printf(
        "%llu seeds, %llu failed; %.2f hours simulated in %.1f s (%.0f per hour), %.1f "
        "million steps\n",
        static_cast<Number>(runs_), static_cast<Number>(failures_), hours, took().count(),
        hours * 3600 / took().count(), static_cast<double>(steps_) / 1e6);
    return failures_ == 0 ? 0 : 1;
  }

 private:
  using Clock = std::chrono::steady_clock;

  [[nodiscard]] bool is_good(const Wanted& wanted, Result& result) const {
    if (!simulate_aside(wanted, result)) return false;
    if (!repeats_) return true;
    const Result first = result;
    // However threads pass on their turns.
    Context::is_switched = false;
    const bool is_good_again = simulate_aside(wanted, result);
    Context::is_switched = Context::can_be_switched();
    if (!is_good_again) return false;
    if (first.hash == result.hash) return true;
    std::printf("FAILED: two runs differ: %llu and %llu steps\n", static_cast<Number>(first.steps),
                static_cast<Number>(result.steps));
    return false;
  }

  const bool repeats_;
  const Clock::time_point begin_ = Clock::now();
  std::uint64_t runs_ = 0;
  std::uint64_t failures_ = 0;
  std::uint64_t steps_ = 0;
  Nanoseconds simulated_ = 0;
};

int sweep(const Options& options) {
  Sweep sweep(options.repeats);
  if (!options.seeds_file.empty()) {
    for (const Wanted& each : read_seeds(options.seeds_file)) sweep.run(each);
    return sweep.finish();
  }
  for (std::uint64_t seed = options.from;; ++seed) {
    if (options.stops_at_first && sweep.has_failed()) return sweep.finish();
    const bool goes_on =
        options.time.count() == 0 ? sweep.runs() < options.count : sweep.took() < options.time;
    if (!goes_on) return sweep.finish();
    const Scenario& each = scenarios()[seed % scenarios().size()];
    sweep.run({options.scenario == nullptr ? &each : options.scenario, seed});
  }
}

bool is_found(const Planted& planted) {
  for (std::uint64_t seed = 1; seed <= planted_seeds; ++seed) {
    Result result{};
    std::string output;
    if (simulate_aside({&planted.scenario, seed}, result, &output)) continue;
    const bool is_right = output.find(planted.found) != std::string::npos;
    std::printf("%-16s %s by seed %llu\n", planted.scenario.name,
                is_right ? "found" : "FAILED otherwise", static_cast<Number>(seed));
    if (!is_right) std::printf("%s\n", output.c_str());
    return is_right;
  }
  std::printf("%-16s NOT FOUND by %llu seeds: %s\n", planted.scenario.name,
              static_cast<Number>(planted_seeds), planted.scenario.what);
  return false;
}

int look_for_planted() {
  int missing = 0;
  for (const Planted& each : planted_faults()) {
    if (!is_found(each)) ++missing;
  }
  return missing == 0 ? 0 : 1;
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
  static constexpr std::array<Scenario, 6> all{{
      {"sessions", "clients that use all members of a service", run_sessions},
      {"links", "links that break and hosts that start anew", run_links},
      {"scarce", "links that break, and memory and threads that are refused", run_scarce},
      {"finding", "nodes that find each other by datagrams", run_finding},
      {"inside", "clients in the process of their service", run_inside},
      {"streaming", "packets that come faster than they are handled", run_streaming},
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
  return options.looks_for_planted ? rr::sim::look_for_planted() : rr::sim::sweep(options);
}
