// SPDX-License-Identifier: Apache-2.0
// Faults of threads and links, which a run has to find: a simulation that finds nothing proves
// nothing.
#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <thread>

#include "runtime/cpp/sim/scenario.hpp"

namespace rr::sim {
namespace {

// Two threads take two locks in two orders.
void run_deadlock(Scheduler&) {
  std::mutex first;
  std::mutex second;
  std::thread other([&] {
    const std::lock_guard outer(first);
    const std::lock_guard inner(second);
  });
  {
    const std::lock_guard outer(second);
    const std::lock_guard inner(first);
  }
  other.join();
}

// The word is looked at under no lock, so the signal may come before the wait.
void run_lost_signal(Scheduler&) {
  std::mutex mutex;
  std::condition_variable changed;
  std::atomic<bool> is_done{false};
  std::thread other([&] {
    is_done = true;
    changed.notify_one();
  });
  if (!is_done) {
    std::unique_lock lock(mutex);
    changed.wait(lock);
  }
  other.join();
}

// One signal for two that wait.
void run_one_woken(Scheduler&) {
  std::mutex mutex;
  std::condition_variable changed;
  bool is_done = false;
  const auto wait = [&] {
    std::unique_lock lock(mutex);
    while (!is_done) changed.wait(lock);
  };
  std::thread first(wait);
  std::thread second(wait);
  {
    const std::lock_guard lock(mutex);
    is_done = true;
  }
  changed.notify_one();
  first.join();
  second.join();
}

// Looks under one lock and acts under another turn of it.
void run_look_then_act(Scheduler& run) {
  std::mutex mutex;
  int taken = 0;
  int left = 1;
  const auto take = [&] {
    {
      const std::lock_guard lock(mutex);
      if (left == 0) return;
    }
    const std::lock_guard lock(mutex);
    --left;
    ++taken;
  };
  std::thread other(take);
  take();
  other.join();
  if (taken != 1) run.fail("one thing is taken twice");
}

// A deadline is forgotten when a wait is woken for no reason.
void run_late_call(Scheduler& run) {
  using namespace std::chrono_literals;
  std::mutex mutex;
  std::condition_variable changed;
  std::unique_lock lock(mutex);
  for (int round = 0; round < 20; ++round) {
    const auto begin = std::chrono::steady_clock::now();
    while (changed.wait_for(lock, 1s) != std::cv_status::timeout) {
    }
    if (std::chrono::steady_clock::now() - begin > 1'300ms) run.fail("a wait of 1 s takes longer");
  }
}

// Takes one receive for one message.
void run_split_message(Scheduler& run) {
  const int listening = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  socklen_t size = sizeof address;
  static_cast<void>(::bind(listening, reinterpret_cast<sockaddr*>(&address), sizeof address));
  ::listen(listening, 1);
  ::getsockname(listening, reinterpret_cast<sockaddr*>(&address), &size);
  const int client = ::socket(AF_INET, SOCK_STREAM, 0);
  static_cast<void>(::connect(client, reinterpret_cast<sockaddr*>(&address), sizeof address));
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  const int served = ::accept4(listening, nullptr, nullptr, 0);
  std::array<char, 100> message{};
  ::send(client, message.data(), message.size(), 0);
  const auto received = ::recv(served, message.data(), message.size(), 0);
  ::close(served);
  ::close(client);
  ::close(listening);
  if (received != static_cast<ssize_t>(message.size())) run.fail("a message comes in parts");
}

// A thread that nobody waits for.
void run_left_thread(Scheduler&) {
  std::thread([] { std::this_thread::sleep_for(std::chrono::hours(1)); }).detach();
}

void run_left_descriptor(Scheduler&) { ::socket(AF_INET, SOCK_STREAM, 0); }

}  // namespace

std::span<const Planted> planted_faults() {
  static constexpr std::array<Planted, 8> all{{
      {{"deadlock", "locks in two orders", run_deadlock}, "all threads wait"},
      {{"lost_signal", "a signal before the wait", run_lost_signal}, "all threads wait"},
      {{"one_woken", "one signal for two threads", run_one_woken}, "all threads wait"},
      {{"look_then_act", "a lock is left in between", run_look_then_act}, "taken twice"},
      {{"late_call", "a wait begins anew when it is woken", run_late_call}, "takes longer"},
      {{"split_message", "a receive is taken for a message", run_split_message}, "in parts"},
      {{"left_thread", "a thread outlives its nodes", run_left_thread}, "threads are left"},
      {{"left_descriptor", "a descriptor is left", run_left_descriptor}, "descriptors are left"},
  }};
  return all;
}

}  // namespace rr::sim
