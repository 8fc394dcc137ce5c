// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "runtime/cpp/src/channel/ready_events.hpp"

namespace rr::channel {
namespace {

using Event = ReadyEvents::Event;

class ReadyEventsTest : public ::testing::Test {
 protected:
  // A poller that has these.
  auto brings(std::vector<Event> found) {
    return [this, found = std::move(found)](std::span<Event> room) {
      room_ = room.size();
      const std::size_t count = std::min(room.size(), found.size());
      std::copy_n(found.begin(), count, room.begin());
      return count;
    };
  }
  void expect_next(const void* key, std::uint32_t bits) {
    ASSERT_FALSE(events_.empty());
    const Event& event = events_.take();
    EXPECT_EQ(event.key, key);
    EXPECT_EQ(event.events, bits);
  }

  int own_ = 0;
  int other_ = 0;
  std::size_t room_ = 0;
  ReadyEvents events_;
};

TEST_F(ReadyEventsTest, AreHandledInTheirOrder) {
  EXPECT_TRUE(events_.empty());
  events_.fetch(brings({{&own_, 1}, {&other_, 2}}));
  EXPECT_EQ(room_, ReadyEvents::capacity);
  EXPECT_EQ(events_.size(), 2U);
  expect_next(&own_, 1);
  expect_next(&other_, 2);
  EXPECT_TRUE(events_.empty());
  EXPECT_EQ(events_.size(), 2U) << "handled ones too";
  events_.fetch(brings({}));
  EXPECT_TRUE(events_.empty());
  EXPECT_EQ(events_.size(), 0U);
}

TEST_F(ReadyEventsTest, OthersAreFoundAmongThoseThatAreStillToBeHandled) {
  events_.fetch(brings({{&own_, 1}, {&other_, 2}}));
  events_.take();
  room_ = 0;
  EXPECT_TRUE(events_.find_others(&own_, brings({})));
  EXPECT_EQ(room_, 0U) << "nothing more was asked for";
  expect_next(&other_, 2);
}

TEST_F(ReadyEventsTest, OthersAreFetchedAndKept) {
  events_.fetch(brings({{&own_, 1}}));
  events_.take();
  EXPECT_TRUE(events_.find_others(&own_, brings({{nullptr, 0}, {&other_, 4}})));
  EXPECT_EQ(room_, ReadyEvents::capacity - 1);
  expect_next(nullptr, 0);
  expect_next(&other_, 4);
  EXPECT_TRUE(events_.empty());
}

TEST_F(ReadyEventsTest, SeveralOfTheSameBecomeOne) {
  events_.fetch(brings({{&own_, 1}, {&own_, 2}}));
  events_.take();
  EXPECT_FALSE(events_.find_others(&own_, brings({{&own_, 4}})));
  EXPECT_FALSE(events_.find_others(&own_, brings({{&own_, 8}, {nullptr, 0}})));
  expect_next(&own_, 14);
  EXPECT_TRUE(events_.empty());
}

TEST_F(ReadyEventsTest, ThoseOfOneThatIsReadyAgainAndAgainNeverFillTheRoom) {
  events_.fetch(brings({{&own_, 1}}));
  events_.take();
  for (std::size_t i = 0; i < 2 * ReadyEvents::capacity; ++i) {
    ASSERT_FALSE(events_.find_others(&own_, brings({{&own_, 1}})));
    ASSERT_GE(room_, ReadyEvents::capacity - 2);
  }
  EXPECT_TRUE(events_.find_others(&own_, brings({{&other_, 1}})));
}

TEST_F(ReadyEventsTest, NothingIsFetchedWithoutRoom) {
  events_.fetch(brings(std::vector<Event>(ReadyEvents::capacity, Event{&own_, 1})));
  events_.take();
  room_ = 7;
  EXPECT_FALSE(events_.find_others(&own_, brings({{&other_, 1}})));
  EXPECT_EQ(room_, 7U);
}

}  // namespace
}  // namespace rr::channel
