// SPDX-License-Identifier: Apache-2.0
// A process with clients, a thread for each. Commands: `pause` ends all sessions and says what is
// left, `go` lets new ones begin, `end`.
#include <atomic>
#include <condition_variable>
#include <iostream>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "rr/node.hpp"
#include "runtime/cpp/src/node/testing/process_state.hpp"
#include "runtime/cpp/stress/roles.hpp"
#include "runtime/cpp/stress/session.hpp"

namespace rr::stress {
namespace {

/// What the threads are to do, and how many are in a session.
class Phase {
 public:
  /// Waits until sessions may run. False when there are to be no more.
  bool enter() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return is_ending_ || may_run_; });
    if (is_ending_) return false;
    ++running_;
    return true;
  }
  void leave() {
    const std::lock_guard lock(mutex_);
    --running_;
    changed_.notify_all();
  }
  [[nodiscard]] bool is_over() const { return is_over_; }
  /// Returns when no session runs any more.
  void pause() {
    std::unique_lock lock(mutex_);
    is_over_ = true;
    may_run_ = false;
    changed_.wait(lock, [&] { return running_ == 0; });
  }
  void go() {
    const std::lock_guard lock(mutex_);
    is_over_ = false;
    may_run_ = true;
    changed_.notify_all();
  }
  void end() {
    const std::lock_guard lock(mutex_);
    is_over_ = true;
    is_ending_ = true;
    changed_.notify_all();
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  bool may_run_ = true;
  bool is_ending_ = false;
  std::atomic<bool> is_over_{false};
  int running_ = 0;
};

void run_client(ChannelContext& context, Node& node, Phase& phase, std::uint32_t client,
                std::uint32_t seed) {
  const Watchdog::Entry entry(context.watchdog, "client " + std::to_string(client));
  Random random(seed * 1009 + client + 1);
  for (std::uint32_t serial = 0; phase.enter(); ++serial) {
    {
      Session session(context, entry.watched(), client, serial,
                      static_cast<std::uint32_t>(random()));
      session.use(node, [&phase] { return phase.is_over(); });
    }
    phase.leave();
  }
}

std::string done_text(const ChannelContext& context) {
  return "done sessions " + std::to_string(context.sessions) + " calls " +
         std::to_string(context.calls) + " packets " + std::to_string(context.packets) +
         " values " + std::to_string(context.values) + " events " + std::to_string(context.events);
}

}  // namespace

int use(const Options& options) {
  Lines lines;
  Watchdog watchdog(lines, hang_limit());
  SocketCutter cutter;
  ChannelContext context{lines, watchdog, cutter,
                         "rr+tcp://127.0.0.1:" + std::to_string(options.port) + "/?service=bench"};
  Node node({.request_timeout = hang_limit(),
             .connect_timeout = hang_limit(),
             .receive_timeout = hang_limit()});
  Phase phase;
  std::vector<std::thread> threads;
  for (std::uint32_t i = 0; i < options.count; ++i) {
    threads.emplace_back(
        [&, i] { run_client(context, node, phase, options.first + i, options.seed); });
  }
  for (std::string command; std::getline(std::cin, command) && command != "end";) {
    if (command == "go") phase.go();
    if (command != "pause") continue;
    phase.pause();
    lines.write(done_text(context));
    lines.write("census left 0 " + testing::ProcessState::now().text());
  }
  phase.end();
  for (std::thread& thread : threads) thread.join();
  return 0;
}

}  // namespace rr::stress
