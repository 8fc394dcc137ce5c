// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/platform/poller.hpp"

#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <cstdint>
#include <map>
#include <span>
#include <string_view>
#include <system_error>
#include <thread>
#include <vector>

#include "runtime/cpp/src/platform/sockets.hpp"
#include "runtime/cpp/src/platform/waiting.hpp"

namespace rr::platform {
namespace {

class PollerTest : public ::testing::Test {
 protected:
  PollerTest() { EXPECT_FALSE(make_pair(own, other)); }

  // What is reported, by key, after a wait that may take a while for something to come.
  std::map<void*, std::uint32_t> look() {
    wait_for(own.get(), ready::input, std::chrono::steady_clock::now() + quiet);
    std::map<void*, std::uint32_t> result;
    std::array<Poller::Event, Poller::most_events> events;
    const std::size_t count = poller.wait(events, false);
    for (const Poller::Event& event : std::span(events).first(count)) {
      result[event.key] |= event.events;
    }
    return result;
  }
  void say(std::string_view text) {
    EXPECT_EQ(send(other.get(), std::as_bytes(std::span(text))),
              static_cast<std::ptrdiff_t>(text.size()));
    EXPECT_TRUE(wait_for(own.get(), ready::input,
                         std::chrono::steady_clock::now() + std::chrono::seconds(20)));
  }
  void hear_all() {
    std::array<std::byte, 100> room{};
    while (receive(own.get(), room, Wait::none) > 0) continue;
  }

  static constexpr std::chrono::milliseconds quiet{20};
  Poller poller;
  Descriptor own;
  Descriptor other;
  int key = 0;
};

TEST_F(PollerTest, ReportsInputOnceUntilMoreComes) {
  poller.add(own.get(), ready::input | ready::closing, &key);
  EXPECT_TRUE(look().empty());
  say("a");
  EXPECT_EQ(look()[&key] & ready::input, ready::input);
  hear_all();
  EXPECT_TRUE(look().empty());
  say("b");
  EXPECT_EQ(look()[&key] & ready::input, ready::input);
}

TEST_F(PollerTest, DoesNotReportAgainWhatNobodyReads) {
  poller.add(own.get(), ready::input | ready::room, &key);
  say("a");
  EXPECT_EQ(look()[&key], ready::input | ready::room);
  while (!look().empty()) continue;  // at most what was recorded besides
  EXPECT_TRUE(look().empty());
}

TEST_F(PollerTest, ReportsAnewAfterAChange) {
  poller.add(own.get(), ready::room, &key);
  say("a");
  EXPECT_EQ(look()[&key] & ready::input, 0U);
  poller.change(own.get(), ready::input, &key);
  EXPECT_EQ(look()[&key] & ready::input, ready::input);
  poller.change(own.get(), ready::input, &key);
  EXPECT_EQ(look()[&key] & ready::input, ready::input);
}

TEST_F(PollerTest, ReportsRoomThatWasMissing) {
  poller.add(own.get(), ready::room, &key);
  look();
  const std::vector<std::byte> much(1 << 20);
  while (send(own.get(), much) > 0) continue;
  while (!look().empty()) continue;
  std::vector<std::byte> room(1 << 20);
  std::uint32_t found = 0;
  while ((found & ready::room) == 0) {
    if (receive(other.get(), room, Wait::none) == broken) break;
    found |= look()[&key];
  }
  EXPECT_EQ(found & ready::room, ready::room);
}

TEST_F(PollerTest, ReportsTheEndThatNobodyAskedFor) {
  poller.add(own.get(), ready::input | ready::closing, &key);
  look();
  other = Descriptor();
  std::array<Poller::Event, 4> events{};
  ASSERT_EQ(poller.wait(events, true), 1U);
  EXPECT_EQ(events[0].key, &key);
  EXPECT_NE(events[0].events & ready::end, 0U);
}

TEST_F(PollerTest, ForgetsWhatIsRemoved) {
  poller.add(own.get(), ready::input, &key);
  say("a");
  poller.remove(own.get());
  EXPECT_TRUE(look().empty());
  EXPECT_THROW(poller.change(own.get(), ready::input, &key), std::system_error);
  poller.add(own.get(), ready::input, &key);
  EXPECT_EQ(look()[&key] & ready::input, ready::input);
  EXPECT_THROW(poller.add(own.get(), ready::input, &key), std::system_error);
}

TEST_F(PollerTest, IsWokenWhileItWaitsOrBefore) {
  std::array<Poller::Event, 4> events{};
  poller.wake();
  ASSERT_EQ(poller.wait(events, true), 1U);
  EXPECT_EQ(events[0].key, nullptr);
  std::thread waker([&] {
    std::this_thread::sleep_for(quiet);
    poller.wake();
  });
  ASSERT_EQ(poller.wait(events, true), 1U);
  EXPECT_EQ(events[0].key, nullptr);
  waker.join();
}

TEST_F(PollerTest, ReportsAllOfManyThatAreReady) {
  constexpr std::size_t count = 150;
  std::vector<Descriptor> near(count);
  std::vector<Descriptor> far(count);
  std::vector<int> keys(count);
  const std::string_view text = "x";
  for (std::size_t i = 0; i < count; ++i) {
    ASSERT_FALSE(make_pair(near[i], far[i]));
    poller.add(near[i].get(), ready::input, &keys[i]);
    send(far[i].get(), std::as_bytes(std::span(text)));
  }
  std::map<void*, int> seen;
  while (seen.size() < count) {
    std::array<Poller::Event, Poller::most_events> events;
    const std::size_t found = poller.wait(events, true);
    ASSERT_LE(found, events.size());
    for (std::size_t i = 0; i < found; ++i) ++seen[events[i].key];
  }
  EXPECT_EQ(seen.size(), count);
}

}  // namespace
}  // namespace rr::platform
