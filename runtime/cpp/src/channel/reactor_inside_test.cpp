// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <sys/epoll.h>
#include <sys/eventfd.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <future>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>

#include "runtime/cpp/src/channel/reactor.hpp"

namespace rr::channel {
namespace {

using std::chrono_literals::operator""h;
using std::chrono_literals::operator""ms;
using std::chrono_literals::operator""s;

// An event descriptor that is watched.
class Bell final : public Pollable {
 public:
  explicit Bell(Reactor& reactor) : reactor_(reactor) {
    if (descriptor_ < 0) throw std::runtime_error("eventfd");
    reactor_.add(descriptor_, EPOLLIN, *this);
  }
  ~Bell() {
    reactor_.remove(descriptor_);
    ::close(descriptor_);
  }
  Bell(const Bell&) = delete;
  Bell& operator=(const Bell&) = delete;
  void ring() const { ::eventfd_write(descriptor_, 1); }
  std::future<void> heard() { return heard_.get_future(); }

 private:
  void on_ready(std::uint32_t) override { heard_.set_value(); }

  Reactor& reactor_;
  const int descriptor_ = ::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC);
  std::promise<void> heard_;
};

// A timer that ends when it is told to.
class LongTimer final : public Timer {
 public:
  std::promise<void> begun;
  std::promise<void> may_end;

 private:
  void on_timer() override {
    begun.set_value();
    may_end.get_future().wait();
  }
};

// In nanoseconds, as struct sched_attr says it: after 24 bytes of other things.
std::uint64_t slice_of_this_thread() {
  std::array<std::uint64_t, 7> attributes{};
  EXPECT_EQ(::syscall(SYS_sched_getattr, 0, attributes.data(), sizeof attributes, 0), 0);
  return attributes[3];
}

TEST(Reactor, StopsWhileATimerRuns) {
  const auto owner = std::make_shared<int>();
  LongTimer timer;
  std::future<void> stopped;
  {
    auto reactor = std::make_shared<Reactor>(4);
    reactor->start();
    // By then there is nothing to watch, and the watching thread sleeps without a limit.
    reactor->schedule(timer, owner, Clock::now() + 200ms);
    timer.begun.get_future().wait();
    stopped = std::async(std::launch::async, [reactor] { reactor->stop(); });
    std::this_thread::sleep_for(50ms);
    timer.may_end.set_value();
  }
  EXPECT_EQ(stopped.wait_for(10s), std::future_status::ready);
}

TEST(Reactor, PollsBesideWorkThatIsPostedAgainAndAgain) {
  Reactor reactor(4);
  reactor.start();
  Bell bell(reactor);
  std::future<void> heard = bell.heard();
  std::atomic<bool> is_over{false};
  std::promise<void> is_running;
  std::atomic<int> rounds{0};
  const std::function<void()> again = [&] {
    if (++rounds == 10) is_running.set_value();
    if (!is_over) reactor.post(again);
  };
  reactor.post(again);
  is_running.get_future().wait();
  bell.ring();
  const bool was_heard = heard.wait_for(10s) == std::future_status::ready;
  is_over = true;
  reactor.stop();
  EXPECT_TRUE(was_heard);
}

// One whose handler does not keep it.
class Frail final : public Pollable {
 public:
  Frail(std::promise<void>& entered, std::shared_future<void> left)
      : entered_(entered), left_(std::move(left)) {}
  void on_ready(std::uint32_t) override {
    entered_.set_value();
    left_.wait();
  }

 private:
  std::promise<void>& entered_;
  const std::shared_future<void> left_;
};

TEST(Reactor, KeepsWhatIsRetiredUntilTheThreadThatIsStuckInItHasLeft) {
  std::promise<void> entered;
  std::promise<void> left;
  Reactor reactor(4);
  reactor.start();
  const int descriptor = ::eventfd(1, EFD_NONBLOCK | EFD_CLOEXEC);
  auto frail = std::make_shared<Frail>(entered, left.get_future().share());
  const std::weak_ptr<Frail> watch = frail;
  reactor.add(descriptor, EPOLLIN, *frail);
  entered.get_future().wait();
  reactor.remove(descriptor);
  reactor.retire(std::move(frail));
  for (int i = 0; i < 3; ++i) {  // another thread polls
    std::promise<void> done;
    reactor.post([&] { done.set_value(); });
    done.get_future().wait();
  }
  EXPECT_FALSE(watch.expired());
  left.set_value();
  const auto deadline = std::chrono::steady_clock::now() + 10s;
  while (!watch.expired() && std::chrono::steady_clock::now() < deadline) std::this_thread::yield();
  EXPECT_TRUE(watch.expired());
  reactor.stop();
  ::close(descriptor);
}

// Whose handler does what it is given, for a session of its own.
class Guest final : public Pollable {
 public:
  Guest(Reactor& reactor, std::function<void()> handler)
      : share_(reactor.open_share("somewhere")), handler_(std::move(handler)) {}
  [[nodiscard]] std::shared_ptr<ThreadShare> thread_share() const override { return share_; }
  void on_ready(std::uint32_t) override { handler_(); }
  void on_stuck() override { was_stuck.set_value(); }
  std::promise<void> was_stuck;

 private:
  const std::shared_ptr<ThreadShare> share_;
  const std::function<void()> handler_;
};

// One trial of what follows. True when the handler that came next was taken for the one that had
// taken long, and its session for a slow one.
bool blames_next_handler() {
  std::promise<void> may_end_first;
  std::promise<void> second_runs;
  std::promise<void> is_made;
  std::promise<void> second_ended;
  int threads = 0;
  // When the watching thread has seen that the first one takes long, it has a thread made, which
  // takes its time here: the first handler ends, and the second begins.
  const auto make_thread = [&](std::function<void()> body) {
    if (++threads == 3) {
      may_end_first.set_value();
      second_runs.get_future().wait();
    }
    std::thread made(std::move(body));
    if (threads == 3) is_made.set_value();
    return made;
  };
  Reactor reactor({.max_threads = 4, .make_thread = make_thread});
  reactor.start();
  Guest first(reactor, [&] { may_end_first.get_future().wait(); });
  Guest second(reactor, [&] {
    second_runs.set_value();
    is_made.get_future().wait();
    std::this_thread::sleep_for(1ms);
    second_ended.set_value();
  });
  const int descriptors[] = {::eventfd(1, EFD_NONBLOCK | EFD_CLOEXEC),
                             ::eventfd(1, EFD_NONBLOCK | EFD_CLOEXEC)};
  reactor.add(descriptors[0], EPOLLIN, first);
  reactor.add(descriptors[1], EPOLLIN, second);
  second_ended.get_future().wait();
  reactor.stop();
  for (const int descriptor : descriptors) ::close(descriptor);
  return second.thread_share()->is_slow();
}

TEST(Reactor, TakesNoHandlerForTheOneBeforeItThatTookLong) {
  bool blames = true;  // on a busy machine the second one can take long, too: then once more
  for (int trial = 0; blames && trial < 20; ++trial) blames = blames_next_handler();
  EXPECT_FALSE(blames);
}

TEST(Reactor, PostedWorkOfAPollableThatBlocksTakesAThreadOfItsShare) {
  Reactor reactor(4);
  reactor.start();
  const auto guest = std::make_shared<Guest>(reactor, nullptr);
  std::promise<void> may_end;
  reactor.post_for(guest, [&] { may_end.get_future().wait(); });
  guest->was_stuck.get_future().wait();
  EXPECT_EQ(guest->thread_share()->held(), 1U);
  may_end.set_value();
  const auto deadline = std::chrono::steady_clock::now() + 10s;
  while (reactor.held() != 0 && std::chrono::steady_clock::now() < deadline) {
    std::this_thread::yield();
  }
  EXPECT_EQ(guest->thread_share()->held(), 0U);
  reactor.stop();
}

// Others are not to wait until the thread that watches has seen twice that it takes long. That one
// may be faster on a busy machine, but not always.
TEST(Reactor, WorkThatTakesLongGivesWayByItself) {
  Reactor reactor(4);
  reactor.start();
  bool has_given_way = false;
  for (int i = 0; i < 200 && !has_given_way; ++i) {
    const auto share = reactor.open_share("address " + std::to_string(i));
    std::promise<bool> done;
    reactor.post(
        [&] {
          while (reactor.is_polling()) Reactor::yield();
          done.set_value(!share->is_slow());  // what is found stuck is
        },
        share);
    has_given_way = done.get_future().get();
  }
  EXPECT_TRUE(has_given_way);
  reactor.stop();
}

// Kernels before 6.12 know no slices of ordinary threads.
TEST(Reactor, ItsThreadsAskForShortSlices) {
  Reactor reactor(4);
  reactor.start();
  const std::uint64_t usual = slice_of_this_thread();
  std::promise<std::uint64_t> asked;
  reactor.post([&] { asked.set_value(slice_of_this_thread()); });
  EXPECT_EQ(asked.get_future().get(), usual == 0 ? 0U : 100'000U);
  EXPECT_EQ(slice_of_this_thread(), usual) << "the program's own threads are left alone";
  reactor.stop();
}

// What it finds when it looks for others is handled afterwards.
TEST(Reactor, KnowsWhetherAHandlerHoldsUpOthers) {
  Reactor reactor(2);  // nobody takes over
  Bell bell(reactor);
  std::future<void> heard = bell.heard();
  std::promise<std::array<bool, 4>> done;
  std::promise<void> ran;
  reactor.post([&] {
    const bool at_first = reactor.holds_up_others();
    bell.ring();
    const bool with_event = reactor.holds_up_others();
    const bool still = reactor.holds_up_others();
    reactor.post([&] { ran.set_value(); });
    done.set_value({at_first, with_event, still, reactor.holds_up_others()});
  });
  reactor.start();
  EXPECT_EQ(done.get_future().get(), (std::array<bool, 4>{false, true, true, true}));
  EXPECT_EQ(heard.wait_for(10s), std::future_status::ready);
  EXPECT_EQ(ran.get_future().wait_for(10s), std::future_status::ready);
  EXPECT_FALSE(reactor.holds_up_others()) << "not a handler";
  reactor.stop();
}

// Rings itself while it is heard: that holds up nobody, but is heard again.
class Echo final : public Pollable {
 public:
  explicit Echo(Reactor& reactor) : reactor_(reactor) {
    if (descriptor_ < 0) throw std::runtime_error("eventfd");
    reactor_.add(descriptor_, EPOLLIN, *this);
  }
  ~Echo() {
    reactor_.remove(descriptor_);
    ::close(descriptor_);
  }
  Echo(const Echo&) = delete;
  Echo& operator=(const Echo&) = delete;
  void ring() const { ::eventfd_write(descriptor_, 1); }
  std::future<bool> found() { return found_.get_future(); }
  std::future<void> heard_again() { return heard_again_.get_future(); }

 private:
  void on_ready(std::uint32_t) override {
    if (std::exchange(has_heard_, true)) {
      heard_again_.set_value();
      return;
    }
    bool has_found = false;
    for (int i = 0; i < 100; ++i) {
      ring();
      has_found = reactor_.holds_up_others() || has_found;
    }
    found_.set_value(has_found);
  }

  Reactor& reactor_;
  const int descriptor_ = ::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC);
  bool has_heard_ = false;
  std::promise<bool> found_;
  std::promise<void> heard_again_;
};

TEST(Reactor, AHandlerThatIsReadyAgainHoldsUpNobody) {
  Reactor reactor(2);
  Echo echo(reactor);
  auto found = echo.found();
  auto heard_again = echo.heard_again();
  echo.ring();
  reactor.start();
  EXPECT_FALSE(found.get());
  EXPECT_EQ(heard_again.wait_for(10s), std::future_status::ready);
  reactor.stop();
}

TEST(Reactor, WorkThatIsShortKeepsThePollingThread) {
  Reactor reactor(4);
  reactor.start();
  bool polls_still = false;
  for (int i = 0; i < 200 && !polls_still; ++i) {
    std::promise<bool> done;
    reactor.post([&] {
      Reactor::yield();
      done.set_value(reactor.is_polling());
    });
    polls_still = done.get_future().get();
  }
  EXPECT_TRUE(polls_still);
  reactor.stop();
}

TEST(Reactor, RunsAllThatIsPostedBeforeItSleeps) {
  Reactor reactor(4);
  reactor.start();
  std::promise<void> last;
  std::atomic<int> left{1000};
  const std::function<void()> next = [&] {
    if (--left == 0) {
      last.set_value();
    } else {
      reactor.post(next);
    }
  };
  reactor.post(next);
  EXPECT_EQ(last.get_future().wait_for(10s), std::future_status::ready);
  reactor.stop();
}

TEST(Reactor, KnowsItsOwnThreadsAndThatItEnds) {
  Reactor reactor(4);
  reactor.start();
  EXPECT_FALSE(reactor.is_own_thread());
  std::promise<bool> is_own;
  reactor.post([&] { is_own.set_value(reactor.is_own_thread()); });
  EXPECT_TRUE(is_own.get_future().get());
  EXPECT_FALSE(reactor.is_stopping());
  EXPECT_EQ(reactor.session_threads(), Reactor::Terms{}.session_threads);
  EXPECT_EQ(reactor.metrics(), nullptr);
  EXPECT_EQ(reactor.shared_metrics(), nullptr);
  EXPECT_GE(reactor.live_threads(), 2U);
  reactor.connections().begin();
  reactor.connections().end();
  reactor.stop();
  EXPECT_TRUE(reactor.is_stopping());
  EXPECT_EQ(reactor.live_threads(), 0U);
  std::promise<bool> is_late;
  reactor.post([&] { is_late.set_value(reactor.is_own_thread()); });
  EXPECT_TRUE(is_late.get_future().get()) << "on a thread that is made for it";
}

TEST(Reactor, ASocketIsWatchedForSomethingElse) {
  Reactor reactor(4);
  reactor.start();
  std::promise<std::uint32_t> heard;
  Guest guest(reactor, [&] { heard.set_value(0); });
  const int descriptor = ::eventfd(1, EFD_NONBLOCK | EFD_CLOEXEC);
  reactor.add(descriptor, 0, guest);
  std::promise<void> nothing;
  reactor.post([&] { nothing.set_value(); });
  nothing.get_future().get();
  auto future = heard.get_future();
  EXPECT_EQ(future.wait_for(0s), std::future_status::timeout);
  reactor.change(descriptor, EPOLLIN, guest);
  EXPECT_EQ(future.wait_for(10s), std::future_status::ready);
  reactor.remove(descriptor);
  reactor.stop();
  ::close(descriptor);
}

TEST(Reactor, ATimerThatIsCancelledDoesNotRun) {
  Reactor reactor(4);
  reactor.start();
  const auto owner = std::make_shared<int>();
  LongTimer cancelled;
  LongTimer later;
  reactor.schedule(cancelled, owner, Clock::now() + 24h);
  reactor.cancel(cancelled);
  reactor.schedule(later, owner, Clock::now());
  later.begun.get_future().wait();
  later.may_end.set_value();
  EXPECT_EQ(cancelled.begun.get_future().wait_for(0s), std::future_status::timeout);
  reactor.stop();
}

// What a pollable does that nobody counts and that holds nothing back.
TEST(Reactor, APollableOfNobodyHasNoShare) {
  Reactor reactor(4);
  Bell bell(reactor);
  Pollable& pollable = bell;
  EXPECT_EQ(pollable.thread_share(), nullptr);
  pollable.on_stuck();
  EXPECT_EQ(reactor.admission(nullptr), Handling::in_place);
  EXPECT_FALSE(reactor.readers().are_several(Clock::now()));
  class Nothing final : public Flushable {
   public:
    void flush_streamed() override { flushed.set_value(); }
    std::promise<void> flushed;
  };
  const auto nothing = std::make_shared<Nothing>();
  EXPECT_TRUE(reactor.flusher().add(nothing));
  nothing->flushed.get_future().get();
}

TEST(Reactor, AnotherThreadPollsWhenOneGivesWay) {
  Reactor reactor(4);
  reactor.start();
  Reactor::give_way();  // this thread polls nothing
  const auto share = reactor.open_share("somewhere");
  std::promise<bool> still_polls;
  std::promise<void> may_end;
  std::promise<Handling> handling;
  reactor.post(
      [&] {
        Reactor::give_way();
        still_polls.set_value(reactor.is_polling());
        handling.set_value(reactor.admission(share));
        may_end.get_future().get();
      },
      share);
  EXPECT_FALSE(still_polls.get_future().get());
  EXPECT_EQ(handling.get_future().get(), Handling::in_place) << "it holds up nobody";
  EXPECT_EQ(reactor.held(), 1U);
  std::promise<void> other;
  reactor.post([&] { other.set_value(); });
  EXPECT_EQ(other.get_future().wait_for(10s), std::future_status::ready);
  may_end.set_value();
  reactor.stop();
}

TEST(Reactor, WorkThatHasToWaitIsLookedAtAgain) {
  Reactor reactor({.max_threads = 4, .session_threads = 1});
  reactor.start();
  const auto share = reactor.open_share("somewhere");
  std::promise<void> has_begun;
  std::promise<void> may_end;
  std::atomic<bool> has_run{false};
  reactor.post(
      [&] {
        Reactor::give_way();
        has_begun.set_value();
        may_end.get_future().get();
      },
      share);
  has_begun.get_future().get();
  reactor.post([&] { has_run = true; }, share);
  const auto deadline = Clock::now() + 10s;
  while (reactor.waiting() == 0 && Clock::now() < deadline) std::this_thread::yield();
  EXPECT_EQ(reactor.waiting(), 1U) << "its session holds as many threads as it may";
  reactor.reconsider();
  EXPECT_EQ(reactor.waiting(), 1U);
  share->depart();
  reactor.reconsider();
  EXPECT_EQ(reactor.waiting(), 0U);
  may_end.set_value();
  reactor.stop();
}

// Only one thread of four may, and only from inside a handler.
TEST(Reactor, AThreadStaysWithOneConnectionUntilItIsCalledBack) {
  Reactor reactor(4);
  reactor.start();
  EXPECT_FALSE(reactor.begin_stay()) << "it does not poll";
  EXPECT_FALSE(reactor.is_stay_over());
  std::promise<std::array<bool, 3>> done;
  Guest guest(reactor, [&] {
    const bool stays = reactor.begin_stay();
    const bool is_counted = reactor.stays() == (stays ? 1U : 0U);
    const bool polls = reactor.is_polling();
    if (stays) reactor.end_stay();
    done.set_value({stays, is_counted, polls});
  });
  const int descriptor = ::eventfd(1, EFD_NONBLOCK | EFD_CLOEXEC);
  reactor.add(descriptor, EPOLLIN | EPOLLET, guest);
  EXPECT_EQ(done.get_future().get(), (std::array<bool, 3>{true, true, false}));
  EXPECT_EQ(reactor.stays(), 0U);
  reactor.stop();
  EXPECT_TRUE(reactor.is_stay_over());
  ::close(descriptor);
}

// As a connection, whose timers are cancelled when it goes.
class Timed final : public Pollable {
 public:
  explicit Timed(Reactor& reactor) : reactor_(reactor) {}
  ~Timed() { reactor_.cancel(timer_); }
  Timed(const Timed&) = delete;
  Timed& operator=(const Timed&) = delete;
  void on_ready(std::uint32_t) override {}

 private:
  Reactor& reactor_;
  LongTimer timer_;
};

TEST(Reactor, WhatIsRetiredGoesWithoutItsLock) {
  Reactor reactor(4);
  auto early = std::make_shared<Timed>(reactor);
  const std::weak_ptr<Timed> watch = early;
  reactor.start();
  reactor.retire(std::move(early));
  reactor.stop();
  EXPECT_TRUE(watch.expired());
  reactor.retire(std::make_shared<Timed>(reactor));
}

TEST(Reactor, WhatIsPostedGoesWithoutItsLock) {
  Reactor reactor(4);
  auto last = std::make_shared<Timed>(reactor);
  const std::weak_ptr<Timed> watch = last;
  std::atomic<bool> has_run{false};
  // There is no thread that could do it before the end.
  reactor.post_for(std::move(last), [&] { has_run = true; });
  reactor.stop();
  EXPECT_TRUE(has_run);
  EXPECT_TRUE(watch.expired());
}

}  // namespace
}  // namespace rr::channel
