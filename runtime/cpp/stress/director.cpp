// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/stress/director.hpp"

#include <signal.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdio>
#include <sstream>
#include <thread>

#include "runtime/cpp/src/node/testing/process_state.hpp"

namespace rr::stress {
namespace {

constexpr std::uint32_t clients_of_a_process = 8;
constexpr std::size_t largest_growth = std::size_t{2} * 1024 * 1024;  // threads keep buffers

// The pairs of a name and a number in a line.
std::map<std::string, std::size_t> numbers_of(const std::string& line) {
  std::map<std::string, std::size_t> numbers;
  std::istringstream words(line);
  std::string name;
  std::size_t number = 0;
  while (words >> name >> number) numbers[name] = number;
  return numbers;
}

}  // namespace

Director::Director(const Options& options)
    : options_(options), random_(options.seed), service_{.name = "the service"} {
  for (std::uint32_t first = 0; first < options.clients; first += clients_of_a_process) {
    Process process{.name = "clients from " + std::to_string(first)};
    process.first = first;
    process.count = std::min(clients_of_a_process, options.clients - first);
    // The first lives through it all, so that what it leaves behind can be seen.
    process.is_mortal = options.may_kill && users_.size() % 2 == 1;
    users_.push_back(std::move(process));
  }
}

void Director::fault(const std::string& what) {
  ++faults_;
  std::fprintf(stderr, "FAULT %s\n", what.c_str());
}

void Director::start(Process& process) {
  const bool is_service = &process == &service_;
  process.child = std::make_unique<Child>(std::vector<std::string>{
      "--role", is_service ? "service" : "clients", "--seed", std::to_string(random_()),
      "--clients", std::to_string(options_.clients), "--port", std::to_string(service_.port),
      "--first", std::to_string(process.first), "--count", std::to_string(process.count)});
  process.next_event = next_event();
}

Director::Clock::time_point Director::next_event() {
  return Clock::now() + std::chrono::milliseconds(500 + random_() % 6000);
}

void Director::read(Process& process) {
  for (const std::string& line : process.child->take_lines()) {
    const std::string kind = line.substr(0, line.find(' '));
    const std::string rest = line.substr(std::min(line.size(), kind.size() + 1));
    if (kind == "fault") {
      fault(process.name + ": " + rest);
    } else if (kind == "port") {
      process.port = static_cast<std::uint16_t>(std::stoi(rest));
    } else if (kind == "done") {
      process.done = numbers_of(rest);
    } else if (kind == "census") {
      process.census = numbers_of(rest);
      process.census_text = rest;
      process.is_paused = true;
    }
  }
}

void Director::read_all() {
  read(service_);
  for (Process& one : users_) read(one);
}

void Director::look_after(Process& process) {
  int status = 0;
  if (process.child->has_ended() || process.child->wait(std::chrono::seconds(0), status)) {
    read(process);
    fault(process.name + " has ended by itself, status " + std::to_string(status));
    start(process);
  }
  if (!process.is_mortal || Clock::now() < process.next_event) return;
  process.next_event = next_event();
  if (random_() % 3 == 0) {
    ++stopped_;
    process.child->signal(SIGSTOP);
    std::this_thread::sleep_for(std::chrono::milliseconds(random_() % 700));
    process.child->signal(SIGCONT);
    return;
  }
  ++killed_;
  process.child->signal(SIGKILL);
  process.child->wait(patience(), status);
  read(process);
  start(process);
}

void Director::run_for(Clock::duration time) {
  const auto end = Clock::now() + time;
  while (Clock::now() < end && !service_.child->has_ended()) {
    read_all();
    for (Process& one : users_) look_after(one);
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    int status = 0;
    if (service_.child->wait(std::chrono::seconds(0), status)) {
      read(service_);
      fault("the service has ended by itself, status " + std::to_string(status));
    }
  }
}

// Ends all sessions, and waits until nothing of them is left.
void Director::pause() {
  for (Process& one : users_) {
    one.is_paused = false;
    one.child->tell("pause");
  }
  const auto deadline = Clock::now() + 2 * hang_limit();
  const auto all_paused = [&] {
    read_all();
    return std::all_of(users_.begin(), users_.end(),
                       [](const Process& one) { return one.is_paused; });
  };
  while (!all_paused() && Clock::now() < deadline) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  for (const Process& one : users_) {
    if (!one.is_paused) fault(one.name + " does not come to an end");
  }
  wait_until_quiet();
}

std::size_t Director::ask_census(Process& process) {
  process.census.reset();
  process.child->tell("census");
  const auto deadline = Clock::now() + hang_limit();
  while (!process.census && Clock::now() < deadline) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    read(process);
  }
  return process.census ? (*process.census)["left"] : 1;
}

void Director::wait_until_quiet() {
  const auto deadline = Clock::now() + patience();
  while (ask_census(service_) != 0 && Clock::now() < deadline) {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  if (ask_census(service_) != 0) fault("left in the service: " + service_.census_text);
  // Threads without work end after ten seconds.
  std::this_thread::sleep_for(std::chrono::seconds(12));
  ask_census(service_);
  for (Process& one : users_) {
    one.is_paused = false;
    one.child->tell("pause");
  }
  const auto limit = Clock::now() + patience();
  for (Process& one : users_) {
    while (!one.is_paused && Clock::now() < limit) {
      read(one);
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
  }
}

// What a process holds while it has no sessions must not grow.
void Director::compare(const Process& process) {
  if (!process.warm_census || !process.census || process.is_mortal) return;
  const Census& before = *process.warm_census;
  const Census& after = *process.census;
  const auto grows = [&](const char* what, std::size_t slack) {
    if (after.at(what) <= before.at(what) + slack) return;
    fault(process.name + ": " + what + " grew from " + std::to_string(before.at(what)) + " to " +
          std::to_string(after.at(what)));
  };
  grows("threads", 2);  // some are made when they are needed first, which may be after the warm-up
  grows("descriptors", 0);
  grows("allocated", largest_growth);
  if (testing::keeps_freed_memory()) return;
  grows("resident", 4 * largest_growth * static_cast<std::size_t>(testing::slowness()));
}

void Director::end(Process& process) {
  int status = 0;
  process.child->tell("end");
  if (!process.child->wait(hang_limit(), status)) {
    fault(process.name + " does not end");
  } else if (status != 0) {
    fault(process.name + " ended with status " + std::to_string(status));
  }
  read(process);
}

std::size_t Director::total(const std::string& what) const {
  std::size_t sum = 0;
  for (const Process& one : users_) {
    const auto place = one.done.find(what);
    if (place != one.done.end()) sum += place->second;
  }
  return sum;
}

int Director::run() {
  const auto begin = Clock::now();
  start(service_);
  while (service_.port == 0 && Clock::now() < begin + patience()) read(service_);
  for (Process& one : users_) start(one);
  // The pauses count, for what is left of the time.
  const auto warm_up = std::max<Clock::duration>(options_.seconds / 10, std::chrono::seconds(1));
  run_for(warm_up);
  pause();
  service_.warm_census = service_.census;
  for (Process& one : users_) {
    one.warm_census = one.census;
    one.child->tell("go");
  }
  run_for(options_.seconds - warm_up);
  pause();
  compare(service_);
  for (Process& one : users_) compare(one);
  for (Process& one : users_) end(one);
  const Census last = service_.census.value_or(Census{});
  end(service_);

  const auto number = [&](const char* what) {
    const auto place = last.find(what);
    return place == last.end() ? 0 : place->second;
  };
  std::printf(
      "stress: %s; %lld s, %u clients, seed %u: %zu sessions, %zu calls, %zu packets, %zu values, "
      "%zu events in processes that lived; %zu killed, %zu stopped; service at the end: %zu "
      "threads, %zu descriptors, %zu KiB allocated, %zu KiB resident; %zu faults\n",
      faults_ == 0 ? "passed" : "FAILED", static_cast<long long>(options_.seconds.count()),
      options_.clients, options_.seed, total("sessions"), total("calls"), total("packets"),
      total("values"), total("events"), killed_, stopped_, number("threads"), number("descriptors"),
      number("allocated") / 1024, number("resident") / 1024, faults_);
  return faults_ == 0 ? 0 : 1;
}

int direct(const Options& options) { return Director(options).run(); }

std::chrono::seconds hang_limit() {
  return std::chrono::seconds(120) * std::min(testing::slowness(), 3);
}
std::chrono::seconds patience() {
  return std::chrono::seconds(20) * std::min(testing::slowness(), 4);
}

}  // namespace rr::stress
