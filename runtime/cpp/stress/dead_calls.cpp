// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/stress/dead_calls.hpp"

#include <array>
#include <atomic>
#include <cstdint>
#include <exception>
#include <future>
#include <thread>
#include <utility>

#include "rr/async.hpp"
#include "rr/locks.hpp"
#include "runtime/cpp/stress/everybody.hpp"

namespace rr::stress {
namespace {

constexpr std::array<std::uint64_t, 2> position{0, 0};
constexpr std::array<std::uint64_t, 2> count{2, 2};

}  // namespace

Mourner::Mourner(const NodeOptions& options, std::string url)
    : node_(options), url_(std::move(url)), client_(connect()) {
  part_ = client_->get_parts(0);
  echo_ = client_->echo().connect();
  mirror_ = client_->mirror().connect();
  counting_ = client_->count(1, 1000);
  closing_ = client_->count(1, 1000);
  aborting_ = client_->count(1, 1000);
  counting_.next();
}

Client<BenchStub> Mourner::connect() {
  return node_.connect<BenchStub>(
      url_,
      {.username = "mourner", .credentials = {{"password", Everybody::password_of("mourner")}}});
}

std::vector<Mourner::Call> Mourner::requests() {
  BenchStub& bench = *client_;
  return {
      {"get a property", [&] { bench.get_kept(); }},
      {"set a property", [&] { bench.set_kept(1); }},
      {"a function", [&] { bench.mix(1, 2); }},
      {"an asynchronous function",
       [&] {
         std::promise<void> ended;
         bench.async_mix(1, 2, [&](const std::exception_ptr& error, std::uint64_t) {
           error ? ended.set_exception(error) : ended.set_value();
         });
         ended.get_future().get();
       }},
      {"a callback in a function", [&] { bench.asked(1); }},
      {"an objref", [&] { bench.get_parts(7); }},
      {"the type of an object", [&] { (void)client_.find_object_type("bench.parts[8]"); }},
      {"attributes", [&] { (void)client_.fetch_attributes(); }},
      {"open a generator", [&] { (void)bench.count(1, 2); }},
      {"a step of a generator", [&] { counting_.next(); }},
      {"close a generator", [&] { closing_.close(); }},
      {"abort a generator", [&] { aborting_.abort(); }},
      {"connect a pipe", [&] { bench.lossy().connect(); }},
      {"connect a wire", [&] { bench.target().connect(); }},
      {"peek", [&] { bench.level().peek_in(); }},
      {"poke", [&] { bench.mirror().poke_out(Stamp{}); }},
      {"length of a memory", [&] { (void)bench.cells().length(); }},
      {"read a memory", [&] { (void)bench.cells().read(0, 10); }},
      {"write a memory", [&] { bench.cells().write(0, rr::Array<std::uint32_t>(10)); }},
      {"read a grid", [&] { (void)bench.grid().read(position, count); }},
      {"lock", [&] { lock(*part_); }},
      {"unlock", [&] { unlock(*part_); }},
      // With a time it would be waited for that much longer.
      {"enter a monitor", [&] { enter_monitor(*part_, std::chrono::milliseconds(0)); }},
      {"exit a monitor", [&] { exit_monitor(*part_); }},
      {"log out", [&] { client_.logout(); }},
  };
}

std::vector<std::function<bool()>> Mourner::waits(std::chrono::milliseconds limit) {
  return {
      [this, limit] { return echo_.wait(limit); },
      [this, limit] { return echo_.receive_for(limit).has_value(); },
      [this, limit] { return mirror_.wait_in(limit); },
  };
}

std::vector<Ending> run_at_once(std::vector<Mourner::Call> calls,
                                const std::function<void()>& meanwhile) {
  using Clock = std::chrono::steady_clock;
  std::vector<Ending> endings(calls.size());
  std::atomic<std::size_t> begun{0};
  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < calls.size(); ++i) {
    threads.emplace_back([&, i] {
      Ending& ending = endings[i];
      ending.name = calls[i].name;
      ++begun;
      const auto begin = Clock::now();
      try {
        calls[i].run();
      } catch (const Error& error) {
        ending.code = error.code();
        ending.text = error.what();
      }
      ending.took = std::chrono::duration_cast<std::chrono::milliseconds>(Clock::now() - begin);
    });
  }
  while (begun != calls.size()) std::this_thread::yield();
  if (meanwhile) meanwhile();
  for (std::thread& thread : threads) thread.join();
  return endings;
}

}  // namespace rr::stress
