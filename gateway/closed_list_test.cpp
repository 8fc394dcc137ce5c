// SPDX-License-Identifier: Apache-2.0
#include "gateway/closed_list.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace rr::gateway {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

const Closed everything{};
const Closed force{"", "force"};
const Closed tool{"tools[left%20hand]", ""};
const Closed width{"tools[left%20hand].axis[2]", "width"};

TEST(ClosedLists, AreReadInTheirOrder) {
  ClosedList list;
  ClosedListReader reader;
  EXPECT_THAT(reader.take(list.message("t")), IsEmpty());
  list.add(width);
  list.add(force);
  list.add(tool);
  EXPECT_THAT(reader.take(list.message("t")), ElementsAre(width, force, tool));
  EXPECT_THAT(reader.take(list.message("t")), IsEmpty());
  list.add(width);
  EXPECT_THAT(reader.take(list.message("t")), ElementsAre(width));
}

TEST(ClosedLists, OfAnEarlierTimeAreNotNew) {
  ClosedList list;
  list.add(force);
  ClosedListReader reader;
  EXPECT_THAT(reader.take(list.message("t")), IsEmpty());
  list.add(force);
  EXPECT_THAT(reader.take(list.message("t")), ElementsAre(force));
}

TEST(ClosedLists, OfAGatewayThatWasStartedAgainAreNew) {
  ClosedList before;
  before.add(force);
  before.add(width);
  ClosedListReader reader;
  reader.take(before.message("t"));
  ClosedList after;
  after.add(tool);
  EXPECT_THAT(reader.take(after.message("t")), ElementsAre(tool));
}

// A broker retains no message without a payload.
TEST(ClosedLists, AreRetainedWhenTheyAreEmpty) {
  EXPECT_FALSE(ClosedList().message("t").payload.empty());
}

TEST(ClosedLists, ThatWereTooLongStandForEverything) {
  ClosedList list;
  ClosedListReader reader;
  reader.take(list.message("t"));
  for (int i = 0; i < 70; ++i) list.add({"tools[" + std::to_string(i) + "]", ""});
  const auto all = reader.take(list.message("t"));
  ASSERT_EQ(all.size(), 65U);
  EXPECT_EQ(all.front(), everything);
  EXPECT_EQ(all.back(), (Closed{"tools[69]", ""}));
  list.add(force);
  EXPECT_THAT(reader.take(list.message("t")), ElementsAre(force));
}

TEST(ClosedLists, TheSameTakesOneLine) {
  ClosedList list;
  ClosedListReader reader;
  reader.take(list.message("t"));
  for (int i = 0; i < 1'000; ++i) list.add(force);
  EXPECT_THAT(reader.take(list.message("t")), ElementsAre(force));
}

TEST(ClosedLists, LinesThatAreNoneArePassedOver) {
  ClosedList list;
  ClosedListReader reader;
  reader.take(list.message("t"));
  list.add(force);
  Message message = list.message("t");
  message.payload = bytes_of("7\n\nx a b\n2\n3 a b c\n-4 a\n99999999999999999999 a\n5 - force\n6");
  EXPECT_THAT(reader.take(message), ElementsAre(force));
  Message without = list.message("t");
  without.properties.clear();
  EXPECT_THAT(reader.take(without), IsEmpty());
}

}  // namespace
}  // namespace rr::gateway
