// SPDX-License-Identifier: Apache-2.0
// NodeSetup::wait(): what ends it, and what the service manager hears.
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <future>
#include <string>
#include <thread>
#include <vector>

#include "rr/setup.hpp"
#include "runtime/cpp/src/node/testing/notify_socket.hpp"
#include "runtime/cpp/src/node/testing/pair.hpp"

namespace rr::testing {
namespace {

SetupOptions quiet() {
  SetupOptions options = SetupOptions::server("", 0);
  options.local_enable = options.intra_enable = false;
  options.discovery_announce_enable = options.discovery_listening_enable = false;
  options.log_level = "disable";
  return options;
}

bool is_default(int signal) {
  struct sigaction action {};
  sigaction(signal, nullptr, &action);
  return action.sa_handler == SIG_DFL;
}

TEST(Wait, EndsWithASignalAndLeavesSignalsAsTheyWere) {
  NodeSetup setup(quiet());
  for (const int signal : {SIGTERM, SIGINT}) {
    ASSERT_TRUE(is_default(signal));
    std::thread sender([&] {
      EXPECT_TRUE(eventually([&] { return !is_default(signal); }));
      kill(getpid(), signal);
    });
    EXPECT_EQ(setup.wait(), signal);
    sender.join();
    EXPECT_TRUE(is_default(signal));
  }
}

TEST(Wait, TakesSignalsThatTheProgramHasBlocked) {
  sigset_t blocked;
  sigset_t before;
  sigset_t after;
  sigemptyset(&blocked);
  sigaddset(&blocked, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &blocked, &before);
  NodeSetup setup(quiet());
  kill(getpid(), SIGTERM);  // waits for wait()
  EXPECT_EQ(setup.wait(), SIGTERM);
  pthread_sigmask(SIG_SETMASK, &before, &after);
  EXPECT_TRUE(sigismember(&after, SIGTERM)) << "is blocked again";
}

TEST(Wait, EndsWhenTheProgramSaysSo) {
  NodeSetup setup(quiet());
  setup.end_wait();
  EXPECT_EQ(setup.wait(), 0);
  NodeSetup other(quiet());
  auto waiting = std::async(std::launch::async, [&] { return other.wait(); });
  EXPECT_TRUE(eventually([] { return !is_default(SIGTERM); }));
  EXPECT_EQ(code_of([&] { setup.wait(); }), ErrorCode::invalid_operation);
  other.end_wait();
  EXPECT_EQ(waiting.get(), 0);
}

TEST(Wait, TellsTheServiceManager) {
  for (const std::string& name :
       {test_folder() + "/notify", "@rr-notify-" + std::to_string(getpid())}) {
    const NotifySocket manager(name);
    ASSERT_TRUE(manager.is_bound()) << name;
    NodeSetup setup(quiet());
    auto waiting = std::async(std::launch::async, [&] { return setup.wait(); });
    EXPECT_EQ(manager.next(), "READY=1");
    EXPECT_TRUE(notify_service_manager("STATUS=three clients"));
    EXPECT_EQ(manager.next(), "STATUS=three clients");
    setup.end_wait();
    waiting.wait();
    EXPECT_EQ(manager.next(), "STOPPING=1");
  }
  EXPECT_FALSE(notify_service_manager("READY=1")) << "there is no service manager";
}

TEST(Wait, FeedsTheWatchdogOfThisProcessOnly) {
  const NotifySocket manager(test_folder() + "/fed");
  setenv("WATCHDOG_USEC", "20000", 1);
  setenv("WATCHDOG_PID", std::to_string(getpid() + 1).c_str(), 1);
  NodeSetup setup(quiet());
  setup.end_wait();
  setup.wait();
  EXPECT_EQ(manager.next(), "READY=1");
  EXPECT_EQ(manager.next(), "STOPPING=1");
  setenv("WATCHDOG_PID", std::to_string(getpid()).c_str(), 1);
  NodeSetup fed(quiet());
  auto waiting = std::async(std::launch::async, [&] { return fed.wait(); });
  int fed_times = 0;
  while (fed_times < 3) {
    const std::string next = manager.next();
    ASSERT_NE(next, "") << "after " << fed_times;
    fed_times += next == "WATCHDOG=1" ? 1 : 0;
  }
  fed.end_wait();
  waiting.wait();
  unsetenv("WATCHDOG_USEC");
  unsetenv("WATCHDOG_PID");
}

// Threads of the program all in handlers that do not return: the process lives, and does nothing.
TEST(Wait, DoesNotFeedTheWatchdogOfANodeThatIsStuck) {
  const NotifySocket manager(test_folder() + "/stuck");
  setenv("WATCHDOG_USEC", "100000", 1);
  SetupOptions options = quiet();
  options.node.max_threads = 2;
  NodeSetup setup(options);
  std::promise<void> go_on;
  const std::shared_future<void> may_go_on = go_on.get_future();
  auto waiting = std::async(std::launch::async, [&] { return setup.wait(); });
  std::string next = manager.next();
  while (next != "WATCHDOG=1" && !next.empty()) next = manager.next();
  ASSERT_EQ(next, "WATCHDOG=1");
  std::vector<Timer> blocking;
  for (int i = 0; i < 8; ++i) {
    blocking.push_back(
        setup->after(std::chrono::nanoseconds(0), [may_go_on] { may_go_on.wait(); }));
  }
  // What was on its way comes in, and then nothing for many periods.
  for (int silent = 0, heard = 0; silent < 10; ++silent) {
    if (manager.next(100).empty()) continue;
    silent = 0;
    ASSERT_LT(++heard, 1000) << "it is fed on";
  }
  go_on.set_value();
  EXPECT_EQ(manager.next(), "WATCHDOG=1");
  setup.end_wait();
  waiting.wait();
  unsetenv("WATCHDOG_USEC");
}

}  // namespace
}  // namespace rr::testing
