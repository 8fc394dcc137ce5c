// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/platform/poller.hpp"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string_view>
#include <system_error>
#include <thread>
#include <utility>
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

// A server that only its poller wakes: it accepts, and answers each message with the same bytes.
class Echo {
 public:
  Echo() {
    std::error_code error;
    listener_ = listen_at(address_of(parse_ip("127.0.0.1").value(), 0), error);
    EXPECT_FALSE(error);
    poller_.add(listener_.get(), ready::input, this);
    thread_ = std::thread([this] { serve(); });
  }
  ~Echo() {
    is_over_ = true;
    poller_.wake();
    thread_.join();
  }
  [[nodiscard]] Address address() const { return local_address(listener_.get()); }

 private:
  void serve() {
    std::array<Poller::Event, Poller::most_events> events;
    while (!is_over_) {
      const std::size_t count = poller_.wait(events, true);
      for (const Poller::Event& event : std::span(events).first(count)) {
        if (event.key == this) accept_all();
        if (event.key != this && event.key != nullptr) answer(*static_cast<Descriptor*>(event.key));
      }
    }
  }
  void accept_all() {
    std::error_code error;
    while (Descriptor accepted = accept_one(listener_.get(), error)) {
      auto kept = std::make_unique<Descriptor>(std::move(accepted));
      poller_.add(kept->get(), ready::input | ready::closing, kept.get());
      accepted_.push_back(std::move(kept));
    }
  }
  void answer(Descriptor& socket) {
    std::array<std::byte, 100> room{};
    std::ptrdiff_t size = 0;
    while ((size = receive(socket.get(), room, Wait::none)) > 0) {
      send(socket.get(), std::span(room).first(static_cast<std::size_t>(size)));
    }
    if (size != nothing_now) {
      poller_.remove(socket.get());
      std::erase_if(accepted_, [&](const auto& each) { return each.get() == &socket; });
    }
  }

  Poller poller_;
  Descriptor listener_;
  std::vector<std::unique_ptr<Descriptor>> accepted_;
  std::atomic<bool> is_over_{false};
  std::thread thread_;
};

bool is_answered(const Address& address) {
  const auto limit = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  Descriptor socket;
  std::error_code error;
  if (begin_connect(address, socket, error) == Connecting::failed) return false;
  if (!wait_for(socket.get(), ready::room, limit) || connect_result(socket.get())) return false;
  std::array<std::byte, 4> bytes{};
  for (int i = 0; i < 3; ++i) {
    if (send(socket.get(), bytes) != 4) return false;
    for (std::size_t received = 0; received < bytes.size();) {
      if (!wait_for(socket.get(), ready::input, limit)) return false;
      const std::ptrdiff_t size = receive(socket.get(), bytes, Wait::none);
      if (size <= 0 && size != nothing_now) return false;
      if (size > 0) received += static_cast<std::size_t>(size);
    }
  }
  return true;
}

TEST(PollerOfAServer, MissesNoneOfManyConnections) {
  const Echo echo;
  std::atomic<int> missed = 0;
  std::vector<std::thread> clients;
  for (int i = 0; i < 4; ++i) {
    clients.emplace_back([&] {
      for (int round = 0; round < 200; ++round) missed += is_answered(echo.address()) ? 0 : 1;
    });
  }
  for (std::thread& client : clients) client.join();
  EXPECT_EQ(missed, 0);
}

}  // namespace
}  // namespace rr::platform
