// SPDX-License-Identifier: Apache-2.0
#include "gateway/life_watch.hpp"

#include <gtest/gtest.h>

#include "gateway/properties.hpp"

namespace rr::gateway {
namespace {

using std::chrono::seconds;

const std::string watched_topic = "rr/hall/r1/$life";

Message life_message(const std::string& text, bool retained = false) {
  Message result{watched_topic, bytes_of(text)};
  result.retained = retained;
  return result;
}

std::string life_text(const std::optional<Message>& message) {
  return message ? text_of(message->payload) : "nothing";
}

class LifeWatchTest : public ::testing::Test {
 protected:
  std::optional<Message> beat(seconds age = seconds(0), const std::string& instance = "a") {
    return watch.beat(watched_topic, {instance, life_message("lost"), age}, now);
  }

  LifeWatch watch{seconds(7)};
  LifeWatch::Clock::time_point now{seconds(1'000)};
};

TEST_F(LifeWatchTest, ALifeThatFallsSilentIsLostOnce) {
  EXPECT_EQ(life_text(beat()), "nothing");
  EXPECT_EQ(life_text(watch.life(life_message("up"), now)), "up");
  now += seconds(6);
  EXPECT_TRUE(watch.take_lost(now).empty());
  now += seconds(1);
  const auto lost = watch.take_lost(now);
  ASSERT_EQ(lost.size(), 1U);
  EXPECT_EQ(life_text(lost[0]), "lost");
  EXPECT_EQ(lost[0].topic, watched_topic);
  EXPECT_TRUE(watch.take_lost(now + seconds(60)).empty());
}

TEST_F(LifeWatchTest, BeatsKeepItAlive) {
  for (int i = 0; i < 10; ++i) {
    beat();
    now += seconds(5);
    EXPECT_TRUE(watch.take_lost(now).empty());
  }
}

TEST_F(LifeWatchTest, ALifeThatIsHeardAgainIsDeliveredAgain) {
  beat();
  static_cast<void>(watch.life(life_message("up", true), now));
  now += seconds(7);
  EXPECT_EQ(watch.take_lost(now).size(), 1U);
  const auto again = beat();
  EXPECT_EQ(life_text(again), "up");
  EXPECT_FALSE(again->retained);
  EXPECT_EQ(life_text(beat()), "nothing");
}

// It has not got the life yet, and may never get it.
TEST_F(LifeWatchTest, AnotherInstanceDoesNotBringALifeBack) {
  beat();
  static_cast<void>(watch.life(life_message("up"), now));
  now += seconds(7);
  EXPECT_EQ(watch.take_lost(now).size(), 1U);
  EXPECT_EQ(life_text(beat(seconds(0), "b")), "nothing");
  EXPECT_EQ(life_text(watch.life(life_message("up again"), now)), "up again");
  now += seconds(7);
  EXPECT_EQ(watch.take_lost(now).size(), 1U);
  EXPECT_EQ(life_text(beat(seconds(0), "b")), "up again");
}

TEST_F(LifeWatchTest, AnOldBeatMeansThatTheRetainedLifeIsOver) {
  EXPECT_EQ(life_text(beat(seconds(8))), "nothing");
  const Message got = watch.life(life_message("up", true), now);
  EXPECT_EQ(life_text(got), "lost");
  EXPECT_TRUE(got.retained);
  EXPECT_TRUE(watch.take_lost(now).empty());
  // What it says now it has not said before.
  EXPECT_EQ(life_text(watch.life(life_message("up"), now)), "up");
}

TEST_F(LifeWatchTest, AYoungBeatCounts) {
  beat(seconds(3));
  EXPECT_EQ(life_text(watch.life(life_message("up", true), now)), "up");
  now += seconds(3);
  EXPECT_TRUE(watch.take_lost(now).empty());
  now += seconds(1);
  EXPECT_EQ(watch.take_lost(now).size(), 1U);
}

TEST_F(LifeWatchTest, ALifeThatHasEndedIsNotLost) {
  beat();
  watch.end(watched_topic);
  EXPECT_EQ(life_text(watch.life(life_message("ended", true), now)), "ended");
  EXPECT_TRUE(watch.take_lost(now + seconds(60)).empty());
}

TEST_F(LifeWatchTest, ANewConnectionKnowsNothing) {
  beat();
  watch.clear();
  EXPECT_TRUE(watch.take_lost(now + seconds(60)).empty());
}

}  // namespace
}  // namespace rr::gateway
