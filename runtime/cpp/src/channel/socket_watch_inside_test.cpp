// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <optional>

#include "runtime/cpp/src/channel/reactor.hpp"
#include "runtime/cpp/src/channel/socket_watch.hpp"

namespace rr::channel {
namespace {

constexpr std::uint32_t all = ready::input | ready::room | ready::closing;
constexpr Time at{std::chrono::seconds(5)};

// Knows what is watched for; refuses what the kernel would.
class FakeWatcher final : public Watcher {
 public:
  std::optional<std::uint32_t> events;
  int calls = 0;

  void add(int /*descriptor*/, std::uint32_t wanted, Pollable& /*pollable*/) override {
    EXPECT_FALSE(events.has_value());
    events = wanted;
    ++calls;
  }
  void change(int /*descriptor*/, std::uint32_t wanted, Pollable& /*pollable*/) override {
    EXPECT_TRUE(events.has_value());
    events = wanted;
    ++calls;
  }
  void remove(int /*descriptor*/) override {
    EXPECT_TRUE(events.has_value());
    events.reset();
    ++calls;
  }
};

class Nobody final : public Pollable {
 public:
  void on_ready(std::uint32_t /*events*/) override {}
};

class SocketWatchTest : public ::testing::Test {
 protected:
  using Look = SocketWatch::Look;
  using State = SocketWatch::State;

  FakeWatcher watcher_;
  Nobody pollable_;
  SocketWatch watch_{watcher_, 7, pollable_};
};

// Room is told of as input, and the end while nobody polls for input.
TEST_F(SocketWatchTest, ABellIsWatchedForItsEndAlways) {
  constexpr std::uint32_t bell = ready::input | ready::closing;
  watch_.use_bell(false);
  EXPECT_EQ(watcher_.events, std::nullopt);
  watch_.begin(true, false);
  EXPECT_EQ(watcher_.events, std::uint32_t{ready::closing});
  watch_.update(true);
  EXPECT_EQ(watcher_.events, bell);
  watch_.go_full(false);
  EXPECT_EQ(watcher_.events, bell);
  watch_.go_idle(false);
  EXPECT_EQ(watcher_.events, std::uint32_t{ready::closing});
  watch_.end();
  EXPECT_EQ(watcher_.events, std::nullopt);
}

TEST_F(SocketWatchTest, ASocketBecomesABell) {
  watch_.begin(false, false);
  EXPECT_EQ(watcher_.events, all);
  watch_.use_bell(false);
  EXPECT_EQ(watcher_.events, ready::input | ready::closing);
}

TEST_F(SocketWatchTest, AServersIsWatchedFromTheBeginningToTheEnd) {
  watch_.go_full(false);  // not begun
  EXPECT_EQ(watcher_.events, std::nullopt);
  watch_.begin(false, false);
  EXPECT_EQ(watcher_.events, all);
  EXPECT_TRUE(watch_.is_full());
  watch_.end();
  EXPECT_EQ(watcher_.events, std::nullopt);
  watch_.end();
  watch_.go_full(false);
  watch_.go_idle(true);
  watch_.update(true);
  EXPECT_EQ(watcher_.events, std::nullopt);
  EXPECT_EQ(watch_.state(), State::off);
}

TEST_F(SocketWatchTest, AClientsIsIdleUntilNobodyReads) {
  watch_.begin(true, false);
  EXPECT_EQ(watch_.state(), State::idle);
  EXPECT_EQ(watcher_.calls, 0);  // of the kernel
  watch_.go_full(false);
  EXPECT_EQ(watcher_.events, all);
}

TEST_F(SocketWatchTest, AnIdleSocketIsWatchedForRoomWhileSomethingWaits) {
  watch_.begin(true, false);
  watch_.update(true);
  EXPECT_EQ(watcher_.events, ready::room);
  watch_.update(false);
  EXPECT_EQ(watcher_.events, std::nullopt);
  watch_.go_full(false);
  watch_.go_idle(true);
  EXPECT_EQ(watcher_.events, ready::room);
}

TEST_F(SocketWatchTest, ALoneCallIsFollowedByWatching) {
  watch_.begin(true, false);
  EXPECT_FALSE(watch_.end_call(at, 1, false, false));
  EXPECT_EQ(watcher_.events, all);
}

TEST_F(SocketWatchTest, CallsInATightLoopFindTheSocketIdle) {
  watch_.begin(true, false);
  EXPECT_FALSE(watch_.end_call(at, 1, false, false));
  watch_.go_idle(false);
  EXPECT_TRUE(watch_.end_call(at, 2, false, false));  // in the same tick
  const int calls = watcher_.calls;
  EXPECT_FALSE(watch_.end_call(at + Milliseconds(4), 3, false, false));  // looked after already
  EXPECT_EQ(watch_.look(3, false, false), Look::later);
  EXPECT_EQ(watcher_.calls, calls);
  EXPECT_EQ(watch_.state(), State::idle);
  // No call since: they have ceased.
  EXPECT_EQ(watch_.look(3, false, false), Look::done);
  EXPECT_EQ(watcher_.events, all);
}

TEST_F(SocketWatchTest, UnseenInputIsLookedForAtOnce) {
  watch_.begin(true, false);
  EXPECT_FALSE(watch_.end_call(at, 1, false, false));
  watch_.go_idle(false);
  EXPECT_FALSE(watch_.end_call(at, 2, true, false));
  EXPECT_EQ(watcher_.events, all);
}

TEST_F(SocketWatchTest, IsLookedAtLessOftenTheLongerCallsGoOn) {
  watch_.begin(true, false);
  EXPECT_FALSE(watch_.end_call(at, 1, false, false));
  watch_.go_idle(false);
  ASSERT_TRUE(watch_.end_call(at, 2, false, false));
  std::uint32_t uses = 2;
  for (const int milliseconds : {1, 2, 4, 8, 16, 16}) {
    EXPECT_EQ(watch_.period(), Milliseconds(milliseconds));
    EXPECT_EQ(watch_.look(++uses, false, false), Look::later);
  }
  EXPECT_EQ(watch_.look(uses, false, false), Look::done);
  watch_.go_idle(false);
  ASSERT_TRUE(watch_.end_call(at, uses, false, false));
  EXPECT_EQ(watch_.period(), Milliseconds(1));
}

// A caller that waits for long has ended nothing.
TEST_F(SocketWatchTest, ASocketThatIsReadStaysIdle) {
  watch_.begin(true, false);
  EXPECT_FALSE(watch_.end_call(at, 1, false, false));
  watch_.go_idle(false);
  EXPECT_TRUE(watch_.end_call(at, 2, false, false));
  EXPECT_EQ(watch_.look(2, true, false), Look::done);
  EXPECT_EQ(watch_.state(), State::idle);
}

TEST_F(SocketWatchTest, APinnedThreadIsLookedAfter) {
  watch_.begin(false, false);
  EXPECT_EQ(watch_.period(), Milliseconds(1));
  EXPECT_TRUE(watch_.pin(1, false));
  EXPECT_FALSE(watch_.pin(2, false));
  EXPECT_TRUE(watch_.is_pinned());
  EXPECT_EQ(watch_.period(), Milliseconds(20));
  EXPECT_EQ(watch_.state(), State::idle);
  EXPECT_EQ(watch_.look(2, true, false), Look::later);   // it has received meanwhile
  EXPECT_EQ(watch_.look(2, true, false), Look::later);   // it waits in a receive
  EXPECT_EQ(watch_.look(2, false, false), Look::stuck);  // it is in a handler
  EXPECT_EQ(watcher_.events, all);
  watch_.unpin();
  EXPECT_FALSE(watch_.is_pinned());
}

}  // namespace
}  // namespace rr::channel
